// Layered seabeds: models composited over a base, each within its area, with a label at every point.
//
// High ground is buried last: across a border the layer rises through the ground below. Its crests emerge first, as
// narrow tips, while its troughs are still filled; the highest parts of the ground disappear last. Labels are those of
// the upper surface.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/seabed/area.hpp>
#include <insonify/seabed/flat.hpp>
#include <insonify/seabed/ripples.hpp>

#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

inline namespace INSONIFY_FLAGS {

class mixed_sampler;

}  // namespace INSONIFY_FLAGS

/// One bottom of a `mixed` seabed.
struct layer {
    any bottom = ripples{};
    area where = patches{};
    float border = 0.6f;  ///< metres, from 0.001: width of the border, about a ripple or two
    float ragged = 0.5f;  ///< metres, 0 to 10^5: rms deviation of a shape's outline; patches ignore it
};

/// Layers on a base, from the lowest to the highest.
///
///     mixed{.base = flat{}, .layers = {{ripples{}, patches{.coverage = 0.4f}}, {rock{}, disc{{10, 5}, 8}}}}
struct mixed {
    any base = flat{};
    std::vector<layer> layers;  ///< at most 64: each takes some 5 KB of stack while a row is evaluated
    std::uint64_t seed = 1;     ///< of the outlines; patches of different layers are independent

    /// The sampler owns what it needs.
    /// @throws invalid_input for parameters out of their range
    INSONIFY_TAGGED mixed_sampler prepare() const;
    INSONIFY_TAGGED std::vector<type_properties> legend() const {
        std::vector<type_properties> all = base.legend();
        for (const layer& l : layers) extend(all, l.bottom.legend());
        return all;
    }
};

namespace detail::inline INSONIFY_FLAGS {

/// The transition across a layer's border.
class border {
  public:
    /// @param width   metres, > 0
    /// @param relief  metres: the larger of the layer's and the lower ground's
    border(float width, float relief) : per_metre_(1 / width), relief_(relief + 1e-6f) {}

    /// Progress across the border: 0 outside of the layer, 1 where it hides the ground below.
    float across(float margin) const { return saturate(0.5f + margin * per_metre_); }

    struct composite {
        float height;
        bool is_layer;
    };
    /// The upper surface at progress `t`; at 0 exactly the ground, at 1 exactly the layer.
    composite at(float t, float below, float layer) const {
        const float height_difference = layer - below;
        if (t <= 0) return {below, false};
        if (t >= 1) return {layer, true};
        // Relief beyond the expected range fades.
        if (t < 0.5f) {
            const float over = height_difference - relief_ * (1 - 2 * t);
            return {over > 0 ? below + over * saturate(4 * t) : below, over > 0};
        }
        const float over = -height_difference - relief_ * (2 * t - 1);
        return {over > 0 ? layer + over * saturate(4 - 4 * t) : layer, !(over > 0)};
    }

  private:
    float per_metre_, relief_;
};

/// Range of samples of a row.
struct sample_range {
    std::size_t begin, end = 0;

    void include(std::size_t i) {
        begin = (std::min)(begin, i);
        end = i + 1;
    }
    std::size_t size() const { return end > begin ? end - begin : 0; }
    template <class T>
    std::span<T> of(std::span<T> row) const {
        return row.empty() ? row : row.subspan(begin, size());
    }
};

/// Composites a layer over the ground below. `below(line, heights, types)` evaluates the ground where the layer does
/// not hide it.
template <class Below, typed_sampler Layer>
void lay_over(const area_sampler& where, const border& edge, const Layer& layer, const scanline& line,
              std::span<float> heights, std::span<type> types, Below&& below) {
    const std::size_t count = heights.size();
    const stretch part(line, count);
    stretch_values across;
    where.signed_distances(part, across);
    // Away from borders only one of the two is evaluated.
    sample_range above{count}, under{count};
    for (std::size_t i = 0; i < count; ++i) {
        across[i] = edge.across(across[i]);
        if (across[i] > 0) above.include(i);
        if (across[i] < 1) under.include(i);
    }
    if (under.size() > 0) below(line.from(under.begin), under.of(heights), under.of(types));
    if (above.size() == 0) return;

    std::array<float, chunk> other;
    std::array<type, chunk> other_types;
    const std::span<float> layer_heights(other.data(), count);
    const std::span<type> layer_types(other_types.data(), types.size());
    layer.row(line.from(above.begin), above.of(layer_heights), above.of(layer_types));
    for (std::size_t i = above.begin; i < above.end; ++i) {
        const border::composite top = edge.at(across[i], heights[i], other[i]);
        heights[i] = top.height;
        if (top.is_layer && !types.empty()) types[i] = other_types[i];
    }
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Evaluates `mixed`.
class mixed_sampler {
  public:
    explicit mixed_sampler(const mixed& m) : base_(m.base.prepare()) {
        detail::require(m.layers.size() <= 64, "mixed.layers.size()", m.layers.size(), "at most 64");
        float relief = m.base.sink_depth();
        for (std::uint32_t i = 0; i < m.layers.size(); ++i) {
            const layer& l = m.layers[i];
            relief = (std::max)(relief, l.bottom.sink_depth());
            // Named, since g++ 11 loses the members of an unnamed aggregate that is half made when an error is thrown.
            prepared_layer top{l.bottom.prepare(), {l.where, l.border, l.ragged, m.seed, i}, {l.border, relief}};
            layers_.push_back(std::move(top));
        }
    }

    void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        for (std::size_t i = 0; i < heights.size(); i += detail::chunk) {
            const std::size_t count = (std::min)(detail::chunk, heights.size() - i);
            fill(layers_.size(), line.from(i), heights.subspan(i, count),
                 types.empty() ? types : types.subspan(i, count));
        }
    }

    height_range range() const {
        height_range all = base_.range();
        for (const prepared_layer& l : layers_) all = merge(all, l.bottom.range());
        return all;
    }

  private:
    /// The base with the first `count` layers, for at most a chunk of samples.
    void fill(std::size_t count, const scanline& line, std::span<float> heights, std::span<type> types) const {
        if (count == 0) return base_.row(line, heights, types);
        const prepared_layer& top = layers_[count - 1];
        detail::lay_over(top.where, top.edge, top.bottom, line, heights, types,
                         [&](const scanline& l, std::span<float> h, std::span<type> t) { fill(count - 1, l, h, t); });
    }

    struct prepared_layer {
        any_sampler bottom;
        detail::area_sampler where;
        detail::border edge;
    };
    any_sampler base_;
    detail::dynamic_array<prepared_layer> layers_;
};

}  // namespace INSONIFY_FLAGS

inline mixed_sampler mixed::prepare() const {
    return mixed_sampler(*this);
}

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
