// Differences between an image or a mask and its ground truth.
//
// A mean hides one broken tile, so the largest difference is reported beside it. Intersection over union is unstable
// for tiny masks, so the displacement of their boundary is reported beside it.
#pragma once

#include <insonify/core/image_view.hpp>
#include <insonify/core/numeric.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace accuracy {

/// Counts of pixels; a pixel other than 0 belongs to the mask.
struct mask_difference {
    std::size_t true_positives = 0;   ///< in both masks
    std::size_t false_positives = 0;  ///< in the result, not in the truth: for shadows, acne
    std::size_t false_negatives = 0;  ///< in the truth, not in the result: for shadows, light leaks
    std::size_t boundary_pixels = 0;  ///< of the truth's mask that have a 4-neighbour outside it, in the image

    INSONIFY_MEMBER std::size_t wrong_pixels() const { return false_positives + false_negatives; }

    /// Adds the counts of another image.
    INSONIFY_MEMBER mask_difference& operator+=(const mask_difference& other) {
        true_positives += other.true_positives;
        false_positives += other.false_positives;
        false_negatives += other.false_negatives;
        boundary_pixels += other.boundary_pixels;
        return *this;
    }

    /// Intersection over union (Jaccard index), 1 when both masks are empty.
    INSONIFY_MEMBER double intersection_over_union() const {
        const std::size_t in_either = true_positives + wrong_pixels();
        return in_either == 0 ? 1.0 : static_cast<double>(true_positives) / static_cast<double>(in_either);
    }
    /// Mean displacement of the boundary along its length, pixels: wrong pixels over boundary pixels. Exact along rows
    /// and columns, up to sqrt(2) too large on diagonal boundaries. Infinite if there are wrong pixels but no boundary.
    /// A missing feature contributes its area over the length of its boundary, about half its width, however far it
    /// is from any other.
    INSONIFY_TAGGED double mean_boundary_displacement() const {
        if (wrong_pixels() == 0) return 0;
        if (boundary_pixels == 0) return std::numeric_limits<double>::infinity();
        return static_cast<double>(wrong_pixels()) / static_cast<double>(boundary_pixels);
    }
};

/// Differences of pixel values, in their unit. All but `pixels` are NaN if a pixel is NaN in either image.
struct pixel_difference {
    std::size_t pixels = 0;
    double mean_square = 0;
    double largest = 0;  ///< of the absolute differences

    /// Root of the mean square difference.
    INSONIFY_MEMBER double rmse() const { return numeric::square_root(mean_square); }

    /// Peak signal-to-noise ratio, 10 log10(peak^2 / mean square), in decibels; infinite without a difference.
    /// @param peak  the largest value a pixel can take, finite and positive: 1 for the library's floats, 255 for bytes
    /// @throws invalid_input for another peak
    INSONIFY_TAGGED double psnr(double peak) const {
        detail::require_positive("peak", peak);
        if (mean_square == 0) return std::numeric_limits<double>::infinity();
        constexpr double decibels = 20 / 2.302585092994045684;  // 20 / ln 10
        return decibels * (numeric::log(peak) - 0.5 * numeric::log(mean_square));
    }
};

}  // namespace accuracy

namespace detail::inline INSONIFY_FLAGS {

template <class T>
void require_same_size(image_view<const T> result, image_view<const T> truth) {
    require_equal("result.width()", result.width(), truth.width(), "the width of the truth");
    require_equal("result.height()", result.height(), truth.height(), "the height of the truth");
}

template <class T>
accuracy::pixel_difference compare_pixels(image_view<const T> result, image_view<const T> truth) {
    require_same_size(result, truth);
    accuracy::pixel_difference out{.pixels = truth.size()};
    double sum = 0;
    for (int y = 0; y < truth.height(); ++y) {
        // Row by row, so that small differences are not rounded away in large images.
        double row_sum = 0;
        const auto a = result.row(y), b = truth.row(y);
        for (std::size_t x = 0; x < b.size(); ++x) {
            if (a[x] == b[x]) continue;  // equal infinities too
            const double difference = numeric::abs(static_cast<double>(a[x]) - static_cast<double>(b[x]));
            row_sum += difference * difference;
            if (!(difference <= out.largest) && out.largest == out.largest) out.largest = difference;  // keeps a NaN
        }
        sum += row_sum;
    }
    if (out.pixels > 0) out.mean_square = sum / static_cast<double>(out.pixels);
    return out;
}

}  // namespace detail::inline INSONIFY_FLAGS

namespace accuracy {

inline namespace INSONIFY_FLAGS {

/// Compares a mask with the true one, pixel by pixel.
/// @throws invalid_input if the sizes differ
inline mask_difference compare_masks(image_view<const std::uint8_t> result, image_view<const std::uint8_t> truth) {
    detail::require_same_size(result, truth);
    mask_difference out;
    const int width = truth.width(), height = truth.height();
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const bool found = result(x, y) != 0;
            if (truth(x, y) == 0) {
                out.false_positives += found ? 1 : 0;
                continue;
            }
            (found ? out.true_positives : out.false_negatives) += 1;
            const bool boundary = (x > 0 && truth(x - 1, y) == 0) || (x + 1 < width && truth(x + 1, y) == 0) ||
                                  (y > 0 && truth(x, y - 1) == 0) || (y + 1 < height && truth(x, y + 1) == 0);
            out.boundary_pixels += boundary ? 1 : 0;
        }
    }
    return out;
}

/// Compares an image with the true one, pixel by pixel. Differences are in the unit of the pixels.
/// @throws invalid_input if the sizes differ
inline pixel_difference compare_images(image_view<const float> result, image_view<const float> truth) {
    return detail::compare_pixels(result, truth);
}
/// The same for codes of 8 bits.
inline pixel_difference compare_images(image_view<const std::uint8_t> result, image_view<const std::uint8_t> truth) {
    return detail::compare_pixels(result, truth);
}

}  // namespace INSONIFY_FLAGS

}  // namespace accuracy
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
