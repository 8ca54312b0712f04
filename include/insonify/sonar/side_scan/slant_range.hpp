// Side-scan pictures, pings by ranges: water column, first return, layover and shadows, with labels for every bin. See
// ping_echo.hpp for the echo of one ping.
#pragma once

#include <insonify/core/detail/filled.hpp>
#include <insonify/sonar/backscatter.hpp>
#include <insonify/sonar/frame.hpp>
#include <insonify/sonar/side_scan/detail/ping_echo.hpp>
#include <insonify/sonar/side_scan/sonar_equation.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Options of recordings. What the types leave out is not compiled.
template <class Labels = labels, backscatter_law Law = lambert_backscatter, class Equation = sonar_equation<level_gain>>
struct record_options {
    Law law{};
    Equation equation{};
    /// Metres between the vertices at which the seabed is sampled; 0: see default_cell. Of 40 m in 2048 bins from 5 m
    /// up, against cells of 5 mm: cells of 2, 4 and 8 cm cost 2, 1 and 0.6 times the default's time; the shadow labels
    /// of 0.9, 1.5 and 3.4 % of the bins differ on ripples, of 3.6, 5.3 and 11 % on rock; and amplitudes by 7, 10 and
    /// 19 % (rms) on ripples.
    double cell = 0;

    /// The same options with another sonar equation, another law, or without labels:
    /// `record_options<>{}.with(sonar_equation{pulse{}, level_gain{}})`.
    template <class... Parts>
    INSONIFY_MEMBER record_options<Labels, Law, sonar_equation<Parts...>> with(
        const sonar_equation<Parts...>& other) const {
        return {law, other, cell};
    }
    template <backscatter_law Other>
    INSONIFY_MEMBER record_options<Labels, Other, Equation> with(const Other& other) const {
        return {other, equation, cell};
    }
    INSONIFY_MEMBER record_options<no_labels, Law, Equation> without_labels() const { return {law, equation, cell}; }
};

namespace detail::inline INSONIFY_FLAGS {

/// As fine as the picture: a bin or a ping's spacing, whichever is longer. Where pictures are coarse, a fiftieth of the
/// altitude, so that relief and targets aren't missed; but never finer than 1/2048 of the range.
template <across_track Axis>
double default_cell(const side_scan_rig<Axis>& rig) {
    const double picture = (std::max)(rig.bin(), static_cast<double>(rig.ping_spacing));
    return (std::max)(static_cast<double>(rig.range) / 2048,
                      (std::min)(picture, static_cast<double>(rig.altitude) / 50));
}

/// How many pings away the beam reaches at the largest range.
template <class Beam, across_track Axis>
int beam_reach(const Beam& beam, const side_scan_rig<Axis>& rig) {
    validate_if_possible(beam);
    const double range = static_cast<double>(rig.range), altitude = static_cast<double>(rig.altitude);
    const double slant =
        Axis == across_track::slant_range ? range : numeric::square_root(range * range + altitude * altitude);
    const double pings = beam.reach(slant) / static_cast<double>(rig.ping_spacing);
    require(pings < 4096, "pings in the horizontal beam", pings, "below 4096");
    return static_cast<int>(pings);
}

/// The recording of a track under construction.
template <class Rig, class Labels, class Law, class Equation>
class recorder {
  public:
    static constexpr bool labelled = std::is_same_v<Labels, labels>;
    using options_type = record_options<Labels, Law, Equation>;

    template <executor E>
    recorder(const scene& s, std::span<const ping> track, const Rig& rig, const options_type& options, E& ex)
        : scene_(s), track_(track), rig_(rig), options_(options) {
        validate(rig);
        validate(s);
        require(s.targets.size() < labels::by_seabed, "scene.targets.size()", s.targets.size(), "below 65535");
        require(options.cell >= 0 && numeric::is_finite(options.cell), "cell", options.cell, "metres, or 0");
        validate_if_possible(options.law);
        options.equation.for_each([](const auto& part) { validate_if_possible(part); });
        for (const ping& p : track) validate(p);
        out_.rows.side = rig.side;
        out_.stats.cell = bottom_tiles::even(options.cell > 0 ? options.cell : default_cell(rig));
        materials_ = resolved_bottom(s);
        targets_ = sliced_targets(s);
        const auto height = static_cast<int>(track.size());
        out_.image = filled(rig.bins, height, 0.0f, ex);
        if constexpr (labelled) {
            out_.labels = labels(rig.bins, height, ex);
            out_.labels.legend = s.seabed.legend();
        }
    }

    template <executor E>
    frame<Labels> record(E& ex) {
        hear(ex);
        if constexpr (Equation::has_beam)
            options_.equation.for_each([&](const auto& part) {
                if constexpr (footprint_part<decltype(part)>) blur_along_track(part, ex);
            });
        if constexpr (Equation::has_noise || Equation::has_gain) amplify(ex);
        return std::move(out_);
    }

  private:
    static constexpr std::size_t grain = 8;   // pings that share a fan
    static constexpr std::size_t leg = 4096;  // pings that share the sampled seabed

    double range_of(std::size_t bin) const {
        return static_cast<double>(rig_.first_range) + (static_cast<double>(bin) + 0.5) * rig_.bin();
    }
    /// Slant range, for a sonar so high.
    double slant_of(std::size_t bin, double altitude) const {
        const double r = range_of(bin);
        return Rig::axis == across_track::slant_range ? r : numeric::square_root(r * r + altitude * altitude);
    }

    template <executor E>
    void hear(E& ex) {
        using listener = ping_listener<Rig, Law, Equation, labelled>;
        bottom_tiles bottom(scene_.seabed, out_.stats.cell);
        const seabed::height_range relief = scene_.seabed.prepare().range();
        const double cell = out_.stats.cell;
        std::vector<float> over_range;
        if constexpr (Equation::has_ranges)
            for (std::size_t b = 0; b < static_cast<std::size_t>(rig_.bins); ++b)
                over_range.push_back(static_cast<float>(
                    options_.equation.over_range(slant_of(b, static_cast<double>(rig_.altitude)), spacing())));
        for (std::size_t start = 0; start < track_.size(); start += leg) {
            const std::size_t count = (std::min)(leg, track_.size() - start);
            std::vector<ping_frame> frames;
            frames.reserve(count);
            for (std::size_t i = 0; i < count; ++i) frames.emplace_back(track_[start + i], rig_.side);
            double begin = listener::reach(rig_, cell);
            for (const ping_frame& p : frames)
                begin = (std::min)(begin, listener::start(rig_, cell, relief, p, targets_));
            bottom.cover(frames, begin, listener::reach(rig_, cell), ex);
            bulk_ranges(ex, count, grain, [&](std::size_t from, std::size_t to) {
                listener ears(scene_, materials_, targets_, bottom, rig_, options_.law, options_.equation, cell, relief,
                              begin);
                for (std::size_t i = from; i < to; ++i) keep(start + i, ears.hear(frames[i]), over_range);
            });
        }
        out_.stats.seabed_samples = bottom.sampled();
    }

    /// Writes what one ping heard.
    void keep(std::size_t number, std::span<const echo_bin> bins, std::span<const float> over_range) {
        const int row = static_cast<int>(number);
        const auto power = out_.image.row(row);
        for (std::size_t b = 0; b < bins.size(); ++b) power[b] = bins[b].bottom + bins[b].target;
        if constexpr (Equation::has_ranges)
            for (std::size_t b = 0; b < bins.size(); ++b) power[b] *= over_range[b];
        if constexpr (Equation::has_pulse)
            options_.equation.for_each([&](const auto& part) {
                if constexpr (pulse_part<decltype(part)>) stretch(power, part.duration() / rig_.bin());
            });
        if constexpr (labelled) {
            const auto instance = out_.labels.instance.row(row), shadow = out_.labels.shadow.row(row);
            const auto seabed = out_.labels.seabed.row(row);
            for (std::size_t b = 0; b < bins.size(); ++b) {
                const echo_bin& bin = bins[b];
                const bool is_target = bin.target > bin.bottom;
                const bool is_dark = bin.dark_by_target + bin.dark_by_seabed > bin.lit;
                instance[b] = is_target ? bin.instance : labels::no_instance;
                shadow[b] = is_target || !is_dark                      ? labels::is_lit
                            : bin.dark_by_target >= bin.dark_by_seabed ? bin.caster
                                                                       : labels::by_seabed;
                seabed[b] = is_target ? labels::no_seabed : bin.seabed;
            }
        }
    }

    /// Lets every echo last for `length` bins.
    static void stretch(std::span<float> row, double length) {
        if (!(length > 1)) return;
        const std::vector<float> heard(row.begin(), row.end());
        const std::int64_t reach = -numeric::floor_to_int(-0.5 * (length - 1)),
                           bins = static_cast<std::int64_t>(row.size());
        std::fill(row.begin(), row.end(), 0.0f);
        for (std::int64_t j = -reach; j <= reach; ++j) {
            const double edge = j < 0 ? 0.5 - static_cast<double>(j) : 0.5 + static_cast<double>(j);
            const double inside = (std::min)(1.0, 0.5 * length - edge + 1) / length;
            const auto weight = static_cast<float>(inside);
            for (std::int64_t b = 0; b < bins; ++b) {  // the row's ends go on as they are
                const std::int64_t from = (std::min)((std::max)(b - j, std::int64_t{0}), bins - 1);
                row[static_cast<std::size_t>(b)] += weight * heard[static_cast<std::size_t>(from)];
            }
        }
    }

    /// Lets every ping hear its neighbours, as far as the beam reaches at each range.
    template <class Beam, executor E>
    void blur_along_track(const Beam& beam, E& ex) {
        const int bins = rig_.bins, rows = out_.image.height();
        const int reach = beam_reach(beam, rig_);
        if (reach == 0) return;
        // By distance in pings and by bin, so that rows are added up as wholes.
        image<float> weights(bins, reach + 1);
        for (int b = 0; b < bins; ++b) {
            const double slant = slant_of(static_cast<std::size_t>(b), static_cast<double>(rig_.altitude));
            double sum = 0;
            const auto weight = [&](int j) {
                return j * spacing() <= beam.reach(slant) ? beam.pattern(j * spacing(), slant) : 0.0;
            };
            for (int j = -reach; j <= reach; ++j) sum += weight(numeric::magnitude(j));
            for (int j = 0; j <= reach; ++j) weights(b, j) = static_cast<float>(weight(j) / sum);
        }
        image<float> blurred(bins, rows);
        ex.bulk(static_cast<std::size_t>(rows), [&](std::size_t row) {
            const int y = static_cast<int>(row);
            const auto to = blurred.row(y);
            for (int j = -reach; j <= reach; ++j) {
                const int other = (std::min)((std::max)(y + j, 0), rows - 1);  // the track's too
                const float* const weight = weights.row(numeric::magnitude(j)).data();
                const float* const from = out_.image.row(other).data();
                for (std::size_t b = 0; b < to.size(); ++b) to[b] += weight[b] * from[b];
            }
        });
        out_.image = std::move(blurred);
    }

    /// The receiver: its noise, then its gain.
    template <executor E>
    void amplify(E& ex) {
        const auto noise = static_cast<float>(options_.equation.noise());
        bulk_ranges(ex, track_.size(), 64, [&](std::size_t from, std::size_t to) {
            std::vector<float> gain;
            double altitude = 0;
            for (std::size_t i = from; i < to; ++i) {
                if (gain.empty() || track_[i].position.z != altitude) {
                    altitude = track_[i].position.z;
                    gain.clear();
                    for (std::size_t b = 0; b < static_cast<std::size_t>(rig_.bins); ++b)
                        gain.push_back(static_cast<float>(
                            options_.equation.gain(flat_echo{slant_of(b, altitude), altitude, rig_.bin(), spacing(),
                                                             Rig::axis == across_track::slant_range},
                                                   options_.law)));
                }
                const auto row = out_.image.row(static_cast<int>(i));
                for (std::size_t b = 0; b < row.size(); ++b) row[b] = (row[b] + noise) * gain[b];
            }
        });
    }

    double spacing() const { return static_cast<double>(rig_.ping_spacing); }

    const scene& scene_;
    std::span<const ping> track_;
    Rig rig_;
    options_type options_;
    bottom_materials materials_;
    std::vector<sliced_target> targets_;
    frame<Labels> out_;
};

/// Fills in labels::targets anew, for images that were put together from those of described labels.
inline void describe_again(labels& l) {
    std::vector<target> known;
    for (const target_label& t : l.targets) known.push_back({{}, t.placement, t.class_name});
    describe_targets(l, known);
}

/// The rows of an image from `first` on.
template <class T>
image<T> rows_of(const image<T>& source, int first, int count) {
    if (first == 0 && count == source.height()) return source;
    return image<T>(source.view().part(0, first, source.width(), count));
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Records a track of any shape: pings may turn, rise and sink.
///
/// @param s        the seabed and its targets
/// @param track    pings in order; row i of the recording is ping i
/// @param rig      ranges, side and ping spacing; its own track isn't used
/// @param options  types of labels, law and sonar equation, and how finely the seabed is sampled
/// @param ex       runs it; the result is the same bytes for any executor
/// @throws invalid_input for a rig, a ping, a seabed, a material, a pose or an option that can't be right
template <across_track Axis, class Labels = labels, backscatter_law Law = lambert_backscatter,
          class Equation = sonar_equation<level_gain>, executor_argument E = serial_executor>
frame<Labels> record(const scene& s, std::span<const ping> track, const side_scan_rig<Axis>& rig,
                     const record_options<Labels, Law, Equation>& options = {}, E&& ex = {}) {
    auto out = detail::recorder<side_scan_rig<Axis>, Labels, Law, Equation>(s, track, rig, options, ex).record(ex);
    if constexpr (std::is_same_v<Labels, labels>) describe_targets(out.labels, s.targets);
    return out;
}

/// Records a few pings into memory of the caller's: row i of `into` becomes ping i.
/// @param into     rig.bins columns, a row per ping; it may be a part of a larger image
/// The other parameters and errors are those of `record`; it also throws invalid_input for a view of another size,
/// which is then untouched.
template <across_track Axis, class Labels = labels, backscatter_law Law = lambert_backscatter,
          class Equation = sonar_equation<level_gain>, executor_argument E = serial_executor>
render_stats record_into(image_view<float> into, const scene& s, std::span<const ping> track,
                         const side_scan_rig<Axis>& rig, const record_options<Labels, Law, Equation>& options = {},
                         E&& ex = {}) {
    detail::require(into.width() == rig.bins, "into.width()", into.width(), "that of the rig's bins");
    detail::require(static_cast<std::size_t>(into.height()) == track.size(), "into.height()", into.height(),
                    "that of the pings");
    const auto heard = record(s, track, rig, options.without_labels(), ex);
    for (int y = 0; y < into.height(); ++y)
        std::copy(heard.image.row(y).begin(), heard.image.row(y).end(), into.row(y).begin());
    return heard.stats;
}

/// Draws a scene as a side-scan sonar on a straight track hears it, or as a map of what it hears: see side_scan_rig.
/// Row i is ping i. The other parameters are those of `record`.
template <across_track Axis, class Labels = labels, backscatter_law Law = lambert_backscatter,
          class Equation = sonar_equation<level_gain>, executor_argument E = serial_executor>
frame<Labels> render(const scene& s, const side_scan_rig<Axis>& rig,
                     const record_options<Labels, Law, Equation>& options = {}, E&& ex = {}) {
    validate(rig);
    // The beam hears beyond the ends of the track.
    int more = 0;
    if constexpr (Equation::has_beam)
        options.equation.for_each([&](const auto& part) {
            if constexpr (detail::footprint_part<decltype(part)>) more = detail::beam_reach(part, rig);
        });
    std::vector<ping> track;
    for (int i = -more; i < rig.pings + more; ++i) track.push_back(ping_of(rig, i));
    auto out = detail::recorder<side_scan_rig<Axis>, Labels, Law, Equation>(s, track, rig, options, ex).record(ex);
    if (more > 0) out.image = detail::rows_of(out.image, more, rig.pings);
    if constexpr (std::is_same_v<Labels, labels>) {
        if (more > 0) {
            out.labels.instance = detail::rows_of(out.labels.instance, more, rig.pings);
            out.labels.shadow = detail::rows_of(out.labels.shadow, more, rig.pings);
            out.labels.seabed = detail::rows_of(out.labels.seabed, more, rig.pings);
        }
        describe_targets(out.labels, s.targets);
    }
    return out;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
