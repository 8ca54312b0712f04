// What one tile shows so far.
//
// A tile resolves visibility in buffers of its own that stay in the first-level cache; who won is known before anything
// is shaded, and shading happens once per pixel.
#pragma once

#include <insonify/core/simd/lanes.hpp>

#include <limits>
#include <memory>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Depth of a tile's pixels and, where Winners, the name of the triangle that each shows.
template <bool Winners>
class tile_buffer {
  public:
    static constexpr std::uint32_t nobody = 0xFFFFFFFFu;
    static constexpr int slack = 16;  // whole vectors may reach past the end of a row
    static constexpr int block = 4;   // pixels a side, see in_block

    explicit tile_buffer(int size)
        : stride_(size + slack),
          count_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(size)),
          depth_(new float[count_]),
          winner_(Winners ? new std::uint32_t[count_] : nullptr) {
        for (int i = 0; i < block * block; ++i) block_[i] = static_cast<std::uint32_t>(i / block * stride_ + i % block);
    }

    /// Puts the tile where its first pixel is (x, y) of the image.
    void restart(int x, int y) {
        x_ = x;
        y_ = y;
    }

    template <int N>
    INSONIFY_INLINE void clear() {
        const lanes<float, N> farthest = lanes<float, N>{} + std::numeric_limits<float>::infinity();
        const lanes<std::uint32_t, N> none = lanes<std::uint32_t, N>{} + nobody;
        for (std::size_t i = 0; i < count_; i += N) {
            store(depth_.get() + i, farthest);
            if constexpr (Winners) store(winner_.get() + i, none);
        }
    }

    std::ptrdiff_t stride() const { return stride_; }
    /// From a pixel to number 4 row + column of the 4 x 4 pixels that start with it.
    const std::uint32_t* in_block() const { return block_; }
    /// Where pixels lie in the tile's memory, counted from depths() and winners().
    template <int N>
    INSONIFY_INLINE void index(lanes<std::int32_t, N>& into, const lanes<std::int32_t, N>& x,
                               const lanes<std::int32_t, N>& y) const {
        into = (y - y_) * stride_ + (x - x_);
    }
    std::ptrdiff_t index(int x, int y) const { return static_cast<std::ptrdiff_t>(y - y_) * stride_ + (x - x_); }
    float* depths() { return depth_.get(); }
    std::uint32_t* winners() { return winner_.get(); }
    float* depth(int x, int y) { return depth_.get() + index(x, y); }
    std::uint32_t* winner(int x, int y) { return Winners ? winner_.get() + index(x, y) : nullptr; }

  private:
    int stride_;
    std::uint32_t block_[static_cast<unsigned>(block * block)];
    int x_ = 0, y_ = 0;
    std::size_t count_;
    std::unique_ptr<float[]> depth_;
    std::unique_ptr<std::uint32_t[]> winner_;
};

/// Keeps the nearer of what is there and what comes; a tie stays with whoever came first. `winner` may be null if
/// nobody's name is kept.
template <int N, bool Winners>
INSONIFY_INLINE void keep_nearer(float* depth, std::uint32_t* winner, const lanes<std::int32_t, N>& covered,
                                 const lanes<float, N>& z, const lanes<std::uint32_t, N>& name) {
    using floats = lanes<float, N>;
    using names = lanes<std::uint32_t, N>;
    floats old;
    load(old, depth);
    const lanes<std::int32_t, N> visible = covered & lanes<std::int32_t, N>(z < old);
    store(depth, floats(visible ? z : old));
    if constexpr (Winners) {
        names before;
        load(before, winner);
        store(winner, names(visible ? name : before));
    }
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
