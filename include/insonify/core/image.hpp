// Owning images, and the RGB pixel type.
#pragma once

#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/image_view.hpp>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <utility>

namespace insonify {
inline namespace INSONIFY_ABI {

/// Red, green and blue, in that order in memory.
template <class T>
struct rgb {
    T r{}, g{}, b{};
    friend bool operator==(const rgb&, const rgb&) = default;
};
/// A colour of 8 bits per channel.
using rgb8 = rgb<std::uint8_t>;

/// Owning row-major image without padding; row 0 is at the top, pixel (x, y) covers [x, x+1) x [y, y+1).
template <class T>
class image {
  public:
    using value_type = T;

    image() = default;

    /// @param width, height  pixels, each in [0, 2^30]; width x height at most 2^40
    /// @throws invalid_input for a size outside that range
    INSONIFY_MEMBER image(int width, int height, T fill = T{})
        : width_(checked(width, "width")), height_(checked(height, "height")), pixels_(area(), fill) {}

    /// Pixels are left uninitialized.
    /// @param memory  pool of a context, see detail::memory_of
    /// @throws invalid_input as above
    INSONIFY_MEMBER image(int width, int height, detail::uninitialized, const detail::shared_pool& memory = {})
        : width_(checked(width, "width")), height_(checked(height, "height")), pixels_(area(), memory) {}

    /// Rows written out, for tests and small tables: `image<float>{{0, 1}, {2, 3}}`.
    /// @throws invalid_input for rows of different lengths
    INSONIFY_TAGGED image(std::initializer_list<std::initializer_list<T>> rows)
        : width_(rows.size() == 0 ? 0 : static_cast<int>(rows.begin()->size())),
          height_(static_cast<int>(rows.size())),
          pixels_(area()) {
        T* to = pixels_.data();
        for (const auto& row : rows) {
            detail::require_equal("row length", row.size(), static_cast<std::size_t>(width_), "that of the first row");
            to = std::copy(row.begin(), row.end(), to);
        }
    }

    /// A packed copy of a view.
    INSONIFY_TAGGED explicit image(image_view<const T> source)
        : image(source.width(), source.height(), detail::uninitialized{}) {
        for (int y = 0; y < height_; ++y) {
            const auto from = source.row(y);
            std::copy(from.begin(), from.end(), row(y).begin());
        }
    }

    image(const image&) = default;
    /// The other image is empty afterwards.
    INSONIFY_MEMBER image(image&& other) noexcept
        : width_(std::exchange(other.width_, 0)),
          height_(std::exchange(other.height_, 0)),
          pixels_(std::move(other.pixels_)) {}
    /// If allocation fails, the image is unchanged. An image that was moved from is empty.
    INSONIFY_MEMBER image& operator=(image other) noexcept {
        pixels_ = std::move(other.pixels_);
        width_ = other.width_, height_ = other.height_;
        return *this;
    }

    int width() const { return width_; }
    int height() const { return height_; }
    INSONIFY_MEMBER std::size_t size() const { return pixels_.size(); }
    INSONIFY_MEMBER bool empty() const { return pixels_.empty(); }

    INSONIFY_MEMBER T& operator()(int x, int y) { return pixels_[index(x, y)]; }
    INSONIFY_MEMBER const T& operator()(int x, int y) const { return pixels_[index(x, y)]; }

    INSONIFY_MEMBER std::span<T> row(int y) & {
        return {pixels_.data() + index(0, y), static_cast<std::size_t>(width_)};
    }
    INSONIFY_MEMBER std::span<const T> row(int y) const& {
        return {pixels_.data() + index(0, y), static_cast<std::size_t>(width_)};
    }
    INSONIFY_MEMBER std::span<T> pixels() & { return {pixels_.data(), pixels_.size()}; }
    INSONIFY_MEMBER std::span<const T> pixels() const& { return {pixels_.data(), pixels_.size()}; }
    INSONIFY_MEMBER image_view<T> view() & { return {pixels_.data(), width_, height_}; }
    INSONIFY_MEMBER image_view<const T> view() const& { return {pixels_.data(), width_, height_}; }
    // Views of a temporary would outlive its pixels, as in a range-based for over its pixels().
    std::span<T> row(int y) && = delete;
    std::span<T> pixels() && = delete;
    image_view<T> view() && = delete;
    INSONIFY_MEMBER operator image_view<T>() & { return view(); }
    INSONIFY_MEMBER operator image_view<const T>() const& { return view(); }

    friend bool operator==(const image&, const image&) = default;

  private:
    INSONIFY_MEMBER static int checked(int extent, const char* name) {
        detail::require(extent >= 0 && extent <= (1 << 30), name, extent, "0 to 2^30");
        return extent;
    }
    INSONIFY_TAGGED std::size_t area() const {
        const std::uint64_t pixels = static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
        detail::require(pixels <= (std::uint64_t{1} << 40), "width x height", pixels, "at most 2^40 pixels");
        constexpr std::uint64_t addressable = (std::numeric_limits<std::size_t>::max)() / sizeof(T);
        detail::require(pixels <= addressable, "width x height", pixels, "as many as this machine can address");
        return static_cast<std::size_t>(pixels);
    }
    INSONIFY_MEMBER std::size_t index(int x, int y) const {
        INSONIFY_ASSERT(0 <= x && (x < width_ || width_ == 0) && 0 <= y && y < height_);
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }

    int width_ = 0;
    int height_ = 0;
    detail::uninitialized_array<T> pixels_;
};

inline namespace INSONIFY_FLAGS {

/// An image of `fn(pixel)` for every pixel; its pixel type is the result type of `fn`.
template <class T, class Fn>
auto map_pixels(image_view<T> source, Fn&& fn) {
    using result = std::decay_t<decltype(fn(std::declval<const T&>()))>;
    image<result> out(source.width(), source.height(), detail::uninitialized{});
    for (int y = 0; y < source.height(); ++y) {
        const auto from = source.row(y);
        std::transform(from.begin(), from.end(), out.row(y).begin(), fn);
    }
    return out;
}
/// The same for an image.
template <class T, class Fn>
auto map_pixels(const image<T>& source, Fn&& fn) {
    return map_pixels(source.view(), fn);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify
