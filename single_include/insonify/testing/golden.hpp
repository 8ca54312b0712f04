// Golden pictures: compares pictures with files, and writes the differences beside them.
//
//     const in::golden_pictures golden{.folder = "tests/golden"};
//     const auto result = golden.compare("cube", frame.image);
//     CHECK(result);                     // any framework; result.message says where and by how much
//     EXPECT_THAT(frame.image, golden.is("cube", {.value = 1e-6}));   // GoogleTest; for Catch2 see catch2.hpp
//
// A run with INSONIFY_UPDATE_GOLDEN=1 in its environment writes the golden pictures instead.
#pragma once

#include <insonify/testing/compare.hpp>

#include <cstdlib>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// File extension of a netpbm file of such pixels.
template <class Pixel>
constexpr const char* netpbm_extension() {
    using stored = netpbm_pixel<Pixel>;
    if (std::is_same_v<typename stored::sample, float>) return ".pfm";
    return stored::channels == 1 ? ".pgm" : ".ppm";
}

/// Writes the found picture and its difference to files, and appends their paths to a message.
template <class Pixel>
std::string with_files(std::string message, const std::string& stem, const image<Pixel>& found,
                       const image<Pixel>& expected) {
    if (found.empty()) return message;
    const std::string found_path = stem + ".found" + netpbm_extension<Pixel>();
    write_netpbm(found_path, found);
    message += "; see " + found_path;
    if (found.width() != expected.width() || found.height() != expected.height()) return message;
    const std::string difference = stem + ".difference.ppm";
    write_netpbm(difference, difference_picture(found, expected));
    return message + " and " + difference;
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Whether the environment variable INSONIFY_UPDATE_GOLDEN is set, and neither empty nor 0.
inline bool golden_update_requested() {
    const char* const value = std::getenv("INSONIFY_UPDATE_GOLDEN");
    return value != nullptr && value[0] != '\0' && std::string(value) != "0";
}

/// A matcher for EXPECT_THAT of GoogleTest and GoogleMock (1.11 and later). Needs none of their headers.
template <class Compare>
struct picture_matcher {
    using is_gtest_matcher = void;

    Compare compare;  ///< compare(picture) -> picture_comparison
    std::string what;

    template <class Picture>
    bool MatchAndExplain(const Picture& picture, std::ostream* out) const {
        const picture_comparison result = compare(picture);
        if (!result && out != nullptr) *out << result.message;
        return static_cast<bool>(result);
    }
    void DescribeTo(std::ostream* out) const { *out << "is " << what; }
    void DescribeNegationTo(std::ostream* out) const { *out << "is not " << what; }
};
/// Deduces the comparison.
template <class Compare>
picture_matcher(Compare, std::string) -> picture_matcher<Compare>;

/// Prints a picture for GoogleTest, which would print its bytes.
template <class Pixel>
void PrintTo(const image<Pixel>& picture, std::ostream* out) {
    *out << "a picture of " << detail::size_text(picture.width(), picture.height());
}

/// Matches a picture that agrees with the expected one, which is copied.
template <storable_pixel Pixel>
auto is_picture(image<Pixel> expected, const picture_tolerance& tolerance = {}) {
    return picture_matcher{[expected = std::move(expected), tolerance](const image<Pixel>& found) {
                               return compare_pictures(found, expected, tolerance);
                           },
                           std::string("the expected picture")};
}

/// A folder of golden pictures as netpbm files: `<name>.pfm` of floats, `.pgm` of integers, `.ppm` of colours.
struct golden_pictures {
    std::string folder = ".";  ///< must exist
    /// Folder to which a failing test writes `<name>.found` and `<name>.difference`; empty: `folder`.
    std::string failures{};
    bool update = golden_update_requested();

    /// Compares a picture with the golden one of that name, or replaces the golden one if `update` is set. If they
    /// differ, writes the picture and the difference to files that the message names.
    /// @throws io_error if a file can't be read or written; invalid_input as `compare_pictures`
    template <storable_pixel Pixel>
    picture_comparison compare(const std::string& name, const image<Pixel>& found,
                               const picture_tolerance& tolerance = {}) const {
        const std::string path = folder + "/" + name + detail::netpbm_extension<Pixel>();
        if (update) {
            write_netpbm(path, found);
            return {.pixels = found.size()};
        }
        const std::string stem = (failures.empty() ? folder : failures) + "/" + name;
        errno = 0;
        if (!detail::file_handle(path, "rb").get() && errno == ENOENT) {
            picture_comparison missing;
            missing.message = detail::with_files<Pixel>("there is no golden picture " + path +
                                                            ": look at the picture, then run again with "
                                                            "INSONIFY_UPDATE_GOLDEN=1 to keep it",
                                                        stem, found, {});
            return missing;
        }
        const image<Pixel> expected = read_netpbm<Pixel>(path);
        picture_comparison result = compare_pictures(found, expected, tolerance);
        if (!result) result.message = detail::with_files<Pixel>(name + ": " + result.message, stem, found, expected);
        return result;
    }

    /// The same as a matcher: EXPECT_THAT(frame.image, golden.is("cube")).
    auto is(const std::string& name, const picture_tolerance& tolerance = {}) const {
        return picture_matcher{
            [golden = *this, name, tolerance](const auto& found) { return golden.compare(name, found, tolerance); },
            "the golden picture \"" + name + "\""};
    }
};

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify
