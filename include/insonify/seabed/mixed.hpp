// Layered seabeds: models composited over a base, each within its area, with a label at every point.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/seabed/cover.hpp>
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
        detail::by_parts(line, heights, types, [&](const scanline& l, std::span<float> h, std::span<type> t) {
            fill(layers_.size(), l, h, t);
        });
    }

    height_range range() const {
        height_range all = base_.range();
        for (const prepared_layer& l : layers_) all = merge(all, l.bottom.range());
        return all;
    }

  private:
    /// The base with the first `count` layers.
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
