// Composites one seabed over another with a natural border: high ground is buried last.
//
// Across a border the layer rises through the ground below: its crests emerge first, as narrow tips, while its troughs
// are still filled; the highest parts of the ground disappear last. Labels are those of the upper surface.
#pragma once

#include <insonify/seabed/any.hpp>
#include <insonify/seabed/area.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

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
        const float rise = layer - below;
        if (t <= 0) return {below, false};
        if (t >= 1) return {layer, true};
        // Relief beyond the expected range fades.
        if (t < 0.5f) {
            const float over = rise - relief_ * (1 - 2 * t);
            return {over > 0 ? below + over * saturate(4 * t) : below, over > 0};
        }
        const float over = -rise - relief_ * (2 * t - 1);
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

/// Calls `fill(line, heights, types)` for parts of a row no longer than a stretch.
template <class Fill>
void by_parts(const scanline& line, std::span<float> heights, std::span<type> types, Fill&& fill) {
    for (std::size_t i = 0; i < heights.size(); i += chunk) {
        const std::size_t count = (std::min)(chunk, heights.size() - i);
        fill(line.from(i), heights.subspan(i, count), types.empty() ? types : types.subspan(i, count));
    }
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
