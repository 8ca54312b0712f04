// The points of one tile of a light's plane, sorted into cells, so that the points under a triangle are a few runs.
#pragma once

#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/shadow/policy.hpp>

#include <algorithm>
#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// A point on the plane, from the lower corner of the tiles, on its way into a tile.
struct receiver {
    float u, v, height;
    std::uint32_t point;           ///< the caller's number of it
    std::uint32_t mesh, triangle;  ///< that it lies on
    std::uint32_t casters;         ///< numbers below this are tested
};

/// A tile's receivers by cell: rows along u, one after another.
class receiver_cells {
  public:
    /// @param lower, size  of the tile
    void sort(std::span<const receiver> from, const glm::vec2& lower, const glm::vec2& size) {
        const std::size_t count = from.size();
        int side = 1;
        while (side < widest && static_cast<std::size_t>(side * side) * per_cell < count) side *= 2;
        columns_ = 2 * side;
        rows_ = side;
        lower_ = lower;
        largest_ = (std::max)(lower.x + size.x, lower.y + size.y);
        scale_ = {static_cast<float>(columns_) / size.x, static_cast<float>(rows_) / size.y};
        cell_ = {size.x / static_cast<float>(columns_), size.y / static_cast<float>(rows_)};

        starts_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
        keys_.resize(count);
        lowest_ = std::numeric_limits<float>::infinity(), highest_ = -lowest_;
        for (std::size_t i = 0; i < count; ++i) {
            const receiver& r = from[i];
            keys_[i] = static_cast<std::uint16_t>(row(r.v) * columns_ + column(r.u));
            ++starts_[keys_[i] + 1u];
            lowest_ = (std::min)(lowest_, r.height);
            highest_ = (std::max)(highest_, r.height);
        }
        for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
        const std::size_t room = count + padding;
        for (auto* array : {&u, &v, &height}) array->resize(room);
        for (auto* array : {&point, &mesh, &triangle, &limit_}) array->resize(room);
        is_limited_ = false;
        is_one_mesh_ = true;
        next_.assign(starts_.begin(), starts_.end() - 1);
        for (std::size_t i = 0; i < count; ++i) {
            const receiver& r = from[i];
            const std::size_t at = next_[keys_[i]]++;
            u[at] = r.u;
            v[at] = r.v;
            height[at] = r.height;
            point[at] = r.point;
            mesh[at] = r.mesh;
            triangle[at] = r.triangle;
            limit_[at] = r.casters;
            is_one_mesh_ = is_one_mesh_ && r.mesh == from.front().mesh;
            is_limited_ = is_limited_ || r.casters != invalid_id;
        }
        for (std::size_t i = count; i < room; ++i) u[i] = v[i] = height[i] = 0;
        caster.assign(room, open);
    }

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    const glm::vec2& lower() const { return lower_; }
    const glm::vec2& scale() const { return scale_; }  ///< cells a unit
    const glm::vec2& cell() const { return cell_; }
    float lowest() const { return lowest_; }
    float highest() const { return highest_; }
    std::size_t size() const { return keys_.size(); }
    /// No coordinate u or v is larger.
    float largest() const { return largest_; }
    /// Whether any lies on something else than a caster.
    bool has_others(std::uint32_t number) const { return !is_one_mesh_ || mesh.front() != number; }
    /// Receivers that are tested for the first casters alone take no more from now on.
    void close(std::uint32_t casters) {
        if (!is_limited_) return;
        for (std::size_t i = 0; i < size(); ++i)
            if (limit_[i] <= casters && caster[i] == open) caster[i] = closed;
    }
    static constexpr std::int32_t open = -1, closed = -2;
    /// Receivers of the cells [first, last] of a row lie from start(row, first) up to start(row, last + 1).
    std::uint32_t start(int row, int column) const {
        return starts_[static_cast<std::size_t>(row * columns_ + column)];
    }

    std::vector<float> u, v, height;  ///< in the order of cells, with room for one more vector
    std::vector<std::uint32_t> point, mesh, triangle;
    std::vector<std::int32_t> caster;  ///< that blocks it, or open, or closed

  private:
    static constexpr int widest = 128;          // rows
    static constexpr std::size_t per_cell = 2;  ///< receivers, or more; fewer take longer to sort
    static constexpr std::size_t padding = 16;

    int column(float at) const { return hold((at - lower_.x) * scale_.x, columns_); }
    int row(float at) const { return hold((at - lower_.y) * scale_.y, rows_); }
    static int hold(float at, int count) {
        return static_cast<int>((std::min)((std::max)(0.0f, at), static_cast<float>(count - 1)));
    }

    int columns_ = 1, rows_ = 1;
    glm::vec2 lower_{0}, scale_{1}, cell_{1};
    float lowest_ = 0, highest_ = 0, largest_ = 0;
    bool is_limited_ = false, is_one_mesh_ = true;
    std::vector<std::uint32_t> starts_, next_, limit_;
    std::vector<std::uint16_t> keys_;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
