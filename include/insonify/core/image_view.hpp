// Non-owning views of pixels: pointer, size and row stride. Every algorithm takes these.
#pragma once

#include <insonify/core/error.hpp>

#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>

namespace insonify {
inline namespace INSONIFY_ABI {

/// Non-owning, strided view of row-major pixels; row 0 is at the top. Copying it copies no pixel.
template <class T>
class image_view {
  public:
    using value_type = std::remove_const_t<T>;

    image_view() = default;

    /// @param data    first pixel of the first row (may be null for an empty view)
    /// @param width   pixels in a row, >= 0
    /// @param height  rows, >= 0
    /// @param stride  pixels from one row to the next, >= width
    /// @throws invalid_input for a negative size or a stride shorter than a row
    INSONIFY_TAGGED image_view(T* data, int width, int height, std::ptrdiff_t stride)
        : data_(data), width_(width), height_(height), stride_(stride) {
        detail::require(width >= 0, "width", width, "at least 0");
        detail::require(height >= 0, "height", height, "at least 0");
        detail::require(stride >= width, "stride", stride, "at least the width");
    }
    INSONIFY_MEMBER image_view(T* data, int width, int height) : image_view(data, width, height, width) {}

    /// Converts from a view of mutable pixels.
    template <std::same_as<value_type> Mutable>
        requires(std::is_const_v<T>)
    INSONIFY_MEMBER image_view(image_view<Mutable> other)
        : data_(other.data()), width_(other.width()), height_(other.height()), stride_(other.stride()) {}

    int width() const { return width_; }
    int height() const { return height_; }
    std::ptrdiff_t stride() const { return stride_; }
    INSONIFY_MEMBER std::size_t size() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    }
    INSONIFY_MEMBER bool empty() const { return width_ == 0 || height_ == 0; }
    T* data() const { return data_; }

    INSONIFY_MEMBER T& operator()(int x, int y) const {
        INSONIFY_ASSERT(0 <= x && x < width_ && 0 <= y && y < height_);
        return data_[y * stride_ + x];
    }
    INSONIFY_MEMBER std::span<T> row(int y) const {
        INSONIFY_ASSERT(0 <= y && y < height_);
        return {data_ + y * stride_, static_cast<std::size_t>(width_)};
    }

    /// The part of the view that starts at (x, y); shares the pixels.
    /// @throws invalid_input if the part is not inside the view
    INSONIFY_TAGGED image_view part(int x, int y, int width, int height) const {
        detail::require(x >= 0 && x <= width_, "x", x, "0 to the width of the view");
        detail::require(y >= 0 && y <= height_, "y", y, "0 to the height of the view");
        detail::require(width >= 0 && width <= width_ - x, "width", width, "0 to the view's width less x");
        detail::require(height >= 0 && height <= height_ - y, "height", height, "0 to the view's height less y");
        // The corner of an empty part may lie past the last pixel, where no pointer may be formed.
        const bool is_empty = width == 0 || height == 0;
        return {is_empty ? data_ : data_ + y * stride_ + x, width, height, stride_};
    }

  private:
    T* data_ = nullptr;
    int width_ = 0;
    int height_ = 0;
    std::ptrdiff_t stride_ = 0;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify
