// Noise and reverberation besides the seabed: receiver noise, which time-varied gain raises with range, scatterers in
// the water, and the sea surface.
//
// The surface return begins straight above the sonar, at a slant range equal to the sonar's depth, as a bright line
// with a tail; volume reverberation comes from all ranges (R. J. Urick. Principles of Underwater Sound, 3rd edition,
// 1983, chapter 8). Intensities are those of a recording after its gain: 1 is a level bottom of reflectivity one under
// `level_gain`.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/filter/concept.hpp>
#include <insonify/sonar/detail/smooth_noise.hpp>
#include <insonify/sonar/side_scan/sonar_equation.hpp>

#include <algorithm>
#include <concepts>
#include <limits>
#include <optional>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// Pass of a water_column.
template <class Water>
class water_law {
  public:
    explicit water_law(const Water& w)
        : w_(w), key_(stream_key(w.seed, static_cast<std::uint32_t>(drift_stream::surface))) {}

    void prepare(const pixel_area& area) {
        first_ = area.x;
        mean_background_.clear();
        for (int i = 0; i < area.width; ++i) mean_background_.push_back(noise_at(range(area.x + i)) + w_.volume);
    }

    template <std::same_as<float> Pixel>
    Pixel operator()(Pixel intensity, int x, int y) {
        Pixel sum = intensity + mean_background_[static_cast<std::size_t>(x - first_)];
        if (w_.surface > 0) sum += surface_at(x, y);
        return sum;
    }

  private:
    double range(int x) const { return static_cast<double>(w_.first_range) + (x + 0.5) * static_cast<double>(w_.bin); }
    float noise_at(double range) const {
        if (w_.noise == 0 || !(range > 0)) return 0;
        const double over = range / static_cast<double>(w_.noise_range);
        const double gain = numeric::pow(over, 0.1 * static_cast<double>(w_.spreading)) *
                            from_decibels(0.002 * static_cast<double>(w_.absorption_per_km) *
                                          (range - static_cast<double>(w_.noise_range)));
        return static_cast<float>(
            (std::min)(static_cast<double>(w_.noise) * gain, static_cast<double>((std::numeric_limits<float>::max)())));
    }
    float surface_at(int x, int y) {
        if (y != row_) {
            row_ = y;
            begins_ = static_cast<double>(w_.surface_range) +
                      static_cast<double>(w_.waves) * smooth_noise(y / static_cast<double>(w_.wave_length), key_);
        }
        const double tail = (range(x) - begins_) / static_cast<double>(w_.surface_tail);
        // The onset takes a bin.
        const double onset = (range(x) - begins_) / static_cast<double>(w_.bin) + 1;
        if (onset <= 0 || tail > 80) return 0;
        return w_.surface * static_cast<float>((onset < 1 ? onset : 1.0) * (tail > 0 ? numeric::exp(-tail) : 1.0));
    }

    Water w_;
    philox_key key_;
    dynamic_array<float> mean_background_;
    int first_ = 0;
    std::optional<int> row_;  // that begins_ belongs to; no int can mark "none", as images may have any origin
    double begins_ = 0;
};

}  // namespace detail::inline INSONIFY_FLAGS

/// A filter that adds mean intensities by slant range; speckle applied later makes them fluctuate. Rows are pings,
/// columns bins of slant range. The surface varies with the ping: filter a part of a recording with its origin, as in
/// `apply(part, water, ex, {0, first_ping})`.
struct water_column {
    float first_range = 0;  ///< start of the first bin, metres
    float bin = 0.02f;      ///< metres, above 0

    float noise = 1e-3f;          ///< intensity of the receiver's noise at `noise_range`, >= 0
    float noise_range = 40;       ///< metres, above 0
    float spreading = 30;         ///< gain on the noise, decibels per tenfold range, 0 to 60
    float absorption_per_km = 0;  ///< the same for absorption, one way, 0 to 3000
    float volume = 0;             ///< intensity of scatterers in the water, >= 0

    float surface = 0;          ///< intensity of the surface return at its start, >= 0
    float surface_range = 10;   ///< metres from the sonar up to the surface, above 0
    float surface_tail = 0.3f;  ///< metres of range in which it decays to 1 / e, above 0
    float waves = 0.1f;         ///< rms of its variation in range, metres, >= 0
    float wave_length = 15;     ///< pings between nodes of the variation, at least 1
    std::uint64_t seed = 1;

    using is_filter = std::true_type;

    /// @throws invalid_input for a parameter out of its range
    INSONIFY_TAGGED auto pass() const {
        using detail::require_not_negative, detail::require_positive, detail::require_range;
        require_not_negative("water_column.first_range", first_range);
        require_positive("water_column.bin", bin);
        require_not_negative("water_column.noise", noise);
        require_positive("water_column.noise_range", noise_range);
        require_range("water_column.spreading", spreading, 0, 60, "0 to 60 dB");
        require_range("water_column.absorption_per_km", absorption_per_km, 0, 3000, "0 to 3000 dB");
        require_not_negative("water_column.volume", volume);
        require_not_negative("water_column.surface", surface);
        require_positive("water_column.surface_range", surface_range);
        require_positive("water_column.surface_tail", surface_tail);
        require_not_negative("water_column.waves", waves);
        require_range("water_column.wave_length", wave_length, 1, 1e9f, "1 to 1e9 pings");
        return detail::water_law<water_column>(*this);
    }
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
