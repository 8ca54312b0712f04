// Exact hard shadows: each point is tested against each triangle that can block its light.
//
// Casters and points are projected along the light's rays onto a plane (detail/light_planes.hpp), which is cut into
// tiles (detail/tiled_plane.hpp). `build` bins triangles into the tiles that they touch; `test` sorts points into the
// cells of a tile, and each triangle is tested against the points under it (detail/occlusion_kernel.hpp). The cost is
// the number of such pairs, linear in triangles and points for meshes of small triangles. There is no resolution and no
// bias.
//
// Results are those of one test in doubles (detail/light_rays.hpp), for any mesh: open, closed, self-intersecting or
// inside out. Only points exactly on an edge where a caster turns away from the light may differ (shadow::skip).
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/shadow/detail/grid_caster.hpp>
#include <insonify/shadow/detail/light_rays.hpp>
#include <insonify/shadow/detail/occlusion_kernel.hpp>
#include <insonify/shadow/detail/points_by_tile.hpp>
#include <insonify/shadow/detail/tiled_plane.hpp>

#include <optional>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow {

inline namespace INSONIFY_FLAGS {

/// Casters that block one light, as `exact` builds them.
class exact_occlusion {
  public:
    /// See casting_policy.
    /// @throws invalid_input for an index without a position, a directional light out of range (see light_frame), or a
    ///         point light that is not finite
    template <executor E>
    exact_occlusion(std::span<const caster> casters, const any_light& light, const point_bounds& where, E& ex)
        : casters_(casters),
          level_(where.level),
          rays_(light, reach_of(where.box)),
          planes_(light),
          grids_(casters.size()) {
        std::size_t triangles = 0;
        for (const caster& c : casters_) triangles += c.mesh.triangles.size();
        if (triangles == 0 || where.box.empty()) return;
        int side = 16;  // at least 16 x 16 tiles, so that a small caster shares few tiles with others
        while (side < 64 && static_cast<std::size_t>(side * side) * 1024 < triangles) side *= 2;
        if (const auto* parallel = std::get_if<directional_light>(&light))
            add_parallel_plane(light_frame(*parallel), where.box, side, ex);
        else
            add_point_planes(std::get<point_light>(light), where.box, side, ex);
    }

    /// See light_rays::toward.
    glm::dvec3 toward(const glm::dvec3& p) const { return rays_.toward(p); }

    /// See collective_occlusion.
    void screen(const points& at, const results& into) const {
        std::fill(into.caster.begin(), into.caster.end(), invalid_id);
        if (planes_.empty()) return std::fill(into.lit.begin(), into.lit.end(), 1.0f);
        if (planes_.has_point_light()) return std::fill(into.lit.begin(), into.lit.end(), unknown);
        for (std::size_t first = 0, last = 0; first < at.size(); first = last) {
            const std::size_t end = (std::min)(first + screened_together, at.size());
            for (last = first + 1; last < end && at.mesh[last] == at.mesh[first];) ++last;
            screen(at, first, last, into);
        }
    }

    /// See triangle_occlusion.
    /// @param eye  position of the camera
    template <executor E>
    insonify::detail::uninitialized_array<decision> decide_triangles(std::uint32_t caster, const glm::dvec3& eye,
                                                                     E& ex) const {
        if (caster >= grids_.size() || !grids_[caster]) return {};
        const shadow::caster& c = casters_[caster];
        const detail::lit_grid& grid = grids_[caster]->grid();
        const detail::horizon_triangles triangles = grids_[caster]->triangles(eye);
        insonify::detail::uninitialized_array<decision> decisions(c.mesh.triangles.size(),
                                                                  insonify::detail::memory_of(ex));
        // Triangles that other casters may shade are left to the test of points.
        detail::dynamic_array<insonify::detail::ground_rect> shared;
        const detail::tiled_plane& plane = planes_.front();
        const detail::mesh_plane_intercepts intercepts(plane.plane, c.placement, grid);
        for (std::size_t tile = 0; tile < plane.tiles.count(); ++tile) {
            if (plane.casters_of_tiles.only(tile) == caster || plane.casters_of_tiles.of(tile).empty()) continue;
            shared.push_back(intercepts.of(plane.tiles.lower + plane.tiles.corner(tile), plane.tiles.tile()));
        }
        bulk_ranges(ex, static_cast<std::size_t>(grid.columns - 1), 32, [&](std::size_t first, std::size_t last) {
            const auto left = static_cast<int>(first), right = static_cast<int>(last);
            triangles.classify(left, right, decisions.data(), level_);
            for (const auto& [lower, upper] : shared)
                triangles.reset_to_undecided(lower, upper, left, right, decisions.data());
        });
        return decisions;
    }

    /// See occlusion.
    void test(const points& at, const results& into) const {
        serial_executor serial;
        detail::dynamic_array<points> parts;
        detail::dynamic_array<results> into_parts;
        for (std::size_t first = 0; first < at.size(); first += max_batch) {
            const std::size_t count = (std::min)(max_batch, at.size() - first);
            parts.push_back({at.x.subspan(first, count), at.y.subspan(first, count), at.z.subspan(first, count),
                             at.mesh.subspan(first, count), at.triangle.subspan(first, count), at.casters,
                             at.face_light});
            into_parts.push_back({into.lit.subspan(first, count), into.caster.subspan(first, count)});
        }
        test(std::span<const points>(parts), std::span<const results>(into_parts), serial);
    }

    /// The same for at most `max_batches` batches of at most `max_batch` points each.
    template <executor E>
    void test(std::span<const points> at, std::span<const results> into, E& ex) const {
        const detail::points_by_tile sorted(planes_, at, into, ex);
        bulk_ranges(ex, planes_.tile_count(), 4, [&](std::size_t first, std::size_t last) {
            detail::receiver_cells cells;
            insonify::detail::uninitialized_array<detail::receiver> own;
            for (std::size_t tile = first; tile < last; ++tile) {
                sorted.collect(tile, own);
                if (!own.empty()) test_tile(tile, own, cells, at, into);
            }
        });
    }

  private:
    /// Upper bound of the absolute coordinates of points. Casters may reach farther.
    static double reach_of(const bounding_box& bounds) {
        double reach = 0;
        for (int i = 0; i < 3 && !bounds.empty(); ++i) reach = (std::max)({reach, -bounds.lower[i], bounds.upper[i]});
        return reach;
    }
    /// Whether a caster is a grid lit from above its own plane: then horizon bounds replace its list of triangles.
    /// Checked for each sample of a wide light, since some may lie below that plane. Bounds take memory for columns x
    /// (rows + slope columns): strips for which that is more than five times the vertices are left to the list.
    static bool has_horizon(const caster& c, const light_frame& frame) {
        if (c.grid == nullptr || c.may_skip != skip::facing_self) return false;
        const glm::dvec3 travel = transform_direction(inverse(c.placement), -frame.to_light());
        if (!(travel.z < 0)) return false;
        const detail::lit_grid lit(*c.grid, travel);
        return lit.slope * lit.columns <= 4.0 * lit.rows;
    }
    static constexpr std::size_t screened_together = 256;
    /// Screens points of one mesh, of parallel light.
    void screen(const points& at, std::size_t first, std::size_t last, const results& into) const {
        const std::uint32_t own = at.mesh[first];
        const bool is_grid = own < grids_.size() && grids_[own];
        decision decisions[screened_together];
        std::fill_n(decisions, last - first, decision::undecided);
        if (is_grid && at.face_light) grids_[own]->decide_own_points(at, first, last, decisions, level_);
        const detail::tiled_plane& state = planes_.front();
        for (std::size_t i = first; i < last; ++i) {
            const std::uint32_t only = state.casters_of_tiles.only(state.tile_of(state.plane(at[i])));
            into.lit[i] = unknown;
            if (only == detail::tile_casters::none || (only != detail::tile_casters::several && only >= at.casters)) {
                into.lit[i] = 1;
            } else if (only == own && is_grid) {
                const decision decided = decisions[i - first];
                const bool is_dark =
                    decided == decision::undecided ? is_blocked_by_grid(own, at, i) : decided == decision::dark;
                into.lit[i] = is_dark ? 0.0f : 1.0f;
                into.caster[i] = is_dark ? own : invalid_id;
            }
        }
    }
    /// Whether caster `number` blocks the light of a point.
    bool is_blocked_by_grid(std::uint32_t number, const points& at, std::size_t i) const {
        const bool is_own = at.mesh[i] == number;
        const auto decide = [&](std::uint32_t triangle) {
            return !(is_own && at.triangle[i] == triangle) && is_blocked_by(number, triangle, at[i]);
        };
        return grids_[number]->blocks(at[i], is_own && at.face_light, decide);
    }
    bool is_blocked_by(std::uint32_t number, std::uint32_t triangle, const glm::dvec3& p) const {
        const caster& c = casters_[number];
        const glm::uvec3& t = c.mesh.triangles[triangle];
        const auto corner = [&](int j) { return transform_point(c.placement, glm::dvec3(c.mesh.positions[t[j]])); };
        return rays_.blocks(corner(0), corner(1), corner(2), p);
    }
    /// Builds the grids' horizons, and the plane of parallel light: the datum in its sheared frame.
    template <executor E>
    void add_parallel_plane(const light_frame& frame, const bounding_box& bounds, int side, E& ex) {
        for (std::size_t i = 0; i < casters_.size(); ++i)
            if (has_horizon(casters_[i], frame)) grids_[i].emplace(casters_[i], frame, level_, ex);
        const detail::light_plane plane(frame);
        const auto [lower, upper] = detail::extent_on(plane, [&](int i) { return bounds.corner(i); });
        add_plane(plane, {lower, upper - lower, side, side}, 0x1p-44 * reach_of(bounds) * (1 + frame.cot_elevation()),
                  0, ex);
    }
    /// Builds the planes of a point light: the six faces of a cube around it.
    template <executor E>
    void add_point_planes(const point_light& light, const bounding_box& bounds, int side, E& ex) {
        for (int i = 0; i < 6; ++i) {
            const detail::light_plane plane(light, i);
            if (!detail::may_project_onto(plane, bounds)) {
                planes_.add({});
                continue;
            }
            const auto [lower, upper] = detail::projected_extent(plane, bounds);
            add_plane(plane, {lower, upper - lower, side, side}, 0x1p-40, 0x1p-20 * reach_of(bounds), ex);
        }
    }
    /// Bins the casters' triangles into the tiles of a plane.
    template <executor E>
    void add_plane(const detail::light_plane& plane, detail::plane_tiles tiles, double error, double min_depth, E& ex) {
        const double margin = error + 0x1p-20 * (std::max)(tiles.size.x, tiles.size.y) + 1e-30;
        tiles.lower -= margin;
        tiles.size += 2 * margin;
        detail::tiled_plane state{plane, tiles, static_cast<float>(error), {}, 1.0 / tiles.tile(), {}};
        detail::dynamic_array<detail::tile_casters::covered_tile> covered;
        const auto cover = [&](int column, int row, std::size_t caster) {
            covered.push_back(
                {static_cast<std::uint32_t>(row * tiles.columns + column), static_cast<std::uint32_t>(caster)});
        };
        for (std::size_t i = 0; i < casters_.size(); ++i) {
            const caster& c = casters_[i];
            if (grids_[i]) {
                state.casters.push_back({});
                const auto [first, last] = state.tiles_under(c);
                for (int row = first.y; row <= last.y; ++row)
                    for (int column = first.x; column <= last.x; ++column) cover(column, row, i);
                continue;
            }
            insonify::detail::require_indices(c.mesh, ex);
            state.casters.push_back({c, plane, tiles, min_depth, level_, ex});
            const detail::plane_caster& built = state.casters.back();
            const rect touched = built.tiles();
            for (int row = touched.y0; row < touched.y1; ++row)
                for (int column = touched.x0; column < touched.x1; ++column)
                    if (!built.bin(column, row).empty()) cover(column, row, i);
        }
        state.casters_of_tiles = {tiles.count(), covered};
        planes_.add(std::move(state));
    }

    void test_tile(std::size_t tile_number, std::span<const detail::receiver> all, detail::receiver_cells& cells,
                   std::span<const points> at, std::span<const results> into) const {
        const auto [state, tile] = planes_.plane_of(tile_number);
        cells.sort(all, at, glm::vec2(state->tiles.corner(tile)), glm::vec2(state->tiles.tile()));
        const auto row_length = static_cast<std::size_t>(state->tiles.columns);
        const auto column = static_cast<int>(tile % row_length), row = static_cast<int>(tile / row_length);
        for (const std::uint32_t number : state->casters_of_tiles.of(tile)) {
            cells.exclude_from(number);
            if (grids_[number]) {
                for (std::size_t k = 0; k < cells.size(); ++k)
                    if (cells.caster[k] == detail::receiver_cells::unblocked) {
                        const detail::batch_index place = cells.place[k];
                        if (is_blocked_by_grid(number, at[place.batch()], place.point()))
                            cells.caster[k] = static_cast<std::int32_t>(number);
                    }
                continue;
            }
            const detail::plane_caster& caster = state->casters[number];
            const shadow::caster& c = casters_[number];
            const auto decide = [&](std::uint32_t triangle, std::size_t k) {
                const detail::batch_index place = cells.place[k];
                return is_blocked_by(number, triangle, at[place.batch()][place.point()]);
            };
            insonify::detail::dispatch(
                detail::occlusion_kernel<std::remove_const_t<decltype(decide)>>{
                    caster, caster.bin(column, row), number, c.may_skip, front_is_clockwise(c, *state), state->error,
                    cells, decide},
                level_);
        }
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (cells.caster[i] < 0) continue;
            const detail::batch_index place = cells.place[i];
            into[place.batch()].lit[place.point()] = 0;
            into[place.batch()].caster[place.point()] = static_cast<std::uint32_t>(cells.caster[i]);
        }
    }

    /// Whether a triangle that faces the light is clockwise on the plane.
    static bool front_is_clockwise(const caster& c, const detail::tiled_plane& state) {
        return (numeric::determinant(c.placement.linear) < 0) != state.plane.is_mirrored();
    }

    detail::dynamic_array<caster> casters_;
    isa level_;
    detail::light_rays rays_;
    detail::tiled_planes planes_;
    detail::dynamic_array<std::optional<detail::grid_caster>> grids_;  ///< of the casters, under parallel light
};

}  // namespace INSONIFY_FLAGS

template <executor E>
exact_occlusion exact::build(std::span<const caster> casters, const any_light& light, const point_bounds& bounds,
                             E& ex) const {
    return {casters, light, bounds, ex};
}

}  // namespace shadow
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
