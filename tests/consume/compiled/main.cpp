// Units with other flags in one program: each draws the same bytes, and pictures pass from one to the next.
#include <cstdio>

#include "unit.hpp"

int main() {
    const in::image<float> expected = draw_alone(), heard = hear_alone(), looked = look_alone(expected);
    const in::image<float> pictures[] = {draw_plain(), draw_debug(), draw_native(), draw_alone_native()};
    bool same = !expected.empty() && !heard.empty();
    for (const in::image<float>& picture : pictures)
        same = same && picture == expected && look_plain(picture) == looked && look_debug(picture) == looked &&
               look_native(picture) == looked && look_alone_native(picture) == looked;
    for (const in::image<float>& recording : {hear_plain(), hear_debug(), hear_native(), hear_alone_native()})
        same = same && recording == heard;
    std::puts(same ? "Every unit draws the same bytes." : "A unit draws other bytes.");
    return same ? 0 : 1;
}
