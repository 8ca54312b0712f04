// Runs one pass over an image: row by row, in runs that fit the first-level cache, rows shared out by an executor.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/core/image.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/filter/concept.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// Applies a pass to at most run_length adjacent pixels of a row; `to` may be `from`.
template <class Pass, class From, class To>
INSONIFY_INLINE void call_row(Pass& pass, const From* from, To* to, int count, int x, int y) {
    if constexpr (row_function<Pass, From>)
        pass.row(from, to, count, x, y);
    else
        for (int i = 0; i < count; ++i) to[i] = call_pixel(pass, from[i], x + i, y);
}

/// Passes that need the image's origin and size implement `prepare(area)`; it runs before the first pixel.
template <class Pass>
void prepare_pass(Pass& pass, const pixel_area& area) {
    if constexpr (requires { pass.prepare(area); }) pass.prepare(area);
}

/// Applies a pass to an image, in bands of some 64 Ki pixels in any order, each with its own copy of the pass; `to` may
/// be `from`.
template <class From, class To, class Pass, executor E>
void run_pass(image_view<const From> from, image_view<To> to, const Pass& pass, E& ex, pixel_origin origin) {
    constexpr int farthest = 1 << 30;
    require_range("origin.x", origin.x, -farthest, farthest, "-2^30 to 2^30");
    require_range("origin.y", origin.y, -farthest, farthest, "-2^30 to 2^30");
    // Correlated noise evaluates up to 1024 pixels beyond the image; their coordinates must fit an int.
    constexpr std::int64_t upper_bound = (std::int64_t{1} << 31) - 1024;
    require(std::int64_t{origin.x} + from.width() <= upper_bound, "origin.x", origin.x, "at most 2^31 - 1024 - width");
    require(std::int64_t{origin.y} + from.height() <= upper_bound, "origin.y", origin.y,
            "at most 2^31 - 1024 - height");
    Pass prepared = pass;
    prepare_pass(prepared, {origin.x, origin.y, from.width(), from.height()});
    // A pass that needs the rows above gets long bands, and keeps those rows for one column of runs at a time.
    const int width = from.width(), above = rows_above(prepared);
    const int rows = (std::max)(65536 / (std::max)(width, 1) + 1, 2 * above), step = above > 0 ? run_length : width;
    bulk_ranges(ex, static_cast<std::size_t>(from.height()), static_cast<std::size_t>(rows),
                [&](std::size_t first, std::size_t last) {
                    Pass own = prepared;
                    for (int left = 0; left < width; left += step)
                        for (int y = static_cast<int>(first); y < static_cast<int>(last); ++y) {
                            const From* const source = from.row(y).data();
                            To* const target = to.row(y).data();
                            for (int x = left; x < (std::min)(left + step, width); x += run_length) {
                                const int count = (std::min)(run_length, width - x);
                                call_row(own, source + x, target + x, count, origin.x + x, origin.y + y);
                            }
                        }
                });
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
