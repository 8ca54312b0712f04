// The points of one tile of a light's plane, sorted into cells, so that the points under a triangle are a few runs.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/shadow/policy.hpp>

#include <algorithm>
#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

using insonify::detail::dynamic_array;

/// Batch of a point and its index in the batch, packed into 32 bits.
class batch_index {
  public:
    batch_index() = default;
    batch_index(std::size_t batch, std::size_t point) : value_(static_cast<std::uint32_t>(batch * max_batch + point)) {
        INSONIFY_ASSERT(batch < max_batches && point < max_batch);
    }

    std::size_t batch() const { return value_ / max_batch; }
    std::size_t point() const { return value_ % max_batch; }

  private:
    std::uint32_t value_;
};

/// A point on the plane, relative to the lower corner of the tiles, before it is sorted into a cell.
struct receiver {
    float u, v, height;
    batch_index place;
    std::uint32_t mesh, triangle;  ///< that it lies on
};

/// Range of mesh indices.
struct mesh_range {
    std::uint32_t first = invalid_id, last = 0;

    void include(std::uint32_t mesh) {
        first = (std::min)(first, mesh);
        last = (std::max)(last, mesh);
    }
    bool contains(std::uint32_t mesh) const { return first <= mesh && mesh <= last; }
    bool is_only(std::uint32_t mesh) const { return first == mesh && last == mesh; }
    bool empty() const { return first > last; }
};

/// A tile's receivers by cell: rows along u, one after another.
class receiver_cells {
  public:
    /// @param batches      that the receivers come from
    /// @param lower, size  of the tile
    void sort(std::span<const receiver> from, std::span<const points> batches, const glm::vec2& lower,
              const glm::vec2& size) {
        const std::size_t count = from.size();
        int side = 1;
        while (side < max_rows && static_cast<std::size_t>(side * side) * receivers_per_two_cells < count) side *= 2;
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
        place.resize(room);
        for (auto* array : {&mesh, &triangle, &lit_mesh, &limit_}) array->resize(room);
        is_limited_ = false;
        lit_ = facing_away_ = {};
        next_.clear();
        next_.append(starts_);
        for (std::size_t i = 0; i < count; ++i) {
            const receiver& r = from[i];
            const std::size_t at = next_[keys_[i]]++;
            u[at] = r.u;
            v[at] = r.v;
            height[at] = r.height;
            place[at] = r.place;
            mesh[at] = r.mesh;
            triangle[at] = r.triangle;
            const points& batch = batches[r.place.batch()];
            limit_[at] = batch.casters;
            is_limited_ = is_limited_ || batch.casters != invalid_id;
            lit_mesh[at] = batch.face_light ? r.mesh : invalid_id;
            (batch.face_light ? lit_ : facing_away_).include(r.mesh);
        }
        for (std::size_t i = count; i < room; ++i) u[i] = v[i] = height[i] = 0;
        caster.assign(room, unblocked);
    }

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    const glm::vec2& lower() const { return lower_; }
    const glm::vec2& scale() const { return scale_; }  ///< cells per unit
    const glm::vec2& cell() const { return cell_; }
    float lowest() const { return lowest_; }
    float highest() const { return highest_; }
    std::size_t size() const { return keys_.size(); }
    /// No coordinate u or v is larger.
    float largest() const { return largest_; }
    /// Whether all lie where a caster faces the light.
    bool are_on_lit_side(std::uint32_t number) const { return facing_away_.empty() && lit_.is_only(number); }
    /// Whether some may lie where a caster faces away from the light.
    bool may_be_on_back_side(std::uint32_t number) const { return facing_away_.contains(number); }
    /// Excludes unblocked receivers from tests against this caster and later ones, by their limit (points::casters).
    void exclude_from(std::uint32_t casters) {
        if (!is_limited_) return;
        for (std::size_t i = 0; i < size(); ++i)
            if (limit_[i] <= casters && caster[i] == unblocked) caster[i] = excluded;
    }
    static constexpr std::int32_t unblocked = -1, excluded = -2;
    /// Receivers of the cells [first, last] of a row lie from start(row, first) up to start(row, last + 1).
    std::uint32_t start(int row, int column) const {
        return starts_[static_cast<std::size_t>(row * columns_ + column)];
    }

    dynamic_array<float> u, v, height;  ///< in the order of cells, with room for one more vector
    dynamic_array<batch_index> place;
    dynamic_array<std::uint32_t> mesh, triangle;
    dynamic_array<std::uint32_t> lit_mesh;  ///< the mesh of a point whose facet faces the light, or invalid_id
    dynamic_array<std::int32_t> caster;     ///< that blocks it, or unblocked, or excluded

  private:
    static constexpr int max_rows = 128;
    static constexpr std::size_t receivers_per_two_cells = 2;  // upper bound of the mean, until there are max_rows rows
    static constexpr std::size_t padding = 16;

    int column(float at) const { return numeric::clamped_index((at - lower_.x) * scale_.x, columns_); }
    int row(float at) const { return numeric::clamped_index((at - lower_.y) * scale_.y, rows_); }

    int columns_ = 1, rows_ = 1;
    glm::vec2 lower_{0}, scale_{1}, cell_{1};
    float lowest_ = 0, highest_ = 0, largest_ = 0;
    bool is_limited_ = false;
    mesh_range lit_, facing_away_;  ///< meshes of points that face the light, and of those that face away
    dynamic_array<std::uint32_t> starts_, next_, limit_;
    dynamic_array<std::uint16_t> keys_;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
