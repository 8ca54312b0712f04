// The depth and visibility buffer of one tile.
//
// Visibility is resolved here, in cache (40 KiB for 64 x 64 pixels), before anything is shaded: every pixel is shaded
// once.
#pragma once

#include <insonify/core/simd/lanes.hpp>

#include <limits>
#include <memory>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Depth of a tile's pixels and, if HasIds, the id of the triangle that each shows.
template <bool HasIds>
class tile_buffer {
  public:
    static constexpr std::uint32_t invalid_id = 0xFFFFFFFFu;
    static constexpr int slack = 16;  ///< whole vectors may reach past the end of a row
    static constexpr int block = 4;   ///< pixels a side, see block_offsets

    explicit tile_buffer(int size)
        : stride_(size + slack),
          count_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(size)),
          depth_(new float[count_]),
          ids_(HasIds ? new std::uint32_t[count_] : nullptr) {
        for (int i = 0; i < block * block; ++i)
            block_offsets_[i] = static_cast<std::uint32_t>(i / block * stride_ + i % block);
    }

    /// Moves the tile's first pixel to (x, y) of the image.
    void restart(int x, int y) {
        x_ = x;
        y_ = y;
    }

    template <int N>
    INSONIFY_INLINE void clear() {
        const lanes<float, N> farthest = lanes<float, N>{} + std::numeric_limits<float>::infinity();
        const lanes<std::uint32_t, N> none = lanes<std::uint32_t, N>{} + invalid_id;
        for (std::size_t i = 0; i < count_; i += N) {
            store(depth_.get() + i, farthest);
            if constexpr (HasIds) store(ids_.get() + i, none);
        }
    }

    std::ptrdiff_t stride() const { return stride_; }
    /// Offsets of the pixels of a block from its first, row by row.
    const std::uint32_t* block_offsets() const { return block_offsets_; }
    /// Indices of pixels into depths() and ids().
    template <int N>
    INSONIFY_INLINE void index(lanes<std::int32_t, N>& into, const lanes<std::int32_t, N>& x,
                               const lanes<std::int32_t, N>& y) const {
        into = (y - y_) * stride_ + (x - x_);
    }
    std::ptrdiff_t index(int x, int y) const { return static_cast<std::ptrdiff_t>(y - y_) * stride_ + (x - x_); }
    float* depths() { return depth_.get(); }
    std::uint32_t* ids() { return ids_.get(); }
    float* depth_at(int x, int y) { return depth_.get() + index(x, y); }
    std::uint32_t* id_at(int x, int y) { return HasIds ? ids_.get() + index(x, y) : nullptr; }

  private:
    int stride_;
    std::uint32_t block_offsets_[static_cast<unsigned>(block * block)];
    int x_ = 0, y_ = 0;
    std::size_t count_;
    std::unique_ptr<float[]> depth_;
    std::unique_ptr<std::uint32_t[]> ids_;
};

/// The depth test of N pixels: a smaller depth replaces the stored one; a tie keeps it.
/// @param ids  null without HasIds
template <int N, bool HasIds>
INSONIFY_INLINE void test_depth(float* depth, std::uint32_t* ids, const lanes<std::int32_t, N>& covered,
                                const lanes<float, N>& z, const lanes<std::uint32_t, N>& id) {
    lanes<float, N> old;
    load(old, depth);
    const lanes<std::int32_t, N> visible = covered & lanes<std::int32_t, N>(z < old);
    store(depth, lanes<float, N>(visible ? z : old));
    if constexpr (HasIds) {
        lanes<std::uint32_t, N> before;
        load(before, ids);
        store(ids, lanes<std::uint32_t, N>(visible ? id : before));
    }
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
