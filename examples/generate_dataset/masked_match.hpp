// Histogram matching that keeps shadows dark: shadow pixels are matched with the darkest part of the reference, the
// others with the rest.
//
// Matching all pixels as one depends on the area of the shadows: a picture with fewer shadows than the reference gets a
// dark bottom, one with more gets gray shadows with ripples inside.
#pragma once

#include <insonify/insonify.hpp>

namespace generator {

namespace in = insonify;

/// The darkest `count` pixels of a distribution, and the others.
struct split_distribution {
    in::distribution dark, bright;
};
inline split_distribution split_at(const in::distribution& whole, std::uint64_t count) {
    split_distribution parts;
    std::uint64_t before = 0;
    for (std::size_t i = 0; i < whole.values.size(); ++i) {
        const std::uint64_t upto = whole.cumulative[i];
        if (before < count) {
            parts.dark.values.push_back(whole.values[i]);
            parts.dark.cumulative.push_back(std::min(upto, count));
        }
        if (upto > count) {
            parts.bright.values.push_back(whole.values[i]);
            parts.bright.cumulative.push_back(upto - count);
        }
        before = upto;
    }
    return parts;
}

/// 255 where the bottom is in shadow.
inline in::image<std::uint8_t> shadows_of(const in::labels& l) {
    in::image<std::uint8_t> mask(l.shadow.width(), l.shadow.height());
    for (std::size_t i = 0; i < mask.size(); ++i)
        mask.pixels()[i] =
            l.shadow.pixels()[i] != in::labels::no_shadow && l.instance.pixels()[i] == in::labels::no_instance ? 255
                                                                                                               : 0;
    return mask;
}

/// Upper bound of the share of a reference that is taken as shadow.
inline constexpr double max_shadow_share = 0.05;

/// @param dark  255 where a pixel is in shadow
inline in::image<float> match_masked(in::image<float> picture, in::image<std::uint8_t> dark,
                                     const in::distribution& reference) {
    std::uint64_t shadows = 0;
    for (const std::uint8_t d : dark.pixels()) shadows += d != 0;
    const double share = std::min(
        max_shadow_share, static_cast<double>(shadows) / static_cast<double>(std::max<std::size_t>(dark.size(), 1)));
    const split_distribution parts =
        split_at(reference, static_cast<std::uint64_t>(share * static_cast<double>(reference.total())));
    // With few pixels a part may be empty: match all of them with the whole reference.
    if (parts.dark.total() == 0 || parts.bright.total() == 0)
        return std::move(picture) | in::match_histogram(reference);
    picture = std::move(picture) | in::where(dark.view(), in::match_histogram(parts.dark));
    for (std::uint8_t& d : dark.pixels()) d = static_cast<std::uint8_t>(255 - d);
    return std::move(picture) | in::where(dark.view(), in::match_histogram(parts.bright));
}

}  // namespace generator
