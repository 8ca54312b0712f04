// The levels of what a pass makes, and how often each comes: for a filter that looks at no more than that, one sweep
// instead of two, and a quarter of the memory.
#pragma once

#include <insonify/filter/detail/sweep.hpp>
#include <insonify/filter/histogram.hpp>

#include <array>
#include <atomic>
#include <optional>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A pass, and behind it the levels of its floats, counted.
template <class Pass>
struct level_pass {
    Pass pass;
    code_counter<std::uint8_t> counter{};
    int nan = 0;

    template <class Pixel>
    std::uint8_t operator()(const Pixel& pixel, int x, int y) {
        std::uint8_t level = 0;
        row(&pixel, &level, 1, x, y);
        return level;
    }
    template <class Pixel>
    void row(const Pixel* from, std::uint8_t* to, int count, int x, int y) {
        float values[run_length];
        call_row(pass, from, values, count, x, y);
        const auto pixels = static_cast<std::size_t>(count);
        quantize_row(std::span<const float>(values, pixels), std::span<std::uint8_t>(to, pixels));
        counter.add(to, count);
        nan += count_nan(values, count);
    }
    void place(const pixel_area& area) { place_pass(pass, area); }
};

/// The nearest of 256 levels of each float that a pass makes, and how many there are of each; nothing if some of the
/// floats are no numbers, which have no level.
template <class From, class Pass, executor E>
std::optional<histogram> sweep_levels(image_view<const From> from, image_view<std::uint8_t> to, const Pass& pass, E& ex,
                                      pixel_origin origin) {
    std::array<std::atomic<std::uint64_t>, 256> counts{};
    std::atomic<bool> has_nan = false;
    sweep(from, to, level_pass<Pass>{pass}, ex, origin, [&](const level_pass<Pass>& run) {
        histogram own{std::vector<std::uint64_t>(counts.size())};
        run.counter.add_to(own);
        for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += own.counts[i];
        if (run.nan > 0) has_nan = true;
    });
    if (has_nan) return std::nullopt;
    return histogram{std::vector<std::uint64_t>(counts.begin(), counts.end())};
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
