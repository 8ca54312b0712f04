// From a shadow policy to the shadows in a picture: where light is undecided, the points that pixels show are found and
// tested, tile by tile, and pixels gain the light that arrives. Labels name the caster.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/sonar/overhead/detail/light_pass.hpp>

#include <algorithm>
#include <bit>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// The object that a visibility buffer's id belongs to.
inline const surface& surface_of(const std::vector<surface>& surfaces, std::uint32_t id) {
    const auto after = std::upper_bound(surfaces.begin(), surfaces.end(), id,
                                        [](std::uint32_t i, const surface& s) { return i < s.first_id; });
    return *(after - 1);
}

/// Shadows of one picture.
template <class Labels>
class shadow_pass {
  public:
    struct images {
        const image<std::uint32_t>& ids;  ///< the visibility buffer of the surfaces, where light is undecided
        const undecided_light& undecided;
        image<float>& picture;  ///< gains the light that arrives
        Labels& marks;
    };

    /// @param targets  casters numbered below this are targets
    shadow_pass(const overhead_geometry& view, const std::vector<surface>& surfaces, const images& of,
                std::size_t targets, int tile, isa level)
        : view_(view),
          surfaces_(surfaces),
          images_(of),
          targets_(static_cast<std::uint32_t>(targets)),
          tiles_(of.picture.width(), of.picture.height(), std::countr_zero(static_cast<unsigned>(tile))),
          tile_pixels_(static_cast<std::size_t>(tile) * static_cast<std::size_t>(tile)),
          level_(level) {
        for (const surface& s : surfaces) finders_.emplace_back(view, s);
    }

    /// Tests the points of every tile and adds the light that arrives. Occlusion that sees all points at once gets
    /// those of all tiles before any is finished.
    template <class Occlusion, executor E>
    void cast(const Occlusion& occlusion, E& ex) {
        constexpr bool is_collective = shadow::collective_occlusion<Occlusion>;
        const std::size_t count = tiles_.count(), run = (std::min)(tiles_.run(), most_points / tile_pixels_),
                          runs = (count + run - 1) / run;
        std::vector<point_batch> left;  // by screening
        if constexpr (is_collective)
            for (std::size_t i = 0; i < 2 * runs; ++i) left.emplace_back(memory_of(ex));
        bulk_ranges(ex, count, run, [&](std::size_t first, std::size_t last) {
            scratch room(surfaces_.size(), tile_pixels_);
            for (std::size_t i = first; i < last; ++i) {
                const rect box = tiles_.pixels(i, images_.picture.width(), images_.picture.height());
                point_list points(room.points);
                find_points(box, room, points);
                const shadow::shares shares = room.light.part(0, points.size());
                for_each_batch(points, shares, targets_, [&](const shadow::points& p, const shadow::shares& s) {
                    if constexpr (is_collective)
                        occlusion.screen(p, s);
                    else
                        occlusion.test(p, s);
                });
                if constexpr (is_collective) keep_unknown(points, shares, &left[first / run * 2]);
                finish(points, shares);
            }
        });
        if constexpr (is_collective) test_together(occlusion, left, ex);
    }

  private:
    static constexpr bool labelled = std::is_same_v<Labels, labels>;
    static constexpr std::size_t most_points = 65536;  // of a batch

    /// Memory that the tiles of a run share.
    struct scratch {
        point_batch points;
        light_arrays light;
        std::vector<std::vector<shown_pixel>> shown;  ///< by surface

        scratch(std::size_t surfaces, std::size_t pixels) : points(pixels), light(pixels), shown(surfaces) {}
    };

    /// The points of a tile whose light is undecided.
    void find_points(const rect& box, scratch& room, point_list& into) {
        const surface* last = surfaces_.data();
        for (int y = box.y0; y < box.y1; ++y)
            images_.undecided.marks.for_each(box.x0, box.x1, y, [&](int x) {
                const std::uint32_t id = images_.ids(x, y);
                if (id - last->first_id >= last->mesh.triangles.size()) last = &surface_of(surfaces_, id);
                room.shown[static_cast<std::size_t>(last - surfaces_.data())].push_back(
                    {static_cast<std::uint16_t>(x - box.x0), static_cast<std::uint16_t>(y - box.y0),
                     id - last->first_id});
            });
        for (std::size_t i = 0; i < finders_.size(); ++i) {
            if (room.shown[i].empty()) continue;
            dispatch(point_kernel{finders_[i], room.shown[i], view_.has_near_light(), labelled, box,
                                  static_cast<std::uint32_t>(images_.picture.width()), into},
                     level_);
            room.shown[i].clear();
        }
    }

    /// Keeps the points that screening leaves.
    /// @param into  those that face the light, and the others
    static void keep_unknown(const point_list& points, const shadow::shares& light, point_batch* into) {
        const std::span<const float> lit = light.lit;
        const auto keep = [&](std::size_t first, std::size_t last, point_batch& batch) {
            std::size_t to = batch.x.size();
            const auto unknown = std::count(lit.data() + first, lit.data() + last, shadow::unknown);
            batch.resize(to + static_cast<std::size_t>(unknown));
            for (std::size_t i = first; i < last; ++i)
                if (lit[i] == shadow::unknown) points.copy(i, batch, to++);
        };
        keep(0, points.facing, into[0]);
        keep(points.facing, points.size(), into[1]);
    }

    /// @param left  of each run, those that face the light and the others
    template <class Occlusion, executor E>
    void test_together(const Occlusion& occlusion, std::span<const point_batch> left, E& ex) {
        std::vector<shadow::points> at;
        std::size_t count = 0;
        for (std::size_t i = 0; i < left.size(); ++i) {
            at.push_back(batch(left[i].all(), i % 2 == 0, targets_));
            count += at.back().size();
        }
        light_arrays light(count, memory_of(ex));
        std::vector<shadow::shares> into;
        count = 0;
        for (const shadow::points& p : at) {
            into.push_back(light.part(count, p.size()));
            count += p.size();
        }
        occlusion.test(std::span<const shadow::points>(at), std::span<const shadow::shares>(into), ex);
        ex.bulk(left.size(), [&](std::size_t i) {
            for (std::size_t k = 0; k < into[i].size(); ++k)
                finish(left[i].pixel[k], i % 2 == 0, left[i].mesh[k], into[i].lit[k], into[i].caster[k]);
        });
    }

    void finish(const point_list& points, const shadow::shares& light) {
        for (std::size_t i = 0; i < points.size(); ++i)
            finish(points.pixel(i), i < points.facing, points.caster(i), light.lit[i], light.caster[i]);
    }
    /// Adds the light that arrives at a pixel, and names the caster of its shadow, see light_pass.hpp.
    /// @param own     caster that it lies on
    /// @param caster  that blocks its light
    void finish(std::size_t pixel, bool is_facing, std::uint32_t own, float lit, std::uint32_t caster) {
        if (is_facing && lit > 0.0f) {
            float& value = images_.picture.pixels()[pixel];
            value = (std::min)(1.0f, value + lit * images_.undecided.direct.pixels()[pixel]);
        }
        if constexpr (labelled) {
            if (is_facing && !(lit < 0.5f)) return;
            if (!is_facing && caster >= targets_) caster = own;
            // Without a caster, it is yet to be tested.
            if (caster != shadow::invalid_id) images_.marks.shadow.pixels()[pixel] = name_of_caster(caster, targets_);
        }
    }

    const overhead_geometry& view_;
    const std::vector<surface>& surfaces_;
    std::vector<point_finder> finders_;  ///< of the surfaces
    images images_;
    std::uint32_t targets_;
    tile_grid tiles_;
    std::size_t tile_pixels_;
    isa level_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
