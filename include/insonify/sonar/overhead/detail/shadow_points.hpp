// Visible points that a shadow policy tests in batches, and its results.
#pragma once

#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/shadow/policy.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Points that pixels show, as arrays of equal length.
struct point_batch {
    uninitialized_array<double> x, y, z;
    uninitialized_array<std::uint32_t> mesh, triangle;
    uninitialized_array<std::uint32_t> pixel;  ///< of the picture
    uninitialized_array<float> direct;         ///< light that arrives there if nothing blocks it

    explicit point_batch(std::size_t count, const shared_pool& memory = {})
        : x(count, memory),
          y(count, memory),
          z(count, memory),
          mesh(count, memory),
          triangle(count, memory),
          pixel(count, memory),
          direct(count, memory) {}

    shadow::points part(std::size_t first, std::size_t n) const {
        const auto some = [&](const auto& array) { return std::span(array).subspan(first, n); };
        return {some(x), some(y), some(z), some(mesh), some(triangle)};
    }
};

/// Points that are tested for shadows, in a part of a batch: those that face the light from its front, those that face
/// away from its back.
class point_list {
  public:
    std::size_t facing = 0, facing_away = 0;

    /// @param room         the batch to fill
    /// @param first, last  the range of it for this list
    point_list(point_batch& room, std::size_t first, std::size_t last) : room_(&room), first_(first), last_(last) {}

    std::size_t size() const { return facing + facing_away; }
    shadow::points facing_points() const { return room_->part(first_, facing); }
    shadow::points points_facing_away() const { return room_->part(last_ - facing_away, facing_away); }
    /// The pixel, its light and the caster of a point; facing ones are counted first.
    std::size_t pixel(std::size_t point) const { return room_->pixel[at(point)]; }
    float direct(std::size_t point) const { return room_->direct[at(point)]; }
    std::uint32_t caster(std::size_t point) const { return room_->mesh[at(point)]; }

    INSONIFY_INLINE void add(bool is_facing, double x, double y, double z, std::uint32_t mesh, std::uint32_t triangle,
                             std::uint32_t pixel, float direct) {
        const std::size_t to = is_facing ? first_ + facing++ : last_ - ++facing_away;
        room_->x[to] = x;
        room_->y[to] = y;
        room_->z[to] = z;
        room_->mesh[to] = mesh;
        room_->triangle[to] = triangle;
        room_->pixel[to] = pixel;
        room_->direct[to] = direct;
    }

  private:
    std::size_t at(std::size_t point) const {
        return point < facing ? first_ + point : last_ - facing_away + (point - facing);
    }

    point_batch* room_;
    std::size_t first_, last_;
};

/// Memory for the results of points.
struct light_arrays {
    uninitialized_array<float> lit;
    uninitialized_array<std::uint32_t> caster;

    explicit light_arrays(std::size_t points, const shared_pool& memory = {})
        : lit(points, memory), caster(points, memory) {}
    shadow::results part(std::size_t first, std::size_t count) {
        return {std::span(lit).subspan(first, count), std::span(caster).subspan(first, count)};
    }
};

/// Calls visit(points, results) for each batch of a list: points that face the light concern all casters, those that
/// face away only need the targets, for labels.
/// @param targets  casters numbered below this are targets
template <class Visit>
void for_each_batch(const point_list& points, const shadow::results& all, std::uint32_t targets, const Visit& visit) {
    shadow::points facing = points.facing_points(), away = points.points_facing_away();
    away.casters = targets, away.face_light = false;
    if (facing.size() > 0)
        visit(facing, shadow::results{all.lit.first(points.facing), all.caster.first(points.facing)});
    if (away.size() > 0)
        visit(away, shadow::results{all.lit.subspan(points.facing), all.caster.subspan(points.facing)});
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
