// Rock: outcrops that step up from the bottom, broken into blocks, boulders and rubble.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/seabed/roughness.hpp>

#if INSONIFY_BODIES
#include <insonify/seabed/detail/blocks.hpp>
#include <insonify/seabed/detail/noise.hpp>
#endif

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Outcrops with steep faces, blocks on and around them, and rough surfaces.
///
/// Blocks come in sizes that halve from one class to the next. Above a size there are N of them per square metre,
/// N ~ size^-sizes; height is proportional to size.
struct rock {
    float relief = 0.5f;   ///< metres, >= 0: about the height of outcrops with their blocks
    float outcrop = 6.0f;  ///< metres, from 0.001: typical distance between outcrops
    float block = 1.4f;  ///< metres, from 0.001: spacing of the largest blocks, whose widths are 0.6 to 1.8 times that
    float smallest = 0.3f;   ///< metres, in [0.001, block]: spacing of the smallest
    float sizes = 2.2f;      ///< in [0, 4]: exponent of the numbers of blocks; at 2 each class covers the same area
    float fracture = 0.5f;   ///< in [0, 1]: fraction of lattice cells that hold a block of the most frequent size
    float steepness = 2.5f;  ///< > 0: slope of a block's walls before burial, 1 is 45 degrees. Burial leaves 0.3 of it
                             ///< beside outcrops, 0.8 on them; blocks of several sizes and outcrop faces add up
    roughness surface{.rms = 0.012f, .longest = 0.8f, .shortest = 0.08f};
    std::uint64_t seed = 1;
    type kind = type::rock;

    /// @throws invalid_input for parameters out of their range
    INSONIFY_TAGGED_ONCE any_sampler prepare() const;
    INSONIFY_MEMBER float sink_depth() const { return 0.5f * relief + 2 * surface.rms; }
};

#if INSONIFY_BODIES

inline namespace INSONIFY_FLAGS {

/// Evaluates `rock`.
class rock_sampler {
  public:
    explicit rock_sampler(const rock& r) : surface_(r.surface, r.seed, detail::stream::rubble), relief_(r.relief) {
        detail::require_metres("rock.relief", r.relief);
        detail::require_range("rock.outcrop", r.outcrop, 1e-3f, 1e6f, "0.001 to 10^6 metres");
        detail::require_positive_metres("rock.block", r.block);
        detail::require_range("rock.smallest", r.smallest, 1e-3f, r.block, "metres from 0.001 to rock.block");
        detail::require_range("rock.sizes", r.sizes, 0, 4, "0 to 4");
        detail::require_fraction("rock.fracture", r.fracture);
        detail::require(r.steepness > 0 && r.steepness < 1e6f, "rock.steepness", r.steepness, "above 0 and below 10^6");
        double outcrop_cell = static_cast<double>(r.outcrop) / 2;
        for (std::uint32_t k = 0; k < 3; ++k, outcrop_cell /= 2)
            outcrops_.push_back(detail::gradient_noise(outcrop_cell, {r.seed, detail::stream::outcrops, k}));
        // Blocks of half the size are 2^sizes times as many, in four times as many cells.
        const float ratio = static_cast<float>(numeric::pow(2, static_cast<double>(r.sizes) - 2));
        float share = 1, largest_share = 1, spacing = r.block;
        detail::dynamic_array<float> shares;
        for (; shares.empty() || spacing >= r.smallest; spacing /= 2, share *= ratio) {
            shares.push_back(share);
            largest_share = (std::max)(largest_share, share);
        }
        spacing = r.block;
        float height = 0.8f * r.relief;
        for (std::uint32_t k = 0; k < shares.size(); ++k, spacing /= 2, height /= 2) {
            blocks_.push_back({static_cast<double>(spacing),
                               r.fracture * shares[k] / largest_share,
                               height,
                               r.steepness,
                               {r.seed, detail::stream::blocks, k}});
        }
    }

    void row(const scanline& line, std::span<float> heights) const {
        detail::by_stretches(line, heights, [&](const detail::stretch& part, detail::stretch_values& values) {
            if (relief_ > 0) detail::add_relief(*this, part, values, best_isa());
            surface_.add(part, values);
        });
    }

    height_range range() const {
        double blocks = 0;
        for (const detail::block_layer& layer : blocks_) blocks += layer.upper_bound();
        // See add_lanes: the top of an outcrop, and the fraction of its blocks' height that rises above it.
        const double top = 1.00001 * (0.4 * static_cast<double>(relief_) + 0.8 * blocks);
        return {-surface_.upper_bound(), surface_.upper_bound() + top};
    }

  private:
    friend detail::relief_kernel<rock_sampler>;

    template <int N>
    INSONIFY_INLINE void add_lanes(const detail::stretch& part, float* heights) const {
        using lanes = insonify::detail::lanes<float, N>;
        using insonify::detail::load;
        using insonify::detail::store;
        // Where a noise exceeds a threshold, the bottom steps up to the top of an outcrop over a steep face.
        detail::stretch_values weights{}, tops;
        float amplitude = 1;
        for (const detail::gradient_noise& octave : outcrops_) {
            octave.template add<N>(part, amplitude * octave.band_gain_on(part), weights.data());
            amplitude *= 0.5f;
        }
        for (std::size_t i = 0; i < part.whole(); i += N) {
            lanes n, step, height;
            load(n, &weights[i]);
            n = 0.5f + 1.8f * (n - 0.25f);
            detail::saturate_lanes(n);
            detail::fade(step, n);
            load(height, heights + i);
            height = height + (0.4f * relief_) * step;
            store(heights + i, height);
            // Blocks are exposed on an outcrop and mostly buried by sediment around it.
            step = 0.3f + 0.5f * step;
            store(&weights[i], step);
        }
        for (const detail::block_layer& layer : blocks_) {
            const float band_gain = layer.band_gain_on(part);
            if (band_gain == 0) break;  // smaller blocks are not resolved either
            tops.fill(0);
            layer.template raise<N>(part, tops.data());
            for (std::size_t i = 0; i < part.whole(); i += N) {
                lanes top, weight, height;
                load(top, &tops[i]);
                load(weight, &weights[i]);
                load(height, heights + i);
                height = height + band_gain * (weight * top);
                store(heights + i, height);
            }
        }
    }

    detail::dynamic_array<detail::gradient_noise> outcrops_;
    detail::dynamic_array<detail::block_layer> blocks_;
    detail::power_law_noise surface_;
    float relief_;
};

}  // namespace INSONIFY_FLAGS

INSONIFY_FUNCTION any_sampler rock::prepare() const {
    return detail::hold_sampler(detail::with_kind<rock_sampler>{rock_sampler(*this), kind});
}

#endif

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
