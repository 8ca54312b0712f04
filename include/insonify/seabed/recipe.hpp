// What a seabed recipe is: a height and a type at every point of the world, by itself or a row at a time.
//
// A recipe is a plain aggregate of parameters. `prepare` turns it into a sampler, which holds what is worth computing
// once (wave vectors, octaves) and evaluates rows; a row is the primitive, a single point is a row of one sample.
#pragma once

#include <insonify/core/error.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

/// What the bottom is made of, as a label, for the backscatter law and for speckle: four that say what it looks like,
/// and the twelve of `sediment` (see sediment.hpp).
enum class type : std::uint8_t {
    sand,
    ripples,
    mud,
    rock,
    rough_rock,
    hard_rock,
    cobble,
    sandy_gravel,
    coarse_sand,
    medium_sand,
    fine_sand,
    very_fine_sand,
    coarse_silt,
    medium_silt,
    sandy_mud,
    silty_clay,
};
inline constexpr std::size_t type_count = 16;

/// Equally spaced samples along x: sample i lies at (x(i), y), metres in the world. Each position is computed from i
/// alone, never accumulated, and parts of a row keep their origin: cutting a row changes no bit of it.
struct scanline {
    double y = 0;
    double origin = 0;       ///< x of sample 0 of the whole row
    double spacing = 1;      ///< >= 0
    std::int64_t first = 0;  ///< which sample of the whole row is sample 0 here; any, below 0 too
    /// Metres between the vertices of the grid that the row is part of: relief that it can't carry fades out (see
    /// `carried`). 0: nothing does.
    double grid_spacing = 0;

    double x(std::size_t i) const { return origin + spacing * static_cast<double>(number(i)); }
    scanline from(std::size_t i) const { return {y, origin, spacing, number(i), grid_spacing}; }

  private:
    std::int64_t number(std::size_t i) const { return first + static_cast<std::int64_t>(i); }
};

/// The share in [0, 1] of a wave's amplitude that a grid keeps: nothing of two samples a wave or fewer, which would
/// show up as another wave, and all from four on. Both in the same unit; a spacing of 0 keeps everything.
///
/// Alan Norton, Alyn P. Rockwood, Philip T. Skolmoski. Clamping: A Method of Antialiasing Textured Surfaces by
/// Bandwidth Limiting in Object Space. SIGGRAPH, 1982.
constexpr float carried(double wavelength, double spacing) {
    if (wavelength >= 4 * spacing) return 1;
    return wavelength <= 2 * spacing ? 0.0f : static_cast<float>(2 - 4 * spacing / wavelength);
}

/// Writes the heights of a row, in metres above the datum z = 0. Heights depend on seed and position alone; positions
/// are good to 1e9 m from the origin. Its type is either one, `kind`, or one per sample (see `typed_sampler`).
template <class S>
concept sampler = requires(const S& s, const scanline& row, std::span<float> heights) {
    s.row(row, heights);
};

/// Also writes the type of each sample; `types` is as long as `heights`, or empty where nobody asks.
template <class S>
concept typed_sampler = requires(const S& s, const scanline& row, std::span<float> heights, std::span<type> types) {
    s.row(row, heights, types);
};

/// Recipes of a single type say so: by a member, or for all of them by a static one.
template <class R>
concept single_typed = requires(const R& r) {
    { r.kind } -> std::convertible_to<type>;
};

/// Anything that `prepare`s a sampler and answers for a single point.
/// It has one type, `kind`, or one per point, `type type_at(x, y)` and a typed sampler.
template <class R>
concept recipe = requires(const R& r, double x, double y) {
    { r(x, y) } -> std::convertible_to<float>;
    r.prepare();
}
&&(single_typed<R> || (requires(const R& r) {
       { r.type_at(0.0, 0.0) } -> std::convertible_to<type>;
   } && typed_sampler<decltype(std::declval<const R&>().prepare())>));

/// Heights that a seabed never leaves, metres above the datum; nothing at all where lowest > highest. Library seabeds
/// prove theirs, with a little room for rounding: what may throw a shadow is found by it.
struct height_range {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -std::numeric_limits<double>::infinity();

    bool empty() const { return !(lowest <= highest); }
};
inline height_range merge(const height_range& a, const height_range& b) {
    return {(std::min)(a.lowest, b.lowest), (std::max)(a.highest, b.highest)};
}

/// Samplers that know it.
template <class S>
concept bounded_sampler = requires(const S& s) {
    { s.range() } -> std::same_as<height_range>;
};

namespace detail {

using insonify::detail::refuse;
using insonify::detail::require;

/// How many samples are worked on at a time where scratch space is needed.
inline constexpr std::size_t chunk = 256;

/// Gives the sampler of a single-typed recipe the interface of a typed one.
template <sampler S>
struct with_kind {
    S heights_only;
    type kind;

    void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        heights_only.row(line, heights);
        std::fill(types.begin(), types.end(), kind);
    }
    height_range range() const requires(bounded_sampler<S>) { return heights_only.range(); }
};

}  // namespace detail

/// The typed sampler of a recipe: what the rest of the library evaluates.
/// @throws invalid_input for parameters out of their range
template <recipe R>
auto prepare(const R& r) {
    if constexpr (single_typed<R>) {
        return detail::with_kind<decltype(r.prepare())>{r.prepare(), r.kind};
    } else {
        return r.prepare();
    }
}

/// One of several samplers.
template <typed_sampler... Samplers>
struct variant_sampler {
    std::variant<Samplers...> alternatives;

    void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        std::visit([&](const auto& s) { s.row(line, heights, types); }, alternatives);
    }
    height_range range() const requires(bounded_sampler<Samplers>&&...) {
        return std::visit([](const auto& s) { return s.range(); }, alternatives);
    }
};

/// A variant of recipes prepares whichever it holds.
template <recipe... Recipes>
auto prepare(const std::variant<Recipes...>& r) {
    using result = variant_sampler<decltype(prepare(std::declval<const Recipes&>()))...>;
    return std::visit([](const auto& held) { return result{prepare(held)}; }, r);
}

/// A recipe, or a variant of recipes.
template <class R>
concept preparable = requires(const R& r) {
    { seabed::prepare(r) } -> typed_sampler;
};

/// Height and type at one point.
struct ground {
    float height;
    type kind;
};
template <typed_sampler S>
ground at(const S& prepared, double x, double y) {
    ground result{};
    prepared.row({.y = y, .origin = x}, {&result.height, 1}, {&result.kind, 1});
    return result;
}

/// Height at one point, for the call operators of recipes.
template <sampler S>
float height_at(const S& prepared, double x, double y) {
    float height = 0;
    prepared.row({.y = y, .origin = x}, {&height, 1});
    return height;
}

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
