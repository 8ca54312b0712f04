// Compares two pictures in a unit test, and says where they differ and by how much.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/io/netpbm.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// How far a picture may differ from the expected one; by default, not at all.
struct picture_tolerance {
    double value = 0;  ///< largest difference of a pixel in any channel, in the unit of the pixels
    double share = 0;  ///< fraction of the pixels that may differ by more, 0 to 1
};

/// The result of a comparison. Converts to true if the pictures agree.
struct picture_comparison {
    std::size_t pixels = 0;  ///< number of pixels compared
    std::size_t wrong = 0;   ///< number of pixels that differ by more than the tolerance
    int x = 0, y = 0;        ///< the pixel that differs most
    double largest = 0;      ///< its difference
    std::string message{};   ///< empty if the pictures agree

    explicit operator bool() const { return message.empty(); }
};

namespace detail::inline INSONIFY_FLAGS {

/// Channels of a pixel as doubles, and as the shortest text that reads back as the same sample.
template <class Pixel>
struct channels_of {
    static constexpr int count = 1;
    static double at(const Pixel& p, int) { return static_cast<double>(p); }
    static std::string text(const Pixel& p) { return to_text(p); }
};
template <class Sample>
struct channels_of<rgb<Sample>> {
    static constexpr int count = 3;
    static double at(const rgb<Sample>& p, int channel) {
        return static_cast<double>(channel == 0 ? p.r : channel == 1 ? p.g : p.b);
    }
    static std::string text(const rgb<Sample>& p) {
        return "(" + to_text(p.r) + " " + to_text(p.g) + " " + to_text(p.b) + ")";
    }
};

/// The largest absolute difference over the channels. NaN equals NaN, and is infinitely far from anything else.
template <class Pixel>
double pixel_distance(const Pixel& a, const Pixel& b) {
    double largest = 0;
    for (int c = 0; c < channels_of<Pixel>::count; ++c) {
        const double p = channels_of<Pixel>::at(a, c), q = channels_of<Pixel>::at(b, c);
        if (p == q || (p != p && q != q)) continue;
        const double difference = p < q ? q - p : p - q;
        largest = difference == difference ? (std::max)(largest, difference) : std::numeric_limits<double>::infinity();
    }
    return largest;
}

/// A difference in the digits of a float, like the samples; that of two floats may exceed the largest float.
inline std::string distance_text(double distance) {
    const bool is_float = distance <= static_cast<double>((std::numeric_limits<float>::max)());
    return is_float ? to_text(static_cast<float>(distance)) : to_text(distance);
}

inline std::string size_text(int width, int height) {
    return to_text(width) + " x " + to_text(height) + " pixels";
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Compares a picture with the expected one, pixel by pixel.
/// @throws invalid_input for a tolerance below 0 or NaN, or a share above 1
template <storable_pixel Pixel>
picture_comparison compare_pictures(const image<Pixel>& found, const image<Pixel>& expected,
                                    const picture_tolerance& tolerance = {}) {
    detail::require(tolerance.value >= 0, "tolerance.value", tolerance.value, "at least 0");
    detail::require_fraction("tolerance.share", tolerance.share);
    picture_comparison result;
    if (found.width() != expected.width() || found.height() != expected.height()) {
        result.message = "the picture has " + detail::size_text(found.width(), found.height()) + ", expected " +
                         detail::size_text(expected.width(), expected.height());
        return result;
    }
    result.pixels = found.size();
    for (int y = 0; y < found.height(); ++y)
        for (int x = 0; x < found.width(); ++x) {
            const double difference = detail::pixel_distance(found(x, y), expected(x, y));
            if (difference > tolerance.value) ++result.wrong;
            if (difference > result.largest) {
                result.largest = difference;
                result.x = x;
                result.y = y;
            }
        }
    // A share that counts divide to, such as 29 of 100, is allowed: its product with the pixels may round down.
    if (result.wrong == 0 || static_cast<double>(result.wrong) / static_cast<double>(result.pixels) <= tolerance.share)
        return result;
    using detail::to_text;
    result.message = to_text(result.wrong) + " of " + to_text(result.pixels) + " pixels differ by more than " +
                     to_text(tolerance.value) + " (" + to_text(tolerance.share) +
                     " of them may); the most at x = " + to_text(result.x) + ", y = " + to_text(result.y) + ": " +
                     detail::channels_of<Pixel>::text(found(result.x, result.y)) + ", expected " +
                     detail::channels_of<Pixel>::text(expected(result.x, result.y)) + ", off by " +
                     detail::distance_text(result.largest);
    return result;
}

/// Shows where two pictures differ: the expected one in dim gray, overlaid in blue where the mean of the found one's
/// channels is lower and in red where they differ otherwise, in full colour at the largest difference.
/// @throws invalid_input if the sizes differ
template <storable_pixel Pixel>
image<rgb8> difference_picture(const image<Pixel>& found, const image<Pixel>& expected) {
    detail::require_equal("width of the picture", found.width(), expected.width(), "that of the expected one");
    detail::require_equal("height of the picture", found.height(), expected.height(), "that of the expected one");
    const auto mean = [](const Pixel& p) {
        double sum = 0;
        for (int c = 0; c < detail::channels_of<Pixel>::count; ++c) sum += detail::channels_of<Pixel>::at(p, c);
        return sum / detail::channels_of<Pixel>::count;
    };
    double brightest = 0, largest = 0;
    const auto raise_to = [](double& maximum, double value) {
        if (numeric::is_finite(value) && value > maximum) maximum = value;
    };
    for (int y = 0; y < found.height(); ++y)
        for (int x = 0; x < found.width(); ++x) {
            raise_to(brightest, mean(expected(x, y)));
            raise_to(largest, detail::pixel_distance(found(x, y), expected(x, y)));
        }
    const auto level = [](double value, double full) {
        const double share = full > 0 ? value / full : value > 0 ? 1 : 0;  // full is 0 if no finite value is above 0
        return static_cast<std::uint8_t>(share >= 1 ? 255 : share > 0 ? 255 * share : 0);
    };
    image<rgb8> picture(found.width(), found.height());
    for (int y = 0; y < found.height(); ++y)
        for (int x = 0; x < found.width(); ++x) {
            const double difference = detail::pixel_distance(found(x, y), expected(x, y));
            const auto dim = static_cast<std::uint8_t>(level(mean(expected(x, y)), brightest) / 3);
            const auto mark =
                static_cast<std::uint8_t>(difference > 0 ? 80 + 175 * level(difference, largest) / 255 : 0);
            const bool is_darker = mean(found(x, y)) < mean(expected(x, y));
            picture(x, y) = difference > 0 ? (is_darker ? rgb8{0, 0, mark} : rgb8{mark, 0, 0}) : rgb8{dim, dim, dim};
        }
    return picture;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
