// Input of the shadow pass: which pixels' light is undecided, and how much may arrive there.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/core/rect.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Marks pixels, eight to a byte; rows start a byte.
class pixel_marks {
  public:
    pixel_marks() = default;
    pixel_marks(int width, int height, const shared_pool& memory)
        : bytes_((width + 7) / 8, height, uninitialized{}, memory) {}

    /// Clears a rectangle that starts and, unless at the image's edge, ends at a multiple of 8.
    void clear(const rect& pixels) {
        for (int y = pixels.y0; y < pixels.y1; ++y)
            std::fill_n(&bytes_(pixels.x0 / 8, y), (pixels.width() + 7) / 8, std::uint8_t{0});
    }
    /// Sets the marks of some of up to eight pixels, bit by bit, that lie in one byte.
    INSONIFY_INLINE void set(int x, int y, unsigned which, unsigned marks) {
        std::uint8_t& byte = bytes_(x / 8, y);
        byte = static_cast<std::uint8_t>((byte & ~(which << x % 8)) | (marks & which) << x % 8);
    }
    void set(int x, int y) { set(x, y, 1, 1); }
    /// Calls visit(x) for each marked pixel of a row, from x0 to x1, which are multiples of 8 or the row's end.
    template <class Visit>
    void for_each(int x0, int x1, int y, const Visit& visit) const {
        for (int x = x0; x < x1; x += 8)
            for (unsigned left = bytes_(x / 8, y); left != 0; left &= left - 1) visit(x + std::countr_zero(left));
    }

  private:
    image<std::uint8_t> bytes_;
};

/// Output of shading for the shadow pass.
///
/// A pixel whose triangle is known to be lit gets all its light at once, any other its sky and ambient light.
struct undecided_light {
    pixel_marks marks;      ///< pixels whose light is undecided
    image<float> direct;    ///< light that the source adds to them if nothing blocks it
    bool has_dark = false;  ///< whether pixels without such light are marked too, to label their shadows
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
