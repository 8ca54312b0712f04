// Furrows of trawl doors: long, nearly straight, in a few directions.
//
// Furrows of one direction run in parallel, slightly meandering strips. A strip holds one furrow with gaps along it.
// The spoil lies in a low berm on either side.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/seabed/detail/interpolation.hpp>
#include <insonify/seabed/detail/ripple_train.hpp>
#include <insonify/seabed/detail/stretch.hpp>
#include <insonify/seabed/trawl_marks.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

/// Evaluates `trawl_marks`.
class trawl_furrows {
  public:
    trawl_furrows(const trawl_marks& t, std::uint64_t seed)
        : depth_(t.depth), width_(static_cast<double>(t.width)), hash_(seed, stream::trawls) {
        require_range("trawl_marks.width", t.width, 1e-3f, 1e6f, "0.001 to 10^6 metres");
        require(t.density >= 0 && 4 * t.density * t.width <= 1, "trawl_marks.density", t.density,
                "0 to 1 / (4 width) per metre");
        require_metres("trawl_marks.depth", t.depth);
        require_range("trawl_marks.directions", t.directions, 1, 8, "1 to 8");
        require_range("trawl_marks.length", t.length, 1e-3f, 1e6f, "0.001 to 10^6 metres");
        if (t.density == 0 || t.depth == 0) return;
        random_sequence random(seed, static_cast<std::uint32_t>(stream::trawls));
        const double turn = random.uniform();
        // A furrow is present along half of its strip.
        const double strip = 0.5 * t.directions / static_cast<double>(t.density);
        for (int n = 0; n < t.directions; ++n) {
            const auto heading = numeric::sin_cos_turns(turn + 0.5 * (n + 0.6 * random.uniform()) / t.directions);
            const double length = static_cast<double>(t.length);
            families_.push_back({heading.cosine, heading.sine, 1 / strip, 1 / length, 1 / (5.3 * length)});
        }
        half_width_ = static_cast<float>(0.5 * static_cast<double>(t.width) / strip);
    }

    void add(const stretch& part, stretch_values& values, isa level = best_isa()) const {
        if (!families_.empty()) add_relief(*this, part, values, level);
    }

    /// Bounds of the relief where furrows, or berms, of all directions cross, metres.
    double lowest() const { return -1.00001 * static_cast<double>(families_.size()) * static_cast<double>(depth_); }
    double highest() const { return -0.3 * lowest(); }

  private:
    friend relief_kernel<trawl_furrows>;

    /// Furrows of one direction.
    struct family {
        double cosine, sine, per_strip, per_length, per_bend;  // the last three per metre
    };

    template <int N>
    INSONIFY_INLINE void add_lanes(const stretch& part, float* values) const {
        const float band_gain = band_limit_gain(2 * width_, part.grid_spacing);  // a furrow between its berms
        if (band_gain == 0) return;
        for (std::size_t n = 0; n < families_.size(); ++n) {
            const family& f = families_[n];
            // Strips are counted from a group's first sample, in 32 bits.
            if (N * part.spacing * f.per_strip < 0x1p30)
                for (std::size_t i = 0; i < part.whole(); i += N) add_family<N>(f, n, band_gain, part, i, values + i);
            else
                for (std::size_t i = 0; i < part.count; ++i) add_family<1>(f, n, band_gain, part, i, values + i);
        }
    }

    template <int N>
    INSONIFY_INLINE void add_family(const family& f, std::size_t n, float band_gain, const stretch& part, std::size_t i,
                                    float* values) const {
        using insonify::detail::lane;
        using words = lanes<std::uint32_t, N>;
        using ints = lanes<std::int32_t, N>;
        const double across = part.y * f.cosine * f.per_strip;
        const std::int64_t first = numeric::floor_to_int(across - part.x[i] * f.sine * f.per_strip);
        lanes<float, N> distance, shift, bends, sine, cosine;
        ints cell;
        locate<N>(distance, cell, &part.x[i], -f.sine * f.per_strip, across, static_cast<double>(first));
        words bits;
        hash_[static_cast<std::int64_t>(n)].hash_lanes(bits, words(words(cell) + static_cast<std::uint32_t>(first)));
        insonify::detail::convert(shift, ints(ints(bits << 16) >> 16));
        insonify::detail::convert(bends, ints(ints(bits) >> 16));
        // A furrow stays within its strip, so that a sample meets one furrow at most.
        lanes<float, N> turns_along, phase = bends * 0x1p-16f;
        turns<N>(turns_along, &part.x[i], f.cosine * f.per_bend, part.y * f.sine * f.per_bend);
        phase = phase + turns_along;
        phase = phase > 0.5f ? phase - 1.0f : phase;
        phase = phase < -0.5f ? phase + 1.0f : phase;
        insonify::detail::cos_sin_turns<N>(cosine, sine, phase);
        distance = distance - (0.5f + (0.5f - 2 * half_width_) * (0.7f * shift * 0x1p-15f + 0.3f * sine));
        distance = (distance < 0.0f ? -distance : distance) * (1 / half_width_);
        if (!insonify::detail::any(ints(distance < 2.0f))) return;
        for (int k = 0; k < N; ++k) {
            if (lane(distance, k) >= 2) continue;
            values[k] += band_gain * depth_at(f, n, lane(bits, k), lane(distance, k),
                                              part.x[i + static_cast<std::size_t>(k)] * f.cosine + part.y * f.sine);
        }
    }

    /// @param bits      random bits of the strip
    /// @param distance  half widths from the furrow's middle
    /// @param along     metres
    float depth_at(const family& f, std::size_t n, std::uint32_t bits, float distance, double along) const {
        // A strip is divided into lengths with or without a furrow, faded where they meet.
        const lattice_coordinate u(along * f.per_length + static_cast<double>(bits) * 0x1p-32);
        const cell_hash::row presence = hash_[static_cast<std::int64_t>((std::uint64_t{bits} << 8) + n + 64)];
        const auto present = [&](std::int64_t cell) { return (presence(cell) & 1) != 0 ? 1.0f : 0.0f; };
        const float strength = lerp(present(u.cell), present(u.cell + 1), fade(saturate(8 * u.fraction - 7)));
        // A bowl down to -1 that rises to a berm of 0.3, which ends at twice the half width.
        const float inner = saturate(1 - distance * distance);
        return depth_ * strength * (distance < 1 ? 0.3f - 1.3f * inner * inner : 0.3f * fade(saturate(2 - distance)));
    }

    dynamic_array<family> families_;
    float depth_, half_width_ = 0;  // the latter in strips
    double width_;
    cell_hash hash_;
};

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
