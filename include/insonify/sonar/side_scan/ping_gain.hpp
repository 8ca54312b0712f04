// Residual gain errors of a receiver: drift across range, and from ping to ping.
//
// Recordings are corrected for spreading, absorption and beam pattern by models that don't hold exactly, so a level
// bottom is shown brighter at some ranges than at others; heave, roll and aeration make whole pings brighter or
// darker (P. Blondel. The Handbook of Sidescan Sonar, 2009, chapter 4; P. Cervenka, C. de Moustier. Sidescan Sonar
// Image Processing Techniques. IEEE Journal of Oceanic Engineering 18, 1993). Both are filters of intensities: rows are
// pings, columns are bins.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/filter/concept.hpp>
#include <insonify/sonar/detail/smooth_noise.hpp>
#include <insonify/sonar/side_scan/sonar_equation.hpp>

#include <concepts>
#include <optional>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

inline void check_decibels(const char* name, float value) {
    require_range(name, value, 0, 60, "0 to 60 dB");
}
inline void check_length(const char* name, float value) {
    require_range(name, value, 1, 1e9f, "1 to 1e9 pixels");
}

/// A gain as a float, at most 2^127: infinity would make the zeros of shadows NaN.
inline float gain_of(double decibels) {
    return static_cast<float>((std::min)(from_decibels(decibels), 0x1p127));
}

/// Pass of a range_gain_error: factors by column, computed once for each.
template <class Error>
class range_gain_law {
  public:
    explicit range_gain_law(const Error& e)
        : e_(e), curve_(stream_key(e.seed, static_cast<std::uint32_t>(drift_stream::range_gain))) {}

    void prepare(const pixel_area& area) {
        first_ = area.x;
        factors_.clear();
        for (int i = 0; i < area.width; ++i)
            factors_.push_back(gain_of(static_cast<double>(e_.slope) * ((i + 0.5) / area.width - 0.5) +
                                       static_cast<double>(e_.rms) *
                                           smooth_noise((area.x + i) / static_cast<double>(e_.length), curve_)));
    }
    template <std::same_as<float> Pixel>
    Pixel operator()(Pixel intensity, int x, int) const {
        return intensity * factors_[static_cast<std::size_t>(x - first_)];
    }

  private:
    Error e_;
    philox_key curve_;
    int first_ = 0;
    dynamic_array<float> factors_;
};

/// Pass of a ping_banding.
template <class Banding>
class banding_law {
  public:
    explicit banding_law(const Banding& b)
        : b_(b),
          drift_(stream_key(b.seed, static_cast<std::uint32_t>(drift_stream::ping_gain))),
          jitter_(stream_key(b.seed, static_cast<std::uint32_t>(drift_stream::ping_jitter))) {}

    template <std::same_as<float> Pixel>
    Pixel operator()(Pixel intensity, int, int y) {
        if (y != row_) row_ = y, factor_ = factor_of(b_.first_ping + b_.step * std::int64_t{y});
        return intensity * factor_;
    }

  private:
    float factor_of(std::int64_t ping) const {
        const double at = static_cast<double>(ping) / static_cast<double>(b_.length);
        return gain_of(static_cast<double>(b_.drift) * smooth_noise(at, drift_) +
                       static_cast<double>(b_.jitter) * lattice_normal(ping, 0, 0, jitter_));
    }

    Banding b_;
    philox_key drift_, jitter_;
    std::optional<int> row_;  // that factor_ belongs to; no int can mark "none", as images may have any origin
    float factor_ = 1;
};

}  // namespace detail::inline INSONIFY_FLAGS

/// Residual error of time-varied gain across range, in decibels: a slope, and a smooth random curve. The same in all
/// rows.
struct range_gain_error {
    float rms = 1.5f;    ///< decibels of the random curve, 0 to 60
    float length = 120;  ///< bins between nodes of the curve, 1 to 1e9; values two nodes apart are independent
    float slope = 0;     ///< decibels from the left edge of the given picture to the right, -60 to 60; 0 in the middle
    std::uint64_t seed = 1;

    using is_filter = std::true_type;

    /// @throws invalid_input for a parameter out of its range
    INSONIFY_TAGGED auto pass() const {
        detail::check_decibels("range_gain_error.rms", rms);
        detail::check_length("range_gain_error.length", length);
        detail::require_range("range_gain_error.slope", slope, -60, 60, "-60 to 60 dB");
        return detail::range_gain_law<range_gain_error>(*this);
    }
};

/// Pings that are brighter or darker than adjacent ones, in decibels: drift over many pings, and independent jitter of
/// each. Row `y` is ping first_ping + step * y, so that recordings made in pieces fit together.
struct ping_banding {
    float drift = 1;              ///< decibels (rms), 0 to 60
    float length = 40;            ///< pings between nodes of the drift, 1 to 1e9
    float jitter = 0.5f;          ///< decibels (rms), 0 to 60
    std::int64_t first_ping = 0;  ///< within 2^61
    int step = 1;                 ///< 1 or -1
    std::uint64_t seed = 1;

    using is_filter = std::true_type;

    /// @throws invalid_input for a parameter out of its range
    INSONIFY_TAGGED auto pass() const {
        constexpr std::int64_t farthest = std::int64_t{1} << 61;
        detail::require_range("ping_banding.first_ping", first_ping, -farthest, farthest, "within 2^61");
        detail::check_decibels("ping_banding.drift", drift);
        detail::check_length("ping_banding.length", length);
        detail::check_decibels("ping_banding.jitter", jitter);
        detail::require(step == 1 || step == -1, "ping_banding.step", step, "1 or -1");
        return detail::banding_law<ping_banding>(*this);
    }
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
