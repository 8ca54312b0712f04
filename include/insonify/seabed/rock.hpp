// Rock: outcrops that stand out of the bottom in ridges, broken into blocks and rubble.
#pragma once

#include <insonify/seabed/blocks.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

class rock_sampler;

/// Outcrops with steep faces, blocks of three sizes on and around them, and rough surfaces.
struct rock {
    static constexpr type kind = type::rock;

    float relief = 0.5f;     ///< metres, >= 0: about the height of ridges with their blocks
    float outcrop = 6.0f;    ///< metres, > 0: from ridge to ridge
    float block = 1.4f;      ///< metres, > 0: spacing of the largest blocks; others have 1/2 and 1/4 of it
    float fracture = 0.5f;   ///< in [0, 1]: how many places hold a block
    float steepness = 2.5f;  ///< > 0: slope of the walls of blocks, 1 is 45 degrees
    roughness surface{.rms = 0.012f, .longest = 0.8f, .shortest = 0.04f, .exponent = 3.0f};
    std::uint64_t seed = 1;

    /// @throws invalid_input for parameters out of their range
    rock_sampler prepare() const;
    float operator()(double x, double y) const;
};

/// Evaluates `rock`.
class rock_sampler {
  public:
    explicit rock_sampler(const rock& r) : surface_(r.surface, r.seed, detail::stream::rubble), relief_(r.relief) {
        detail::require(r.relief >= 0 && r.relief < 1e6f, "rock.relief", r.relief, "metres, at least 0");
        detail::require(r.outcrop > 0 && r.outcrop < 1e6f, "rock.outcrop", r.outcrop, "metres above 0");
        detail::require(r.block > 0 && r.block < 1e6f, "rock.block", r.block, "metres above 0");
        detail::require(r.fracture >= 0 && r.fracture <= 1, "rock.fracture", r.fracture, "0 to 1");
        detail::require(r.steepness > 0 && r.steepness < 1e6f, "rock.steepness", r.steepness, "a slope above 0");
        double cell = static_cast<double>(r.outcrop) / 2;
        for (std::uint32_t k = 0; k < 3; ++k, cell /= 2) {
            ridges_.push_back(gradient_noise(cell, {r.seed, detail::stream::ridges, k}));
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            const float size = r.block / static_cast<float>(1 << k);
            // Small blocks hold less height than their size would allow: rubble lies, it doesn't stand.
            const float height = 0.8f * r.relief / static_cast<float>(1 << k);
            blocks_.push_back(
                {static_cast<double>(size), r.fracture, height, r.steepness, {r.seed, detail::stream::blocks, k}});
        }
    }

    void row(const scanline& line, std::span<float> heights) const {
        for (std::size_t i = 0; i < heights.size(); i += detail::chunk) {
            part(line.from(i), heights.subspan(i, (std::min)(detail::chunk, heights.size() - i)));
        }
    }

    height_range range() const {
        double top = surface_.most(), octave = 1.00001 * 0.35 * static_cast<double>(relief_);
        for (std::size_t k = 0; k < ridges_.size(); ++k, octave *= 0.7) top += octave;
        for (const detail::block_layer& layer : blocks_) top += layer.most();
        return {-surface_.most(), top};
    }

  private:
    void part(const scanline& line, std::span<float> heights) const {
        // Ridged octaves: creases of the noise become crests, and where one is low the finer are lower still.
        // F. Kenton Musgrave, in: David S. Ebert and others. Texturing and Modeling: A Procedural Approach. 3rd
        // edition, 2003 (ridged multifractal).
        std::array<float, detail::chunk> weight;
        weight.fill(0.35f * relief_);
        std::fill(heights.begin(), heights.end(), 0.0f);
        for (const gradient_noise& octave : ridges_) {
            octave.row(line, heights.size(), [&](std::size_t i, float n) {
                const float crest = detail::clamp01(1 - 0.8f * (n < 0 ? -n : n));
                weight[i] *= crest * crest;
                heights[i] += weight[i];
                weight[i] *= 0.7f;
            });
        }
        // Blocks stand on the ridges and thin out between them, where sediment has buried them.
        for (std::size_t i = 0; i < heights.size(); ++i) {
            weight[i] = relief_ > 0 ? detail::clamp01(0.35f + 2.5f * heights[i] / relief_) : 0.0f;
        }
        for (const detail::block_layer& layer : blocks_) {
            layer.row(line, heights.size(), [&](std::size_t i, float h) { heights[i] += weight[i] * h; });
        }
        surface_.add_row(line, heights);
    }

    std::vector<gradient_noise> ridges_;
    std::vector<detail::block_layer> blocks_;
    power_law_noise surface_;
    float relief_;
};

inline rock_sampler rock::prepare() const {
    return rock_sampler(*this);
}
inline float rock::operator()(double x, double y) const {
    return height_at(prepare(), x, y);
}

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
