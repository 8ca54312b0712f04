// Applies a shadow policy to a picture: finds and tests the points of pixels whose light is undecided, tile by tile,
// adds the light that arrives to the pixels, and labels shadows with their casters.
//
// A point in several shadows has the label of the target with the lowest index, else of its own surface, if that faces
// away from the light, else of the seabed.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/image.hpp>
#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/overhead/detail/point_pass.hpp>
#include <insonify/sonar/overhead/detail/undecided_light.hpp>

#include <algorithm>
#include <bit>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// The object that a visibility buffer's id belongs to.
inline const drawn_object& object_of(const dynamic_array<drawn_object>& objects, std::uint32_t id) {
    const auto after = std::upper_bound(objects.begin(), objects.end(), id,
                                        [](std::uint32_t i, const drawn_object& s) { return i < s.first_id; });
    return *(after - 1);
}

/// Shadows of one picture.
template <class Labels>
class shadow_pass {
  public:
    struct images {
        undecided_light& undecided;
        image<float>& picture;  ///< the light that arrives is added
        Labels& labels;
    };

    /// @param targets  casters numbered below this are targets
    shadow_pass(const overhead_geometry& view, const dynamic_array<drawn_object>& objects, const images& of,
                std::size_t targets, int tile, isa level)
        : view_(view),
          objects_(objects),
          images_(of),
          targets_(static_cast<std::uint32_t>(targets)),
          tiles_(of.picture.width(), of.picture.height(), std::countr_zero(static_cast<unsigned>(tile))),
          tile_pixels_(static_cast<std::size_t>(tile) * static_cast<std::size_t>(tile)),
          grain_((std::min)(tiles_.grain(), shadow::max_batch / tile_pixels_)),
          level_(level) {
        for (const drawn_object& s : objects) frames_.push_back({view, s.placed.to_rig});
    }

    /// Tests the points of every tile and adds the light that arrives. A collective occlusion receives the points of
    /// all tiles before any tile is finished.
    template <class Occlusion, executor E>
    void cast(const Occlusion& occlusion, E& ex) {
        constexpr bool is_collective = shadow::collective_occlusion<Occlusion>;
        dynamic_array<std::size_t> undecided(is_collective ? tiles_.count() : 0);  // points of each tile
        bulk_ranges(ex, tiles_.count(), grain_, [&](std::size_t first, std::size_t last) {
            scratch room(objects_.size(), tile_pixels_);
            for (std::size_t i = first; i < last; ++i) {
                point_list points(room.points, 0, tile_pixels_);
                find_points(i, room.shown, points);
                const shadow::results light = room.light.part(0, points.size());
                for_each_batch(points, light, targets_, [&](const shadow::points& p, const shadow::results& s) {
                    if constexpr (is_collective)
                        occlusion.screen(p, s);
                    else
                        occlusion.test(p, s);
                });
                finish(points, light);
                if constexpr (is_collective) undecided[i] = mark_undecided(points, light);
            }
        });
        if constexpr (is_collective) test_together(occlusion, undecided, ex);
    }

  private:
    static constexpr bool labelled = std::is_same_v<Labels, labels>;

    using shown_by_object = dynamic_array<dynamic_array<undecided_pixel>>;
    /// Memory that the tiles of a run share.
    struct scratch {
        point_batch points;
        light_arrays light;
        shown_by_object shown;

        scratch(std::size_t objects, std::size_t pixels) : points(pixels), light(pixels), shown(objects) {}
    };

    rect pixels_of(std::size_t tile) const {
        return tiles_.pixels(tile, images_.picture.width(), images_.picture.height());
    }
    /// The points of a tile whose light is undecided.
    void find_points(std::size_t tile, shown_by_object& shown, point_list& into) {
        const drawn_object* last = objects_.data();
        images_.undecided.take(tile, [&](const undecided_pixel& p) {
            if (p.id - last->first_id >= last->placed.shape.triangles.size()) last = &object_of(objects_, p.id);
            shown[static_cast<std::size_t>(last - objects_.data())].push_back(
                {p.column, p.row, p.id - last->first_id, p.direct});
        });
        const rect pixels = pixels_of(tile);
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            if (shown[i].empty()) continue;
            dispatch(point_kernel{objects_[i], frames_[i], shown[i], view_.has_point_light(), labelled, pixels,
                                  static_cast<std::uint32_t>(images_.picture.width()), into},
                     level_);
            shown[i].clear();
        }
    }

    /// Marks the pixels that screening does not decide.
    /// @returns their number
    std::size_t mark_undecided(const point_list& points, const shadow::results& light) {
        const auto width = static_cast<std::size_t>(images_.picture.width());
        std::size_t count = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (light.lit[i] != shadow::unknown) continue;
            const std::size_t pixel = points.pixel(i);
            images_.undecided.mark(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
            ++count;
        }
        return count;
    }

    /// Tests the points of all pixels that are still marked. They are few, so their points are computed again: keeping
    /// those of the first pass would take memory for all points.
    /// @param undecided  number of points of each tile
    template <class Occlusion, executor E>
    void test_together(const Occlusion& occlusion, const dynamic_array<std::size_t>& undecided, E& ex) {
        // Each list holds the points of several tiles, more of them in larger pictures, and makes up to two batches;
        // max_batches bounds the number of batches.
        const std::size_t tiles_per_list = (std::max)(grain_, tiles_.count() / (shadow::max_batches / 2) + 1);
        dynamic_array<std::size_t> starts{0};  // of the points of each list
        for (std::size_t i = 0; i < tiles_.count(); ++i) {
            if (i % tiles_per_list == 0) starts.push_back(starts.back());
            starts.back() += undecided[i];
        }
        point_batch all(starts.back(), memory_of(ex));
        light_arrays light(starts.back(), memory_of(ex));
        dynamic_array<point_list> lists;
        for (std::size_t i = 0; i + 1 < starts.size(); ++i) lists.push_back({all, starts[i], starts[i + 1]});
        bulk_ranges(ex, tiles_.count(), tiles_per_list, [&](std::size_t first, std::size_t last) {
            shown_by_object shown(objects_.size());
            for (std::size_t i = first; i < last; ++i)
                if (undecided[i] > 0) find_points(i, shown, lists[first / tiles_per_list]);
        });
        const auto part = [&](std::size_t i) { return light.part(starts[i], lists[i].size()); };
        dynamic_array<shadow::points> at;
        dynamic_array<shadow::results> into;
        for (std::size_t i = 0; i < lists.size(); ++i)
            for_each_batch(lists[i], part(i), targets_, [&](const shadow::points& p, const shadow::results& s) {
                at.push_back(p);
                into.push_back(s);
            });
        occlusion.test(std::span<const shadow::points>(at), std::span<const shadow::results>(into), ex);
        ex.bulk(lists.size(), [&](std::size_t i) { finish(lists[i], part(i)); });
    }

    /// Adds the light that arrives at the pixels of points, and labels their shadows.
    void finish(const point_list& points, const shadow::results& light) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const std::size_t pixel = points.pixel(i);
            const bool is_facing = i < points.facing;
            if (is_facing && light.lit[i] > 0.0f) {
                float& value = images_.picture.pixels()[pixel];
                value = (std::min)(1.0f, value + light.lit[i] * points.direct(i));
            }
            if constexpr (labelled) {
                if (is_facing && !(light.lit[i] < 0.5f)) continue;
                std::uint32_t caster = light.caster[i];
                if (!is_facing && caster >= targets_) caster = points.caster(i);  // its own mesh
                // Without a caster the point is not tested yet, or the light's centre is visible.
                if (caster != shadow::invalid_id)
                    images_.labels.shadow.pixels()[pixel] = labels::of_caster(caster, targets_);
            }
        }
    }

    const overhead_geometry& view_;
    const dynamic_array<drawn_object>& objects_;
    dynamic_array<view_from_object> frames_;  ///< of the objects
    images images_;
    std::uint32_t targets_;
    tile_grid tiles_;
    std::size_t tile_pixels_;
    std::size_t grain_;  ///< tiles per call of the executor, whose points fit one batch
    isa level_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
