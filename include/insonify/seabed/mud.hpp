// Mud: gentle relief with the mounds and pock marks of what lives and seeps in it.
#pragma once

#include <insonify/seabed/noise.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

class mud_sampler;

/// Fine sediment: low, smooth relief; scattered mounds and pock marks, each a round bump or dent.
struct mud {
    static constexpr type kind = type::mud;

    roughness surface{.rms = 0.012f, .longest = 3.0f, .shortest = 0.15f, .exponent = 3.6f};
    float density = 0.2f;        ///< mounds and pock marks per square metre, at most 1 / (4 size)^2; 0 for none
    float size = 0.35f;          ///< metres, > 0: radius of the largest; the smallest have 0.4 of it
    float mound_height = 0.04f;  ///< metres, >= 0: of the largest mounds
    float pock_depth = 0.04f;    ///< metres, >= 0: of the largest pock marks
    float pock_share = 0.4f;     ///< in [0, 1]: how many of them are pock marks
    std::uint64_t seed = 1;

    /// @throws invalid_input for parameters out of their range
    mud_sampler prepare() const;
    float operator()(double x, double y) const;
};

/// Evaluates `mud`.
class mud_sampler {
  public:
    explicit mud_sampler(const mud& m)
        : surface_(m.surface, m.seed, detail::stream::mud),
          hash_(m.seed, detail::stream::mounds),
          mound_(m.mound_height),
          pock_(-m.pock_depth) {
        const float cell = 4 * m.size;
        detail::require(m.size > 0 && m.size < 1e6f, "mud.size", m.size, "metres above 0");
        detail::require(m.density >= 0 && m.density * cell * cell <= 1, "mud.density", m.density,
                        "0 to 1 / (4 size)^2 per square metre");
        detail::require(m.mound_height >= 0 && m.mound_height < 1e6f, "mud.mound_height", m.mound_height,
                        "metres, at least 0");
        detail::require(m.pock_depth >= 0 && m.pock_depth < 1e6f, "mud.pock_depth", m.pock_depth, "metres, at least 0");
        detail::require(m.pock_share >= 0 && m.pock_share <= 1, "mud.pock_share", m.pock_share, "0 to 1");
        lattice_.frequency = 1 / static_cast<double>(cell);
        filled_ = m.density * cell * cell;
        mounds_ = filled_ * (1 - m.pock_share);
    }

    void row(const scanline& line, std::span<float> heights) const {
        std::fill(heights.begin(), heights.end(), 0.0f);
        surface_.add_row(line, heights);
        if (filled_ > 0) add_features(line, heights);
    }

  private:
    // A cell holds one feature or none, wholly inside it: no neighbour needs to be looked at.
    void add_features(const scanline& line, std::span<float> heights) const {
        const float kept = carried(1 / lattice_.frequency, line.grid_spacing);  // the largest span half a cell
        if (kept == 0) return;
        const detail::lattice_coordinate v(line.y * lattice_.frequency);
        const auto hash = hash_[v.cell];
        float height = 0, x = 0, y_square = 0, inverse_square = 0;
        detail::walk(
            lattice_, line, heights.size(),
            [&](std::int64_t column) {
                const std::uint64_t bits = hash(column);
                const detail::pair_of_bits centre(bits), traits(detail::scramble(bits));
                const float radius = 0.175f + 0.075f * traits.a;  // in cells; a quarter at most
                const float chance = 0.5f * traits.b + 0.5f;
                const float scale = radius * 4;
                height = kept * (chance < mounds_ ? mound_ * scale : chance < filled_ ? pock_ * scale : 0.0f);
                x = 0.5f + 0.25f * centre.a;
                const float y = v.fraction - (0.5f + 0.25f * centre.b);
                y_square = y * y;
                inverse_square = 1 / (radius * radius);
            },
            [&](std::size_t i, float t) {
                const float inside = detail::clamp01(1 - ((t - x) * (t - x) + y_square) * inverse_square);
                heights[i] += height * inside * inside;
            });
    }

    power_law_noise surface_;
    detail::cell_hash hash_;
    detail::lattice lattice_;
    float mound_, pock_;
    float filled_ = 0, mounds_ = 0;  // how many cells hold a feature, and how many a mound
};

inline mud_sampler mud::prepare() const {
    return mud_sampler(*this);
}
inline float mud::operator()(double x, double y) const {
    return height_at(prepare(), x, y);
}

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
