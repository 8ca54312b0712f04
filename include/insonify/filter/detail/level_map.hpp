// Maps pixel levels to values: the lookup table behind histogram equalization and matching.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/filter/detail/bin_counters.hpp>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Number of levels by which pixels are mapped.
template <class Pixel>
inline constexpr int source_levels = std::same_as<Pixel, std::uint16_t> ? 65536 : 256;

/// Maps each level to a value; floats take that of the nearest of 256 levels, NaN stays NaN.
template <countable_pixel Pixel>
class level_map {
  public:
    explicit level_map(dynamic_array<Pixel> values)
        : values_(std::make_shared<const dynamic_array<Pixel>>(std::move(values))) {}

    template <std::same_as<Pixel> P>
    P operator()(P pixel) const {
        const dynamic_array<Pixel>& values = *values_;
        if constexpr (std::is_same_v<P, float>)
            return pixel == pixel ? values[quantize<std::uint8_t>(pixel)] : pixel;
        else
            return values[pixel];
    }
    void row(const Pixel* from, Pixel* to, int count, int, int) const {
        const Pixel* const values = values_->data();
        if constexpr (std::is_same_v<Pixel, float>) {
            std::uint8_t codes[run_length];
            quantize_row(from, codes, count);
            if (count_nan(from, count) == 0)
                for (int i = 0; i < count; ++i) to[i] = values[codes[i]];
            else
                for (int i = 0; i < count; ++i) to[i] = from[i] == from[i] ? values[codes[i]] : from[i];
        } else {
            for (int i = 0; i < count; ++i) to[i] = values[from[i]];
        }
    }

  private:
    std::shared_ptr<const dynamic_array<Pixel>> values_;  // passes are copied; the table isn't
};

/// Maps `source` to `reference` as MATLAB's histeq does: a level goes to the first reference level whose cumulative
/// fraction reaches that of the source, which counts half of the level itself except at the first and the last level.
template <class Pixel>
level_map<Pixel> map_levels(std::span<const std::uint64_t> source, std::span<const std::uint64_t> reference) {
    const auto total = [](std::span<const std::uint64_t> counts) {
        return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    };
    const auto source_total = static_cast<double>((std::max)(total(source), std::uint64_t{1}));
    const auto reference_total = static_cast<double>(total(reference));
    constexpr double tolerance = 0x1p-26;
    const std::size_t levels = source.size();
    dynamic_array<Pixel> values(levels);
    std::uint64_t below = 0, reached = reference[0];
    std::size_t target = 0;
    for (std::size_t level = 0; level < levels; ++level) {
        below += source[level];
        const bool inner = level > 0 && level + 1 < levels;
        const double cumulative = static_cast<double>(below) - (inner ? 0.5 * static_cast<double>(source[level]) : 0);
        while (static_cast<double>(reached) / reference_total < cumulative / source_total - tolerance)
            reached += reference[++target];
        const double value = static_cast<double>(target) / static_cast<double>(reference.size() - 1);
        if constexpr (std::is_same_v<Pixel, float>)
            values[level] = static_cast<float>(value);
        else
            values[level] = static_cast<Pixel>((std::numeric_limits<Pixel>::max)() * value + 0.5);
    }
    return level_map<Pixel>(std::move(values));
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
