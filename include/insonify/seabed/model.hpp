// The concept of a seabed: heights and labels along rows of world points.
//
// A model is a copyable type with two or three members, the library's or a user's:
//
//     struct dunes {
//         static constexpr in::seabed::type_properties kind{in::seabed::user_type(0), "dunes", 0.6f, {.texture = 8}};
//         void row(const in::seabed::scanline& line, std::span<float> heights) const;  // metres above the datum
//         in::seabed::height_range range() const { return {-1, 1}; }                   // bounds of all heights
//     };
//
// `kind` is one of the library's labels or a label with properties. Seabeds of several labels write them in
// `row(line, heights, types)`, where `types` may be empty, and list them in `legend()`. Where parts are worth computing
// once (wave vectors, octaves), `prepare()` returns a sampler, whose `row` and `range` are used instead of the model's.
// Optional: `sink_depth()`, see `sink_depth_of`.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/seabed/registry.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Equally spaced samples along x: sample i lies at (x(i), y), metres in the world. Each position is computed from i
/// alone, never accumulated, and parts of a row keep their origin: cutting a row changes no bit of it.
struct scanline {
    double y = 0;
    double origin = 0;       ///< x of sample 0 of the whole row
    double spacing = 1;      ///< >= 0
    std::int64_t first = 0;  ///< index in the whole row of sample 0 here; may be negative
    /// Metres between the vertices of the grid that the row belongs to: random relief too fine for it fades out (see
    /// `band_limit_gain`), heightfields and edits do not. 0: no relief fades.
    double grid_spacing = 0;

    INSONIFY_MEMBER double x(std::size_t i) const { return origin + spacing * static_cast<double>(number(i)); }
    INSONIFY_MEMBER scanline from(std::size_t i) const { return {y, origin, spacing, number(i), grid_spacing}; }

  private:
    INSONIFY_MEMBER std::int64_t number(std::size_t i) const { return first + static_cast<std::int64_t>(i); }
};

inline namespace INSONIFY_FLAGS {

/// Gain, 0 to 1, on the amplitude of a wave that a grid samples: 0 up to two samples per wave, which would alias, and 1
/// from four on. Both in the same unit; at a spacing of 0 it is 1.
///
/// Alan Norton, Alyn P. Rockwood, Philip T. Skolmoski. Clamping: A Method of Antialiasing Textured Surfaces by
/// Bandwidth Limiting in Object Space. SIGGRAPH, 1982.
constexpr float band_limit_gain(double wavelength, double spacing) {
    if (wavelength >= 4 * spacing) return 1;
    return wavelength <= 2 * spacing ? 0.0f : static_cast<float>(2 - 4 * spacing / wavelength);
}

}  // namespace INSONIFY_FLAGS

/// Bounds of a seabed's heights, metres above the datum, rounding included; empty if lowest > highest. They decide how
/// far the bottom is sampled for shadows.
struct height_range {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -std::numeric_limits<double>::infinity();

    INSONIFY_MEMBER bool empty() const { return !(lowest <= highest); }
    /// The range of models that do not state one. Overhead pictures, `occlusion_of` and pitched pings refuse it.
    INSONIFY_MEMBER static constexpr height_range unlimited() {
        return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    }
};

inline namespace INSONIFY_FLAGS {

/// The smallest range that contains both.
inline height_range merge(const height_range& a, const height_range& b) {
    return {(std::min)(a.lowest, b.lowest), (std::max)(a.highest, b.highest)};
}

}  // namespace INSONIFY_FLAGS

/// Writes the heights of a row, in metres above the datum z = 0; NaN where there is no bottom. Heights depend on the
/// model and the position alone; positions are good to 1e9 m from the origin.
template <class S>
concept sampler = requires(const S& s, const scanline& row, std::span<float> heights) {
    s.row(row, heights);
};

/// Also writes the label of each sample; `types` is as long as `heights`, or empty where labels are not needed.
template <class S>
concept typed_sampler = requires(const S& s, const scanline& row, std::span<float> heights, std::span<type> types) {
    s.row(row, heights, types);
};

/// Samplers that state their heights.
template <class S>
concept bounded_sampler = requires(const S& s) {
    { s.range() } -> std::convertible_to<height_range>;
};

/// Models of a single label: `kind`, a `type` or `type_properties`, static or not.
template <class M>
concept single_typed = requires(const M& m) {
    { seabed::label_of(m.kind) } -> std::same_as<type>;
};

namespace detail::inline INSONIFY_FLAGS {

using insonify::detail::dynamic_array;
using insonify::detail::refuse;
using insonify::detail::require;
using insonify::detail::require_equal;
using insonify::detail::require_fraction;
using insonify::detail::require_range;
using insonify::detail::to_text;

template <std::floating_point Number>
void require_metres(std::string_view name, Number value) {
    require(value >= 0 && value < static_cast<Number>(1e6), name, value, "metres, at least 0 and below 10^6");
}
template <std::floating_point Number>
void require_positive_metres(std::string_view name, Number value) {
    require(value > 0 && value < static_cast<Number>(1e6), name, value, "metres above 0 and below 10^6");
}
inline void require_position(const std::string& name, const glm::dvec2& p) {
    require_range(name + ".x", p.x, -1e9, 1e9, "within 1e9 metres");
    require_range(name + ".y", p.y, -1e9, 1e9, "within 1e9 metres");
}

/// Samples per chunk where scratch memory is needed.
inline constexpr std::size_t chunk = 256;

/// Whether a model or sampler has a `range()` that would be ignored.
template <class S>
concept misstated_range = !bounded_sampler<S> && requires(S & s) {
    s.range();
};

/// Evaluates a model that has no `prepare()`.
template <class M>
struct by_reference {
    static_assert(!misstated_range<M>, "range() of a seabed is const and returns a seabed::height_range");
    const M* model;

    void row(const scanline& line, std::span<float> heights) const requires(sampler<M>) { model->row(line, heights); }
    void row(const scanline& line, std::span<float> heights, std::span<type> types) const requires(typed_sampler<M>) {
        model->row(line, heights, types);
    }
    height_range range() const requires(bounded_sampler<M>) { return model->range(); }
};

/// `prepare()`, or the model itself.
template <class M>
    requires(requires(const M& m) { m.prepare(); })
auto sampler_of(const M& m) {
    return m.prepare();
}
template <class M>
    requires(sampler<M> || typed_sampler<M>)
by_reference<M> sampler_of(const M& m) {
    return {&m};
}

/// Gives the sampler of a single label the interface of a typed one.
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

/// @throws invalid_input if the ends are in the wrong order or infinite, as those of a model without range()
inline void require_finite(const height_range& range) {
    const bool is_empty = range.lowest > range.highest;  // NaN is not
    if (is_empty && numeric::is_finite(range.lowest - range.highest))
        refuse("range().lowest of the seabed", range.lowest, "at most range().highest, " + to_text(range.highest));
    require(is_empty || numeric::is_finite(range.highest - range.lowest), "range() of the seabed",
            numeric::is_finite(range.highest) ? range.lowest : range.highest,
            "finite bounds of all heights (a model without range() has none)");
}

/// @throws invalid_input for a sonar below the whole seabed: probably a depth was passed as a height
inline void require_above(const height_range& range, std::string_view name, double altitude) {
    require(range.empty() || altitude > range.lowest, name, altitude,
            "above the seabed's lowest height, " + to_text(range.lowest + 0.0));  // not -0
}

/// The range of floats that are computed within a range: rounding may exceed it.
inline height_range with_rounding(const height_range& r) {
    const double error = 0x1p-21 * (std::max)(numeric::abs(r.lowest), numeric::abs(r.highest));
    return r.empty() ? r : height_range{r.lowest - error, r.highest + error};
}

/// @throws invalid_input for sampled heights beyond the range that their model states: their shadows would be cut off
inline void require_within(const height_range& stated, double lowest, double highest) {
    const height_range range = with_rounding(stated);
    if (lowest > highest) return;
    const double farthest = lowest < range.lowest ? lowest : highest;
    if (!(lowest >= range.lowest && highest <= range.highest))
        refuse("a height of the seabed", farthest,
               "heights within its range(), " + to_text(stated.lowest) + " to " + to_text(stated.highest));
}

/// The labels that a seabed's samples may have: the library's, and those in its legend.
class known_labels {
  public:
    explicit known_labels(const std::vector<type_properties>& legend) {
        std::fill_n(known_.begin(), type_count, true);
        for (const type_properties& p : legend) known_[index_of(p.label)] = true;
    }
    /// @throws invalid_input for another label, which would be drawn like sand and have no name
    void require_all(std::span<const type> samples) const {
        for (const type t : samples)
            if (!known_[index_of(t)])
                refuse("a label of the seabed", index_of(t), "one of the library's or one that its legend() lists");
    }

  private:
    std::array<bool, label_count> known_{};
};

template <class S>
height_range range_of(const S& s) {
    static_assert(!misstated_range<S>, "range() of a sampler is const and returns a seabed::height_range");
    if constexpr (bounded_sampler<S>) return s.range();
    return height_range::unlimited();
}

}  // namespace detail::inline INSONIFY_FLAGS

/// A seabed: see the top of this file.
template <class M>
concept model = requires(const M& m) {
    detail::sampler_of(m);
}
&&(typed_sampler<decltype(detail::sampler_of(std::declval<const M&>()))> ||
   (single_typed<M> && sampler<decltype(detail::sampler_of(std::declval<const M&>()))>));

inline namespace INSONIFY_FLAGS {

/// What the library evaluates: a typed sampler. It may refer to the model, which has to outlive it.
/// @throws invalid_input for parameters out of their range
template <model M>
auto prepare(const M& m) {
    using sampler_type = decltype(detail::sampler_of(m));
    if constexpr (typed_sampler<sampler_type>)
        return detail::sampler_of(m);
    else
        return detail::with_kind<sampler_type>{detail::sampler_of(m), label_of(m.kind)};
}

/// The label of the whole seabed, if it has only one.
template <model M>
std::optional<type> only_type(const M& m) {
    if constexpr (requires { m.only_type(); })
        return m.only_type();
    else if constexpr (single_typed<M>)
        return label_of(m.kind);
    else
        return std::nullopt;
}

/// The labels that may occur, with their properties, as far as the model states them.
template <model M>
std::vector<type_properties> legend_of(const M& m) {
    if constexpr (requires { m.legend(); })
        return m.legend();
    else if constexpr (requires { m.kind.label; })
        return {m.kind};
    else if constexpr (single_typed<M>)
        return {properties_of(m.kind)};
    else
        return {};
}

/// Appends the properties of labels that the legend lacks.
/// @throws invalid_input for a label that has other properties in the legend
inline void extend(std::vector<type_properties>& legend, const std::vector<type_properties>& more) {
    for (const type_properties& p : more) {
        const auto same =
            std::find_if(legend.begin(), legend.end(), [&](const type_properties& q) { return q.label == p.label; });
        if (same == legend.end())
            legend.push_back(p);
        else if (!(*same == p))
            detail::refuse(
                "type_properties.label of " + insonify::detail::quoted(p.name), index_of(p.label),
                "another label: this is that of " + insonify::detail::quoted(same->name) + ", with other properties");
    }
}

/// How far a layer must be lowered to vanish below another, metres: about the largest deviation of its surface from its
/// mean level. A model's `sink_depth()`, or half of its range.
template <model M>
float sink_depth_of(const M& m) {
    if constexpr (requires { m.sink_depth(); }) {
        return m.sink_depth();
    } else {
        const height_range all = detail::range_of(seabed::prepare(m));
        const double half = 0.5 * (all.highest - all.lowest);
        return half > 0 && half < 1e6 ? static_cast<float>(half) : 0.05f;
    }
}

}  // namespace INSONIFY_FLAGS

/// Height and label at one point.
struct ground {
    float height;
    type kind;
};

inline namespace INSONIFY_FLAGS {

/// Height and label at one position. For many positions prepare the model once, and pass the sampler.
/// @throws invalid_input for parameters of the model out of their range, or a position beyond 1e9 m
template <model M>
ground at(const M& m, double x, double y) {
    // Cells of the relief are counted in integers. Tested here first: require_position allocates the names of
    // arguments.
    if (!(x >= -1e9 && x <= 1e9 && y >= -1e9 && y <= 1e9)) detail::require_position("position", {x, y});
    ground result{};
    seabed::prepare(m).row({.y = y, .origin = x}, {&result.height, 1}, {&result.kind, 1});
    return result;
}

}  // namespace INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
