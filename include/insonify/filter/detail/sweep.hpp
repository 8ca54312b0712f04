// One pass over an image: row by row, in runs that fit the nearest cache, shared out by an executor.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/core/image.hpp>
#include <insonify/filter/concept.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Column and row that filters take the first pixel of an image for.
struct pixel_origin {
    int x = 0, y = 0;
};

namespace detail::inline INSONIFY_FLAGS {

/// Neighbours in a row, at most run_length of them; `to` may be `from`.
template <class Pass, class From, class To>
INSONIFY_INLINE void call_row(Pass& pass, const From* from, To* to, int count, int x, int y) {
    if constexpr (row_function<Pass, From>) {
        pass.row(from, to, count, x, y);
    } else {
        for (int i = 0; i < count; ++i) to[i] = call_pixel(pass, from[i], x + i, y);
    }
}

/// Whoever wants to know where the image lies and how large it is before its pixels come is told.
template <class Pass>
void place_pass(Pass& pass, const pixel_area& area) {
    if constexpr (requires { pass.place(area); }) pass.place(area);
}

/// What is done with a run's pass behind its last row: nothing.
inline constexpr auto forget_pass = [](const auto&) {};

/// Rows in runs of some 64 Ki pixels, in any order, each with a copy of the pass; `to` may be `from`.
/// @param done  called with each of the copies, by any of the executor's threads
template <class From, class To, class Pass, executor E, class Done = decltype(forget_pass)>
void sweep(image_view<const From> from, image_view<To> to, const Pass& pass, E& ex, pixel_origin origin,
           const Done& done = forget_pass) {
    Pass placed = pass;
    place_pass(placed, {origin.x, origin.y, from.width(), from.height()});
    const int rows = 65536 / (std::max)(from.width(), 1) + 1;
    bulk_ranges(ex, static_cast<std::size_t>(from.height()), static_cast<std::size_t>(rows),
                [&](std::size_t first, std::size_t last) {
                    Pass own = placed;
                    for (int y = static_cast<int>(first); y < static_cast<int>(last); ++y) {
                        const From* const source = from.row(y).data();
                        To* const target = to.row(y).data();
                        for (int x = 0; x < from.width(); x += run_length) {
                            const int count = (std::min)(run_length, from.width() - x);
                            call_row(own, source + x, target + x, count, origin.x + x, origin.y + y);
                        }
                    }
                    done(own);
                });
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
