// What may stand to the right of an image in `image | filter`.
//
// A filter is a callable or a plain aggregate of one of three kinds:
//
//     image     f(image)                                                             -> image
//     measured  f.pass(view), which looks at the whole image, returns a function as below; a level_filter
//               (filter/histogram.hpp) may be told its histogram instead
//     pixel     f(pixel), f(pixel, x, y), or f.pass() that returns such a function   -> pixel
//
// What `pass` returns is a value and is copied for each run of rows, so it may remember what it did last. It may do
// many pixels of a row at once, as noise does: `row(from, to, count, x, y)`, to[i] = fn(from[i], x + i, y), of at most
// run_length pixels, where `to` may be `from`. And it may be told the pixels' area before the first of them:
// `place(area)`, which throws where a map is of another size.
#pragma once

#include <insonify/core/image.hpp>

#include <concepts>
#include <type_traits>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// What an image can hold: not void, not bool (whose vector has no pixels to point at).
template <class T>
concept storable = std::movable<T> && !std::same_as<T, bool>;

/// Who asks for the position gets it.
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
    { detail::call_pixel(fn, pixel, 0, 0) } -> detail::storable;
};

/// The pixels of an image, as a part of a larger one or as all of it.
struct pixel_area {
    int x, y, width, height;
};

/// The most pixels that `row` is asked for at once; they fit the nearest cache several times over.
inline constexpr int run_length = 512;

namespace detail::inline INSONIFY_FLAGS {

template <class Fn, class Pixel>
using pass_result = decltype(call_pixel(std::declval<Fn&>(), std::declval<const Pixel&>(), 0, 0));

}  // namespace detail::inline INSONIFY_FLAGS

/// A function of a pixel that does many pixels of a row at once.
template <class Fn, class Pixel>
concept row_function = pixel_function<Fn, Pixel> &&
    requires(Fn& fn, const Pixel* from, detail::pass_result<Fn, Pixel>* to) {
    fn.row(from, to, 1, 0, 0);
};

/// Takes an image and returns an image. Asked first: a generic lambda (`[](const auto& picture)`) is one of these.
template <class F, class Pixel>
concept image_filter = requires(const F& f, image<Pixel> in) {
    requires std::same_as<std::remove_cvref_t<decltype(f(std::move(in)))>,
                          image<typename std::remove_cvref_t<decltype(f(std::move(in)))>::value_type>>;
};

/// Looks at the whole image to know what to do with a pixel.
template <class F, class Pixel>
concept measured_filter = requires(const F& f, image_view<const Pixel> in) {
    { f.pass(in) } -> pixel_function<Pixel>;
};

/// Works pixel by pixel.
template <class F, class Pixel>
concept pixel_filter = pixel_function<const F, Pixel> || requires(const F& f) {
    { f.pass() } -> pixel_function<Pixel>;
};

/// Whatever may stand to the right of an image of such pixels.
template <class F, class Pixel>
concept filter_for = image_filter<F, Pixel> || measured_filter<F, Pixel> || pixel_filter<F, Pixel>;

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
