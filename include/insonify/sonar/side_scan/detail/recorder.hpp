// Records pings one by one: their echoes, the sonar equation's parts over range and along the track, and labels.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/detail/filled.hpp>
#include <insonify/sonar/detail/checked_materials.hpp>
#include <insonify/sonar/side_scan/detail/ping_echo.hpp>
#include <insonify/sonar/side_scan/detail/range_bins.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// The default cell: the longer of a bin and the ping spacing; at most a fiftieth of the altitude, if that is above 0,
/// so that coarse pictures do not miss relief and targets; at least 1/2048 of the range.
inline double default_cell(const range_bins& window) {
    double cell = (std::max)(window.bin, static_cast<double>(window.ping_spacing));
    if (window.altitude > 0) cell = (std::min)(cell, static_cast<double>(window.altitude) / 50);
    return (std::max)(static_cast<double>(window.range) / 2048, cell);
}

/// One factor for each bin, computed anew where a ping's altitude differs from that of the last.
class bin_factors {
  public:
    /// @param name    of the function of the sonar equation
    /// @param factor  factor(bin): at this altitude
    /// @throws invalid_input for a factor that is negative or NaN
    template <class Factor>
    std::span<const float> at(double altitude, int bins, std::string_view name, const Factor& factor) {
        if (values_.empty() || altitude != altitude_) {
            altitude_ = altitude;
            values_.clear();
            for (std::size_t b = 0; b < static_cast<std::size_t>(bins); ++b) {
                const double value = factor(b);
                require(value >= 0, name, value, "0 or more");
                values_.push_back(static_cast<float>((std::min)(value, static_cast<double>(largest))));
            }
        }
        return values_;
    }

    /// Upper bound of factors and intensities: infinity times 0 would be NaN.
    static constexpr float largest = (std::numeric_limits<float>::max)();

  private:
    dynamic_array<float> values_;
    double altitude_ = 0;
};

/// Records all pings of a track into a frame.
template <class Labels, class Law>
class recorder {
  public:
    static constexpr bool labelled = std::is_same_v<Labels, labels>;

    recorder(const scene& s, std::span<const ping> track, const range_bins& window,
             const erased_options<Labels, Law>& options, executor_ref ex)
        : scene_(s), track_(track), window_(window), options_(options), equation_(options.equation) {
        materials_ = checked_materials(s, options);
        for (std::size_t i = 0; i < track.size(); ++i) validate(track[i], element_name("track", i));
        // Both ends are rounded floats, so their difference may fall short of the intended length.
        const double recorded = static_cast<double>(window.range) - static_cast<double>(window.first_range);
        require_not_negative("range_length() of the sonar equation", equation_.pulse_length());
        require_range("noise() of the sonar equation", equation_.noise(), 0, 1e20, "0 to 10^20");
        require(equation_.pulse_length() <= recorded + 0x1p-23 * static_cast<double>(window.range), "pulse.length",
                equation_.pulse_length(), "at most range - first_range, in metres");
        out_.rows.side = window.facing;
        require(options.cell == 0 || options.cell >= 0x1p-20 * static_cast<double>(window.range), "cell", options.cell,
                "0, or at least 2^-20 of the range");
        out_.stats.cell = bottom_tiles::rounded_cell(options.cell > 0 ? options.cell : default_cell(window));
        targets_ = sliced_targets(s);
        const auto height = static_cast<int>(track.size());
        out_.image = filled(window.bins, height, 0.0f, ex);
        if constexpr (labelled) out_.labels = labels(s, window.bins, height, ex);
    }

    frame<Labels> record(executor_ref ex) {
        trace(ex);
        if (const int reach = beam_reach(equation_, window_); reach > 0) blur_along_track(reach, ex);
        if (equation_.has_gain()) amplify(ex);
        const int margin = options_.margin;
        const auto crop = [&](auto& picture) {
            picture = std::remove_reference_t<decltype(picture)>(
                picture.view().part(0, margin, picture.width(), picture.height() - 2 * margin));
        };
        if (margin > 0) for_each_image(crop, out_);
        if constexpr (labelled) measure_targets(out_.labels);
        return std::move(out_);
    }

  private:
    static constexpr std::size_t grain = 8;   ///< pings that share a tracer and its fan
    static constexpr std::size_t leg = 4096;  ///< pings that share the sampled seabed

    /// Single pings may be below the seabed: they receive nothing.
    void require_above(const seabed::height_range& relief) const {
        if (track_.empty()) return;
        double highest = track_.front().position.z;
        for (const ping& p : track_) highest = (std::max)(highest, p.position.z);
        seabed::detail::require_above(relief, "altitude of the highest ping", highest);
    }

    /// Slant range of a bin from an altitude.
    double slant_of(std::size_t bin, double altitude) const {
        const double centre = static_cast<double>(window_.first_range) + (static_cast<double>(bin) + 0.5) * window_.bin;
        return window_.slant_range(centre, altitude);
    }

    void trace(executor_ref ex) {
        using tracer = ping_tracer<Law, labelled>;
        bottom_tiles bottom(scene_.seabed, out_.stats.cell);
        const seabed::height_range relief = scene_.seabed.prepare().range();
        require_above(relief);
        const double cell = out_.stats.cell;
        bin_factors first_losses;  // for all pings if the track is level
        if (!track_.empty()) losses_at(track_.front(), first_losses);
        for (std::size_t start = 0; start < track_.size(); start += leg) {
            const std::size_t count = (std::min)(leg, track_.size() - start);
            dynamic_array<ping_frame> frames;
            frames.reserve(count);
            for (std::size_t i = 0; i < count; ++i) frames.push_back({track_[start + i], window_.facing});
            double begin = tracer::reach(window_, cell);
            for (const ping_frame& p : frames)
                begin = (std::min)(begin, tracer::start(window_, cell, relief, p, targets_));
            bottom.cover(frames, begin, tracer::reach(window_, cell), ex);
            bulk_ranges(ex, count, grain, [&](std::size_t from, std::size_t to) {
                tracer pings(scene_, materials_, targets_, bottom, window_, options_.law, equation_, cell, relief);
                bin_factors losses = first_losses;
                for (std::size_t i = from; i < to; ++i)
                    write(start + i, pings.trace(frames[i]), losses_at(track_[start + i], losses));
            });
        }
        out_.stats.seabed_samples = bottom.sampled();
    }

    /// Range factors of the equation for a ping's bins; empty if no part depends on range. In slant range they are the
    /// same at any altitude.
    std::span<const float> losses_at(const ping& p, bin_factors& losses) const {
        if (!equation_.has_ranges()) return {};
        const double altitude = window_.is_slant_range ? 0 : p.position.z;
        return losses.at(altitude, window_.bins, "over_range() and footprint() of the sonar equation",
                         [&](std::size_t b) { return equation_.over_range(slant_of(b, altitude), spacing()); });
    }

    /// Writes the row of one ping.
    void write(std::size_t number, std::span<const echo_bin> bins, std::span<const float> losses) {
        const int row = static_cast<int>(number);
        const auto power = out_.image.row(row);
        for (std::size_t b = 0; b < bins.size(); ++b)
            power[b] = (std::min)(bins[b].bottom + bins[b].target, bin_factors::largest);
        for (std::size_t b = 0; b < losses.size(); ++b)
            power[b] = (std::min)(power[b] * losses[b], bin_factors::largest);
        convolve_pulse(power, equation_.pulse_length() / window_.bin);
        if constexpr (labelled) {
            const auto instance = out_.labels.instance.row(row), shadow = out_.labels.shadow.row(row);
            const auto seabed = out_.labels.seabed.row(row);
            for (std::size_t b = 0; b < bins.size(); ++b) {
                const echo_bin& bin = bins[b];
                const bool is_target = bin.target > bin.bottom;
                const bool is_dark = bin.dark_by_target + bin.dark_by_seabed > bin.lit;
                instance[b] = is_target ? bin.instance : labels::no_instance;
                shadow[b] = is_target || !is_dark ? labels::no_shadow : bin.caster;
                seabed[b] = is_target ? labels::no_seabed : bin.seabed;
            }
        }
    }

    /// Convolves a row with a pulse of `length` bins. Values beyond its ends are those at the ends.
    static void convolve_pulse(std::span<float> row, double length) {
        if (!(length > 1)) return;
        const dynamic_array<float> source(row);
        const std::int64_t reach = -numeric::floor_to_int(-0.5 * (length - 1)),
                           bins = static_cast<std::int64_t>(row.size());
        std::fill(row.begin(), row.end(), 0.0f);
        for (std::int64_t j = -reach; j <= reach; ++j) {
            const double edge = j < 0 ? 0.5 - static_cast<double>(j) : 0.5 + static_cast<double>(j);
            const double inside = (std::min)(1.0, 0.5 * length - edge + 1) / length;
            const auto weight = static_cast<float>(inside);
            for (std::int64_t b = 0; b < bins; ++b) {
                const std::int64_t from = (std::min)((std::max)(b - j, std::int64_t{0}), bins - 1);
                row[static_cast<std::size_t>(b)] += weight * source[static_cast<std::size_t>(from)];
            }
        }
    }

    /// Convolves columns with the horizontal beam, whose width grows with range.
    void blur_along_track(int reach, executor_ref ex) {
        const int bins = window_.bins, rows = out_.image.height();
        // By distance in pings and by bin, so that whole rows are added.
        image<float> weights(bins, reach + 1);
        for (int b = 0; b < bins; ++b) {
            const double slant = slant_of(static_cast<std::size_t>(b), static_cast<double>(window_.altitude));
            double sum = 0;
            const auto weight = [&](int j) {
                if (j * spacing() > equation_.beam_reach(slant)) return 0.0;
                const double factor = equation_.beam_pattern(j * spacing(), slant);
                require_not_negative("pattern() of the sonar equation", factor);
                return factor;
            };
            for (int j = -reach; j <= reach; ++j) sum += weight(numeric::abs(j));
            require(sum > 0 && numeric::is_finite(sum), "sum of pattern() of the sonar equation within reach()", sum,
                    "above 0 and finite");
            for (int j = 0; j <= reach; ++j) weights(b, j) = static_cast<float>(weight(j) / sum);
        }
        image<float> blurred(bins, rows);
        ex.bulk(static_cast<std::size_t>(rows), [&](std::size_t row) {
            const int y = static_cast<int>(row);
            const auto to = blurred.row(y);
            for (int j = -reach; j <= reach; ++j) {
                const int other = (std::min)((std::max)(y + j, 0), rows - 1);
                const float* const weight = weights.row(numeric::abs(j)).data();
                const float* const from = out_.image.row(other).data();
                for (std::size_t b = 0; b < to.size(); ++b) to[b] += weight[b] * from[b];
            }
        });
        out_.image = std::move(blurred);
    }

    /// Adds the receiver's noise and applies its gain.
    void amplify(executor_ref ex) {
        const auto noise = static_cast<float>(equation_.noise());
        bulk_ranges(ex, track_.size(), 64, [&](std::size_t from, std::size_t to) {
            bin_factors gains;
            for (std::size_t i = from; i < to; ++i) {
                const double altitude = track_[i].position.z;
                const auto gain = gains.at(altitude, window_.bins, "gain() of the sonar equation", [&](std::size_t b) {
                    return equation_.gain(
                        {slant_of(b, altitude), altitude, window_.bin, spacing(), window_.is_slant_range});
                });
                const auto row = out_.image.row(static_cast<int>(i));
                for (std::size_t b = 0; b < row.size(); ++b)
                    row[b] = (std::min)((row[b] + noise) * gain[b], bin_factors::largest);
            }
        });
    }

    double spacing() const { return static_cast<double>(window_.ping_spacing); }

    const scene& scene_;
    std::span<const ping> track_;
    range_bins window_;
    const erased_options<Labels, Law>& options_;
    const equation_interface& equation_;
    bottom_materials materials_;
    dynamic_array<sliced_target> targets_;
    frame<Labels> out_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
