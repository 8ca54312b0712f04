// Spatial variation of the seabed's backscatter: drift, streaks, and patches of another sediment.
//
// Even one kind of bottom is not uniformly gray: grain size, shell and cover change over metres to hundreds of metres
// (T. K. Stanton. Sonar Estimates of Seafloor Microroughness. JASA 75, 1984; J. S. Collier, C. J. Brown. Correlation
// of sidescan backscatter with grain size distribution of surficial seabed sediments. Marine Geology 214, 2005), and
// currents sort it into streaks along the flow. Levels are a function of (seed, position), so a bottom that is seen
// twice, from either side, has the same tone.
#pragma once

#include <insonify/sonar/detail/smooth_noise.hpp>
#include <insonify/sonar/side_scan/range_geometry.hpp>
#include <insonify/sonar/speckle.hpp>

#include <string>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Levels in decibels, added to the seabed's. No variation if all are 0.
struct bottom_tone {
    float drift = 0;              ///< rms of the drift, 0 to 30
    float drift_length = 20;      ///< metres between nodes of its coarsest octave, 1e-4 to 1e9
    int octaves = 3;              ///< each of half the length and half the level of the one before, 1 to 8
    float streaks = 0;            ///< rms of streaks, 0 to 30
    float streak_width = 1.5f;    ///< metres between nodes across them, 1e-4 to 1e9
    float streak_length = 40;     ///< metres between nodes along them, 1e-4 to 1e9
    float direction = 0;          ///< of the streaks, radians from +x
    float patches = 0;            ///< level of patches relative to the rest, -30 to 30
    float patch_size = 15;        ///< metres between nodes of their outline, 1e-4 to 1e9
    float patch_coverage = 0.3f;  ///< of the area, 0.01 to 0.99
    std::uint64_t seed = 1;

    INSONIFY_MEMBER bool is_none() const { return drift == 0 && streaks == 0 && patches == 0; }
};

namespace detail::inline INSONIFY_FLAGS {

inline void validate(const bottom_tone& t) {
    const auto level = [](const char* name, float v) { require_range(name, v, 0, 30, "0 to 30 dB"); };
    const auto length = [](const char* name, float v) { require_range(name, v, 1e-4f, 1e9f, "1e-4 to 1e9 metres"); };
    level("bottom_tone.drift", t.drift);
    level("bottom_tone.streaks", t.streaks);
    length("bottom_tone.drift_length", t.drift_length);
    length("bottom_tone.streak_width", t.streak_width);
    length("bottom_tone.streak_length", t.streak_length);
    length("bottom_tone.patch_size", t.patch_size);
    require_range("bottom_tone.octaves", t.octaves, 1, 8, "1 to 8");
    require_angle("bottom_tone.direction", t.direction);
    require_range("bottom_tone.patches", t.patches, -30, 30, "-30 to 30 dB");
    require_range("bottom_tone.patch_coverage", t.patch_coverage, 0.01f, 0.99f, "0.01 to 0.99");
}

/// Evaluates a tone.
class tone_sampler {
  public:
    /// @throws invalid_input for a parameter out of its range
    explicit tone_sampler(const bottom_tone& t)
        : t_((validate(t), t)), along_(numeric::sin_cos(static_cast<double>(t.direction))) {
        const auto key = [&](drift_stream stream) { return stream_key(t.seed, static_cast<std::uint32_t>(stream)); };
        drift_ = key(drift_stream::tone), streaks_ = key(drift_stream::streaks), patches_ = key(drift_stream::patches);
        double squares = 0, share = 1;
        for (int i = 0; i < t.octaves; ++i, share *= 0.5) squares += share * share;
        scale_ = static_cast<double>(t.drift) / numeric::square_root(squares);
        threshold_ = numeric::normal_quantile(1 - static_cast<double>(t.patch_coverage));
    }

    /// @returns decibels
    double operator()(const glm::dvec2& at) const {
        double level = 0;
        if (t_.drift > 0) {
            double per_metre = 1 / static_cast<double>(t_.drift_length), share = scale_;
            for (int i = 0; i < t_.octaves; ++i, per_metre *= 2, share *= 0.5)
                level +=
                    share * smooth_noise(at.x * per_metre, at.y * per_metre, static_cast<std::uint32_t>(i), drift_);
        }
        if (t_.streaks > 0) {
            const double along = at.x * along_.cosine + at.y * along_.sine,
                         across = at.y * along_.cosine - at.x * along_.sine;
            level += static_cast<double>(t_.streaks) * smooth_noise(along / static_cast<double>(t_.streak_length),
                                                                    across / static_cast<double>(t_.streak_width), 0,
                                                                    streaks_);
        }
        if (t_.patches != 0) {
            // Two octaves of noise, the second at four times the frequency, make ragged outlines with a soft border.
            const double size = static_cast<double>(t_.patch_size);
            const double field = 0.89442719 * smooth_noise(at.x / size, at.y / size, 0, patches_) +
                                 0.44721360 * smooth_noise(4 * at.x / size, 4 * at.y / size, 1, patches_);
            const double inside = 0.5 + 4 * (field - threshold_);
            level += static_cast<double>(t_.patches) * (inside > 0 ? (inside < 1 ? inside : 1.0) : 0.0);
        }
        return level;
    }

  private:
    bottom_tone t_;
    numeric::sine_cosine along_;
    philox_key drift_{}, streaks_{}, patches_{};
    double scale_ = 0, threshold_ = 0;
};

/// @throws invalid_input for a ping out of range, or beyond 10^12 metres
inline void require_within_reach(const ping& p, const std::string& name) {
    validate(p, name);
    require_range(name + ".position.x", p.position.x, -1e12, 1e12, "within 10^12 metres");
    require_range(name + ".position.y", p.position.y, -1e12, 1e12, "within 10^12 metres");
}

/// Multiplies a recording's echoes of the seabed by a tone.
/// @param ping_of_row  ping_of_row(y) is the ping of a row
template <across_track Axis, class PingOfRow>
void apply_tone(frame<labels>& r, const PingOfRow& ping_of_row, const side_scan_rig<Axis>& rig, const bottom_tone& tone,
                executor_ref ex) {
    require(r.rows.side == rig.side, "rows.side", static_cast<int>(r.rows.side),
            rig.side == side::port ? "0, the port side of the rig" : "1, the starboard side of the rig");
    require_equal("rig.bins", rig.bins, r.image.width(), "the recording's width");
    require_sizes(r.labels, r.image.width(), r.image.height(), "that of the image");
    const tone_sampler level(tone);
    if (tone.is_none()) return;
    const double first = static_cast<double>(rig.first_range), bin = rig.bin();
    bulk_ranges(ex, static_cast<std::size_t>(r.image.height()), 16, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) {
            const int y = static_cast<int>(i);
            const ping at = ping_of_row(y);
            const ping_frame frame(at, rig.side);
            const double altitude = at.position.z;
            const auto row = r.image.row(y);
            const auto types = r.labels.seabed.row(y);
            for (std::size_t x = 0; x < row.size(); ++x) {
                if (types[x] == labels::no_seabed) continue;
                const double range = first + (static_cast<double>(x) + 0.5) * bin;
                const double ground =
                    Axis == across_track::ground_range ? range : range_geometry::ground_range(range, altitude);
                row[x] *= static_cast<float>(from_decibels(level(frame.world(ground, 0))));
            }
        }
    });
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// The level that a tone adds at a position, decibels.
/// @param position  metres in the world
/// @throws invalid_input for a parameter out of its range, or a position that is not within 10^12 metres of the origin
inline double level_of(const bottom_tone& tone, const glm::dvec2& position) {
    detail::require_range("position.x", position.x, -1e12, 1e12, "within 10^12 metres");
    detail::require_range("position.y", position.y, -1e12, 1e12, "within 10^12 metres");
    return detail::tone_sampler(tone)(position);
}

/// Applies a tone to a recording: pixels with a seabed label change by the level at their position on the datum.
/// Targets and the water column are unchanged.
///
/// @param r  a result of `render` with this rig, before noise and speckle
/// @throws invalid_input for a rig or a parameter out of its range, a picture from above, or a recording of another
///         side or width, of both sides, without labels or with ping numbers beyond 2^31
template <across_track Axis, executor_argument E = serial_executor>
frame<labels> with_tone(frame<labels> r, const side_scan_rig<Axis>& rig, const bottom_tone& tone, E&& ex = {}) {
    validate(rig);
    detail::require_one_side(r.rows, "rows");
    const auto ping_of_row = [&](int y) {
        const std::int64_t number = r.rows.first + std::int64_t{r.rows.step} * y;
        detail::require_range("rows.first", number, -(std::int64_t{1} << 31), (std::int64_t{1} << 31) - 1,
                              "rows of pings within 2^31");
        return ping_of(rig, static_cast<int>(number));
    };
    for (int y = 0; y < r.image.height(); ++y) detail::require_within_reach(ping_of_row(y), "ping");
    detail::apply_tone(r, ping_of_row, rig, tone, executor_ref(ex));
    return r;
}

/// Applies a tone to a recording of a track: levels are those at the positions on the datum abreast of each ping.
///
/// @param r      a result of `record` with this track and rig, before noise and speckle
/// @param track  the pings of its rows, in the order in which they were recorded
/// @throws invalid_input for a rig, a ping or a parameter out of its range, a picture from above, or a recording of
///         another side, width or number of pings, of both sides, or without labels
template <across_track Axis, executor_argument E = serial_executor>
frame<labels> with_tone(frame<labels> r, std::span<const ping> track, const side_scan_rig<Axis>& rig,
                        const bottom_tone& tone, E&& ex = {}) {
    validate(rig);
    detail::require_one_side(r.rows, "rows");
    detail::require_equal("track.size()", track.size(), static_cast<std::size_t>(r.image.height()),
                          "the number of the recording's rows");
    for (std::size_t i = 0; i < track.size(); ++i)
        detail::require_within_reach(track[i], detail::element_name("track", i));
    const auto ping_of_row = [&](int y) {
        return track[static_cast<std::size_t>(r.rows.step > 0 ? y : r.image.height() - 1 - y)];
    };
    detail::apply_tone(r, ping_of_row, rig, tone, executor_ref(ex));
    return r;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
