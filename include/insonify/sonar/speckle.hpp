// Speckle by seabed label.
//
// The fluctuation of a bin is a function of (seed, side, ping number, bin) alone: recordings made in pieces fit
// together if `frame.rows.first` is each piece's first ping (`record` counts from 0), and the two sides are
// independent. The laws are those of the speckle filters (filter/echo_noise.hpp), for recordings without a largest
// value.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/sonar/side_scan/swath.hpp>
#if INSONIFY_BODIES
#include <insonify/sonar/detail/speckle_field.hpp>
#endif

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

inline namespace INSONIFY_FLAGS {

/// Laws by label.
using speckle_laws = std::array<speckle_law, seabed::label_count>;

/// `looks` of a label that takes the law that the seabed's model states.
inline constexpr int looks_by_seabed_model = -1;

/// The registry's laws; labels outside of the registry take those that the seabed's model states.
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
    float across_track = 1;    ///< the same across the track, in bins
    float texture_length = 3;  ///< pings and bins between nodes of the texture's lattice, 1 to 1024. Adjacent pixels
                               ///< correlate by at most 4/9; 1 / e at 0.4 of the length
    std::uint64_t seed = 1;
};

namespace detail::inline INSONIFY_ONCE {

INSONIFY_FUNCTION image<float> speckled(image_view<const float> mean, image_view<const std::uint8_t> types,
                                        const seabed_speckle& s, const ping_numbers& numbers, executor_ref ex);

}  // namespace detail::inline INSONIFY_ONCE

#if INSONIFY_BODIES
namespace detail::inline INSONIFY_FLAGS {

inline void validate(const speckle_law& law) {
    require_range("speckle_law.looks", law.looks, 1, 64, "1 to 64");
    require(law.texture == 0 || (law.texture >= 0.01f && numeric::is_finite(law.texture)), "speckle_law.texture",
            law.texture, "0, or at least 0.01");
    require_range("speckle_law.steady", law.steady, 0, 1e6, "0 to 1e6");
}

/// The law of each label.
/// @throws invalid_input for a parameter out of its range
inline speckle_laws resolved_laws(const seabed_speckle& s) {
    require_range("seabed_speckle.along_track", s.along_track, 0, 16, "0 to 16");
    require_range("seabed_speckle.across_track", s.across_track, 0, 16, "0 to 16");
    require_range("seabed_speckle.texture_length", s.texture_length, 1, 1024, "1 to 1024");
    speckle_laws laws = s.bottom;
    for (speckle_law& law : laws)
        if (law.looks == looks_by_seabed_model) law = s.elsewhere;
    laws[labels::no_seabed] = s.elsewhere;
    for (const speckle_law& law : laws) validate(law);
    return laws;
}

}  // namespace detail::inline INSONIFY_FLAGS

namespace detail::inline INSONIFY_ONCE {

INSONIFY_FUNCTION image<float> speckled(image_view<const float> mean, image_view<const std::uint8_t> types,
                                        const seabed_speckle& s, const ping_numbers& numbers, executor_ref ex) {
    require_equal("types.width()", types.width(), mean.width(), "that of the intensities");
    require_equal("types.height()", types.height(), mean.height(), "that of the intensities");
    require(numbers.step == 1 || numbers.step == -1, "ping_numbers.step", numbers.step, "1 or -1");
    constexpr std::int64_t farthest = std::int64_t{1} << 61;
    require_range("ping_numbers.first", numbers.first, -farthest, farthest, "within 2^61");
    const speckle_laws laws = resolved_laws(s);
    // All looks are computed for all bins; types use as many as they have.
    int looks = 1;
    for (const speckle_law& law : laws) looks = (std::max)(looks, law.looks);

    const speckle_field field(s.seed, numbers.side, s.along_track, s.across_track, mean.width());
    const speckle_texture texture(s.seed, numbers.side, s.texture_length);
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
                    row[x] += look_intensity(g[2 * x], g[2 * x + 1], law.steady, law.looks);
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

}  // namespace detail::inline INSONIFY_ONCE
#endif

inline namespace INSONIFY_FLAGS {

/// Applies speckle to an image of mean intensities.
///
/// @param mean     intensities; 0 stays 0
/// @param types    the label of each pixel, as in labels::seabed; those without a law take that of `elsewhere`
/// @param numbers  ping numbers of the rows
/// @throws invalid_input for images of different sizes or a parameter out of its range
template <executor_argument E = serial_executor>
image<float> with_speckle(image_view<const float> mean, image_view<const std::uint8_t> types, const seabed_speckle& s,
                          const ping_numbers& numbers, E&& ex = {}) {
    return detail::speckled(mean, types, s, numbers, executor_ref(ex));
}

/// Fills in the laws that the seabed's model states for labels that have none in `s`.
/// @param legend  as labels::legend
inline seabed_speckle with_legend(seabed_speckle s, std::span<const seabed::type_properties> legend) {
    for (const seabed::type_properties& t : legend) {
        speckle_law& law = s.bottom[seabed::index_of(t.label)];
        if (law.looks == looks_by_seabed_model) law = t.speckle;
    }
    return s;
}

/// The recording, of one side or both, with speckle by its own ping numbers and legend.
/// @throws invalid_input for labels of another size than the image, rows that are not pings, more columns to port than
///         there are, or a parameter out of its range
template <executor_argument E = serial_executor>
frame<labels> with_speckle(frame<labels> r, const seabed_speckle& s = {}, E&& ex = {}) {
    const int port = r.rows.port_columns;
    detail::require_range("rows.port_columns", port, 0, r.image.width(), "0 to the width of the recording");
    detail::require_sizes(r.labels, r.image.width(), r.image.height(), "that of the image");
    const seabed_speckle completed = with_legend(s, r.labels.legend);
    if (port == 0) {
        r.image = with_speckle(r.image.view(), r.labels.seabed.view(), completed, r.rows, ex);
        return r;
    }
    const auto channel = [&](side facing, int left, int width) {
        const bool is_port = facing == side::port;
        const auto part = [&](const auto& picture) {
            const std::remove_cvref_t<decltype(picture)> cut(picture.view().part(left, 0, width, picture.height()));
            return is_port ? mirrored(cut) : cut;
        };
        const auto mean = part(r.image);
        const auto types = part(r.labels.seabed);
        const auto noisy = with_speckle(mean.view(), types.view(), completed, {r.rows.first, r.rows.step, facing}, ex);
        return is_port ? mirrored(noisy) : noisy;
    };
    r.image = side_by_side(channel(side::port, 0, port), channel(side::starboard, port, r.image.width() - port));
    return r;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
