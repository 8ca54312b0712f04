// Concepts of filters: what may stand to the right of an image in `image | filter`.
//
// A filter is a callable or a plain aggregate of one of three kinds:
//
//     image     f(image)                                                             -> image
//     measured  f.pass(view) reads the whole image and returns a function as below
//     pixel     f(pixel), f(pixel, x, y), or f.pass() that returns such a function   -> pixel
//
// A measured filter may also have `f.pass(view, executor)`, which is called instead, to measure on the threads of the
// chain. The function of a measured filter must not refer to the view: pixels may be replaced while it runs, and the
// image may no longer exist. A filter that reads other pixels is an image filter.
//
// `pass` returns a value, which is copied for each band of rows: it may keep state between pixels. It may process up to
// run_length adjacent pixels at once by `row(from, to, count, x, y)`, to[i] = fn(from[i], x + i, y), where `to` may be
// `from`. Passes that need the image's origin and size implement `prepare(area)`, called before the first pixel; it may
// throw. Passes that compute rows above a band before its first one say how many by `rows_above()`: their bands are at
// least twice as high, and are walked run by run downwards rather than row by row.
#pragma once

#include <insonify/core/image.hpp>

#include <concepts>
#include <type_traits>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// Calls fn(pixel, x, y) if fn takes a position, fn(pixel) otherwise.
template <class Fn, class Pixel>
    requires(std::invocable<Fn&, const Pixel&, int, int>)
INSONIFY_INLINE auto call_pixel(Fn& fn, const Pixel& pixel, int x, int y) {
    return fn(pixel, x, y);
}
template <class Fn, class Pixel>
    requires(std::invocable<Fn&, const Pixel&> && !std::invocable<Fn&, const Pixel&, int, int>)
INSONIFY_INLINE auto call_pixel(Fn& fn, const Pixel& pixel, int, int) {
    return fn(pixel);
}

}  // namespace detail::inline INSONIFY_FLAGS

/// A function of a pixel, or of a pixel with its column and row, that returns a pixel.
template <class Fn, class Pixel>
concept pixel_function = requires(Fn& fn, const Pixel& pixel) {
    { detail::call_pixel(fn, pixel, 0, 0) } -> std::movable;
};

/// Column and row of an image's first pixel in a larger image, for filters that depend on the position. Each
/// coordinate within 2^30 of 0.
struct pixel_origin {
    int x = 0, y = 0;
};

/// Origin and size of an image, which may be part of a larger one.
struct pixel_area {
    int x, y, width, height;
};

/// Largest count of a `row` call. Buffers of this many pixels fit the first-level cache several times over.
inline constexpr int run_length = 512;

namespace detail::inline INSONIFY_FLAGS {

/// Number of rows above a band that a pass computes.
template <class Pass>
int rows_above(const Pass& pass) {
    if constexpr (requires { pass.rows_above(); })
        return pass.rows_above();
    else
        return 0;
}

template <class Fn, class Pixel>
using pass_result = decltype(call_pixel(std::declval<Fn&>(), std::declval<const Pixel&>(), 0, 0));

}  // namespace detail::inline INSONIFY_FLAGS

/// A pixel function that also processes adjacent pixels of a row at once.
template <class Fn, class Pixel>
concept row_function = pixel_function<Fn, Pixel> &&
    requires(Fn& fn, const Pixel* from, detail::pass_result<Fn, Pixel>* to) {
    fn.row(from, to, 1, 0, 0);
};

/// Takes an image and returns an image. Checked first, so that a generic lambda (`[](const auto& picture)`) is one.
template <class F, class Pixel>
concept image_filter = requires(const F& f, image<Pixel> in) {
    requires std::same_as<std::remove_cvref_t<decltype(f(std::move(in)))>,
                          image<typename std::remove_cvref_t<decltype(f(std::move(in)))>::value_type>>;
};

/// Measures the whole image, then maps pixels.
template <class F, class Pixel>
concept measured_filter = requires(const F& f, image_view<const Pixel> in) {
    { f.pass(in) } -> pixel_function<Pixel>;
};

/// Maps pixels one by one.
template <class F, class Pixel>
concept pixel_filter = pixel_function<const F, Pixel> || requires(const F& f) {
    { f.pass() } -> pixel_function<Pixel>;
};

/// Any filter for images of such pixels.
template <class F, class Pixel>
concept filter_for = image_filter<F, Pixel> || measured_filter<F, Pixel> || pixel_filter<F, Pixel>;

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
