// Links units with different flags: each draws the same bytes, and units exchange pictures and filters.
#include <cstdio>

#include "unit.hpp"

int main() {
    const quantization quantize = in::to_uint8 | in::to_float;
    const in::image<float> drawn = draw_alone(), recorded = record_alone(), filtered = filter_alone(drawn, quantize);
    bool same = !drawn.empty() && !recorded.empty();
    if (!same) std::puts("Unit alone returns an empty picture.");
    const auto check = [&](const char* unit, const char* function, const in::image<float>& picture,
                           const in::image<float>& expected) {
        if (picture == expected) return;
        std::printf("Unit %s: %s returns other bytes than in unit alone.\n", unit, function);
        same = false;
    };
#define DRAW(unit) draw_##unit(),
    const in::image<float> pictures[] = {UNITS(DRAW)};
    int number = 0;
#define CHECK_UNIT(unit)                               \
    check(#unit, "draw", pictures[number++], drawn);   \
    check(#unit, "record", record_##unit(), recorded); \
    for (const in::image<float>& picture : pictures) check(#unit, "filter", filter_##unit(picture, quantize), filtered);
    UNITS(CHECK_UNIT)
#define CHECK_OPTIONS(unit)                                                            \
    if (!reads_##unit(in::display_scale::decibels, {.drift = 2}, {.coverage = 0.25f})) \
        std::puts("Unit " #unit " reads other options than it is given."), same = false;
    UNITS(CHECK_OPTIONS)
    if (same) std::puts("Every unit draws the same bytes.");
    return same ? 0 : 1;
}
