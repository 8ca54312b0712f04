// Speckle by seabed label.
//
// The fluctuation of a bin is a function of (seed, side, ping number, bin) alone: recordings made in pieces fit
// together, and the two sides are independent.
//
// Based on: E. Jakeman, P. N. Pusey. A Model for Non-Rayleigh Sea Echo. IEEE Transactions on Antennas and Propagation
// 24, 1976 (the K-distribution). George Marsaglia, Wai Wan Tsang. A Simple Method for Generating Gamma Variables. ACM
// Transactions on Mathematical Software 26, 2000.
#pragma once

#include <insonify/core/detail/correlation.hpp>
#include <insonify/core/detail/gamma.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/sonar/side_scan/detail/speckle_draws.hpp>
#include <insonify/sonar/side_scan/swath.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

inline namespace INSONIFY_FLAGS {

/// Laws by label.
using speckle_laws = std::array<speckle_law, seabed::label_count>;

/// Marks labels that take the law of the seabed's model.
inline constexpr int looks_by_seabed_model = -1;

/// The registry's laws; labels outside of the registry take those of the seabed's model.
constexpr speckle_laws default_speckle() {
    speckle_laws laws{};
    laws.fill({looks_by_seabed_model});
    for (const seabed::type_properties& t : seabed::built_in_types) laws[seabed::index_of(t.label)] = t.speckle;
    return laws;
}

}  // namespace INSONIFY_FLAGS

/// Speckle by type of seabed. The defaults are illustrative: sampled relief makes fluctuations of its own, so ripples
/// have plain Rayleigh speckle; a texture models structure finer than the sampling.
struct seabed_speckle {
    /// By label, seabed::index_of(type). Labels of your own have the law that your seabed states, unless it is set
    /// here.
    speckle_laws bottom = default_speckle();
    speckle_law elsewhere{};  ///< of pixels without a seabed label: targets, and noise in the water column
    /// Correlation length (1 / e) in pings of intensities without steady echo or texture, 0 to 16. All labels share one
    /// field: beside a steady echo it is up to 1.4 times as long; a texture has its own length.
    float along_track = 1;
    float across_track = 1;    ///< the same in bins
    float texture_length = 3;  ///< correlation length of textures in pings and bins, 1 to 1024
    std::uint64_t seed = 1;
};

namespace detail::inline INSONIFY_FLAGS {

/// Random streams; changing one changes the noise of every seed.
enum class speckle_stream : std::uint32_t { field = 0x73706B00, texture = 0x73706B02, choice = 0x73706B04 };

/// Random numbers keyed by ping and bin.
class ping_noise {
  public:
    ping_noise(std::uint64_t seed, side s, speckle_stream stream)
        : key_(stream_key(seed, static_cast<std::uint32_t>(stream) + static_cast<std::uint32_t>(s))) {}

    philox_counter operator()(std::int64_t ping, std::uint32_t bin, std::uint32_t draw) const {
        return philox4x32(counter(ping, bin, draw), key_);
    }

    static philox_counter counter(std::int64_t ping, std::uint32_t bin, std::uint32_t draw) {
        const auto number = static_cast<std::uint64_t>(ping);
        return {bin, static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), draw};
    }
    const philox_key& key() const { return key_; }

  private:
    philox_key key_;
};

/// A correlated complex Gaussian field of unit power, by rows, with real and imaginary parts interleaved.
class speckle_field {
  public:
    speckle_field(const ping_noise& noise, const seabed_speckle& s, int bins)
        : noise_(noise),
          bins_(static_cast<std::size_t>(bins)),
          across_(intensity_taps(static_cast<double>(s.across_track))),
          along_(intensity_taps(static_cast<double>(s.along_track))) {}

    /// The field of one look for consecutive pings, from number `first` on.
    image<float> pings(std::int64_t first, int count, std::uint32_t look) const {
        const int reach = static_cast<int>(along_.size()) - 1;
        image<float> blurred(static_cast<int>(2 * bins_), count + 2 * reach);
        for (int i = 0; i < blurred.height(); ++i) row(first - reach + i, look, blurred.row(i));
        if (reach == 0) return blurred;
        image<float> field(static_cast<int>(2 * bins_), count);
        for (int i = 0; i < count; ++i) {
            const auto to = field.row(i);
            for (int j = -reach; j <= reach; ++j) {
                const float tap = along_[static_cast<std::size_t>(numeric::abs(j))];
                const float* const from = blurred.row(i + reach + j).data();
                for (std::size_t x = 0; x < to.size(); ++x) to[x] += tap * from[x];
            }
        }
        return field;
    }

  private:
    /// One ping, correlated across the track.
    void row(std::int64_t ping, std::uint32_t look, std::span<float> out) const {
        const std::size_t reach = across_.size() - 1, margin = reach + (reach & 1);
        const std::size_t blocks = (bins_ + 2 * margin + 1) / 2;
        std::vector<float> white(4 * (blocks + speckle_draw_kernel::most_lanes));
        const std::uint32_t first = 0u - static_cast<std::uint32_t>(margin);
        dispatch(speckle_draw_kernel{noise_.key(), ping_noise::counter(ping, first, look), white.data(), blocks},
                 best_isa());
        for (std::size_t x = 0; x < out.size(); ++x) {
            const float* const at = &white[x + 2 * margin];
            float sum = across_[0] * *at;
            for (std::size_t j = 1; j <= reach; ++j) sum += across_[j] * (*(at - 2 * j) + at[2 * j]);
            out[x] = sum;
        }
    }

    ping_noise noise_;
    std::size_t bins_;
    std::vector<float> across_, along_;
};

/// The texture of the K-distribution: gamma-distributed at the nodes of a lattice. A bin takes the value of one of the
/// four nodes around it, chosen at random with bilinear weights, so that textures are correlated and keep their
/// distribution.
class speckle_texture {
  public:
    speckle_texture(const seabed_speckle& s, side looks)
        : nodes_(s.seed, looks, speckle_stream::texture),
          lots_(s.seed, looks, speckle_stream::choice),
          frequency_(1 / static_cast<double>(s.texture_length)) {}

    float operator()(std::int64_t ping, std::uint32_t bin, float shape) const {
        const philox_counter lot = lots_(ping, bin, 0);
        // Rounding a coordinate plus a uniform number chooses either neighbour with its linear weight.
        const std::int64_t row = numeric::floor_to_int(static_cast<double>(ping) * frequency_ + uniform_open(lot[0]));
        const auto column = static_cast<std::uint32_t>(numeric::floor_to_int(bin * frequency_ + uniform_open(lot[1])));
        return static_cast<float>(gamma_of_mean_one(static_cast<double>(shape),
                                                    [&](std::uint32_t trial) { return nodes_(row, column, trial); }));
    }

  private:
    ping_noise nodes_, lots_;
    double frequency_;
};

inline void validate(const speckle_law& law) {
    require(law.looks >= 1 && law.looks <= 64, "speckle_law.looks", law.looks, "1 to 64");
    require(law.texture == 0 || (law.texture >= 0.01f && numeric::is_finite(law.texture)), "speckle_law.texture",
            law.texture, "0, or at least 0.01");
    require(law.steady >= 0 && numeric::is_finite(law.steady), "speckle_law.steady", law.steady, "0 or more");
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Applies speckle to an image of mean intensities.
///
/// @param mean     intensities; 0 stays 0
/// @param types    a seabed::type for each pixel, as in labels::seabed; others are `elsewhere`
/// @param numbers  ping numbers of the rows
/// @throws invalid_input for images of different sizes or a parameter out of its range
template <executor_argument E = serial_executor>
image<float> with_speckle(image_view<const float> mean, image_view<const std::uint8_t> types, const seabed_speckle& s,
                          const ping_numbers& numbers, E&& ex = {}) {
    using detail::require;
    require(types.width() == mean.width(), "types.width()", types.width(), "that of the intensities");
    require(types.height() == mean.height(), "types.height()", types.height(), "that of the intensities");
    require(s.along_track >= 0 && s.along_track <= 16, "seabed_speckle.along_track", s.along_track, "0 to 16");
    require(s.across_track >= 0 && s.across_track <= 16, "seabed_speckle.across_track", s.across_track, "0 to 16");
    require(s.texture_length >= 1 && s.texture_length <= 1024, "seabed_speckle.texture_length", s.texture_length,
            "1 to 1024");
    require(numbers.step == 1 || numbers.step == -1, "ping_numbers.step", numbers.step, "1 or -1");
    detail::validate(s.elsewhere);
    std::vector<speckle_law> laws(s.bottom.begin(), s.bottom.end());
    for (speckle_law& law : laws)
        if (law.looks == looks_by_seabed_model) law = s.elsewhere;
    laws[labels::no_seabed] = s.elsewhere;
    for (const speckle_law& law : laws) detail::validate(law);

    // All looks are computed for all bins; types use as many as they have.
    int looks = 1;
    for (const speckle_law& law : laws) looks = (std::max)(looks, law.looks);

    const detail::speckle_field field({s.seed, numbers.side, detail::speckle_stream::field}, s, mean.width());
    const detail::speckle_texture texture(s, numbers.side);
    image<float> out(mean.width(), mean.height());
    constexpr std::size_t grain = 32;
    bulk_ranges(ex, static_cast<std::size_t>(mean.height()), grain, [&](std::size_t from, std::size_t to) {
        const int first = static_cast<int>(from), count = static_cast<int>(to - from);
        const std::int64_t a = numbers.first + numbers.step * static_cast<std::int64_t>(from);
        const std::int64_t lowest = numbers.step > 0 ? a : a - (count - 1);
        for (int look = 0; look < looks; ++look) {
            const image<float> gauss = field.pings(lowest, count, static_cast<std::uint32_t>(look));
            for (int i = 0; i < count; ++i) {
                const auto row = out.row(first + i);
                const float* const g = gauss.row(numbers.step > 0 ? i : count - 1 - i).data();
                for (std::size_t x = 0; x < row.size(); ++x) {
                    const speckle_law& law = laws[types.row(first + i)[x]];
                    if (look >= law.looks) continue;
                    const float steady = numeric::square_root(law.steady);
                    const float re = g[2 * x] + steady, im = g[2 * x + 1];
                    row[x] += (re * re + im * im) / ((1 + law.steady) * static_cast<float>(law.looks));
                }
            }
        }
        for (int i = 0; i < count; ++i) {
            const auto row = out.row(first + i);
            for (std::size_t x = 0; x < row.size(); ++x) {
                const float shape = laws[types.row(first + i)[x]].texture;
                row[x] *= mean(static_cast<int>(x), first + i);
                if (shape > 0) row[x] *= texture(a + numbers.step * i, static_cast<std::uint32_t>(x), shape);
            }
        }
    });
    return out;
}

/// Speckle with the laws of the seabed's model for labels that have none.
/// @param legend  as labels::legend
inline seabed_speckle with_legend(seabed_speckle s, std::span<const seabed::type_properties> legend) {
    for (const seabed::type_properties& t : legend) {
        speckle_law& law = s.bottom[seabed::index_of(t.label)];
        if (law.looks == looks_by_seabed_model) law = t.speckle;
    }
    return s;
}

/// The recording with speckle, by its own ping numbers and legend.
template <executor_argument E = serial_executor>
frame<labels> with_speckle(frame<labels> r, const seabed_speckle& s = {}, E&& ex = {}) {
    const seabed_speckle laws = with_legend(s, r.labels.legend);
    const int port = r.rows.port_columns;
    if (port == 0) {
        r.image = with_speckle(r.image.view(), r.labels.seabed.view(), laws, r.rows, ex);
        return r;
    }
    const auto channel = [&](side looks, int left, int width) {
        const bool is_port = looks == side::port;
        const auto part = [&](const auto& picture) {
            const std::remove_cvref_t<decltype(picture)> cut(picture.view().part(left, 0, width, picture.height()));
            return is_port ? mirrored(cut) : cut;
        };
        const auto mean = part(r.image);
        const auto types = part(r.labels.seabed);
        const auto noisy = with_speckle(mean.view(), types.view(), laws, {r.rows.first, r.rows.step, looks}, ex);
        return is_port ? mirrored(noisy) : noisy;
    };
    r.image = beside(channel(side::port, 0, port), channel(side::starboard, port, r.image.width() - port));
    return r;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
