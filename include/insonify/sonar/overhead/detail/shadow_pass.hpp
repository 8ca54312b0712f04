// From a shadow policy to the shadows in a picture: the points of each tile are found and tested, and pixels lose the
// light that does not arrive. Labels name the caster.
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

/// Pixels from what they show without the light, how much of it arrives and what it makes of them.
struct lit_row_kernel {
    const float *rest, *share;
    float* value;  ///< in: what the light alone makes of a pixel; out: all of it
    std::size_t count;

    template <int N>
    INSONIFY_INLINE void run() const {
        std::size_t i = 0;
        for (; i + N <= count; i += N) light<N>(i);
        for (; i < count; ++i) light<1>(i);
    }

  private:
    template <int N>
    INSONIFY_INLINE void light(std::size_t i) const {
        lanes<float, N> dark, lit, direct;
        load(dark, rest + i);
        load(lit, share + i);
        load(direct, value + i);
        const lanes<float, N> sum = dark + lit * direct;
        store(value + i, lanes<float, N>(sum < 1.0f ? sum : lanes<float, N>{} + 1.0f));
    }
};

/// Shadows of one picture.
template <class Labels>
class shadow_pass {
  public:
    /// @param ids      the visibility buffer of the surfaces
    /// @param rest     what pixels show without the light
    /// @param picture  what the light alone makes of them; becomes both together
    /// @param targets  casters numbered below this are targets
    shadow_pass(const overhead_geometry& view, const std::vector<surface>& surfaces, const image<std::uint32_t>& ids,
                image<float>& rest, image<float>& picture, Labels& marks, std::size_t targets, int tile, isa level)
        : view_(view),
          surfaces_(surfaces),
          ids_(ids),
          rest_(rest),
          image_(picture),
          labels_(marks),
          targets_(static_cast<std::uint32_t>(targets)),
          tile_(tile),
          level_(level) {}

    /// Tests the points of every tile and puts out the light of those that are in shadow. Occlusion that sees all
    /// points at once gets those of all tiles before any is finished.
    template <class Occlusion, executor E>
    void cast(const Occlusion& occlusion, E& ex) {
        std::vector<point_finder> finders;
        for (const surface& s : surfaces_) finders.emplace_back(view_, s);
        known_.resize(surfaces_.size());
        if constexpr (shadow::triangle_occlusion<Occlusion>)
            for (std::size_t i = 0; i < surfaces_.size(); ++i) {
                // Of a mesh much finer than the picture, points are fewer than triangles.
                const bool is_worth_it = surfaces_[i].mesh.triangles.size() <= 2 * image_.size();
                if (is_worth_it) known_[i] = occlusion.known_triangles(surfaces_[i].caster, view_.eye(), ex);
            }
        constexpr bool is_collective = shadow::collective_occlusion<Occlusion>;
        constexpr std::size_t run = 4;  // tiles share their memory
        const std::size_t pixels = static_cast<std::size_t>(tile_) * static_cast<std::size_t>(tile_);
        const std::size_t count = tiles().count(), room = run * pixels;
        // What screening leaves, run by run.
        const std::size_t runs = is_collective ? (count + run - 1) / run : 0;
        point_arrays rest_of_points(runs * room, memory_of(ex));
        uninitialized_vector<float> direct(runs * room, memory_of(ex));
        std::vector<point_list> pending(runs);
        bulk_ranges(ex, count, run, [&](std::size_t first, std::size_t last) {
            point_arrays arrays(pixels);
            light_arrays light(pixels);
            std::vector<float> lit(pixels);
            if constexpr (is_collective) pending[first / run] = point_list(rest_of_points, first / run * room, room);
            for (std::size_t i = first; i < last; ++i) {
                const rect box = tile_box(i);
                point_list points(arrays, 0, pixels);
                find_points(finders, box, lit, points);
                const shadow::shares shares = light.part(0, points.size());
                point_batches(points, shares, targets_).for_each([&](const shadow::points& p, const shadow::shares& s) {
                    if constexpr (is_collective)
                        occlusion.screen(p, s);
                    else
                        occlusion.test(p, s);
                });
                if constexpr (is_collective) {
                    point_list& later = pending[first / run];
                    for (std::size_t k = 0; k < points.size(); ++k) {
                        if (shares.lit[k] != shadow::unknown) continue;
                        const std::uint32_t pixel = pixel_in(box, points.pixel(k));
                        later.add(points, k, pixel);
                        if (k < points.facing) {
                            direct[first / run * room + later.facing - 1] = image_.pixels()[pixel];
                            shares.lit[k] = 0;
                        }
                    }
                }
                finish(box, points, shares, lit);
            }
        });
        if constexpr (is_collective) {
            light_arrays light(runs * room, memory_of(ex));
            std::vector<shadow::points> at;
            std::vector<shadow::shares> into;
            for (std::size_t i = 0; i < runs; ++i)
                point_batches(pending[i], light.part(i * room, pending[i].size()), targets_)
                    .for_each([&](const shadow::points& p, const shadow::shares& s) {
                        at.push_back(p);
                        into.push_back(s);
                    });
            occlusion.test(std::span<const shadow::points>(at), std::span<const shadow::shares>(into), ex);
            ex.bulk(runs, [&](std::size_t i) {
                const shadow::shares shares = light.part(i * room, pending[i].size());
                for (std::size_t k = 0; k < pending[i].facing; ++k) {
                    float& value = image_.pixels()[pending[i].pixel(k)];
                    value =
                        (std::min)(1.0f, rest_.pixels()[pending[i].pixel(k)] + shares.lit[k] * direct[i * room + k]);
                }
                if constexpr (labelled) label_shadows(pending[i], shares, [&](std::size_t pixel) { return pixel; });
            });
        }
    }

  private:
    static constexpr bool labelled = std::is_same_v<Labels, labels>;

    tile_grid tiles() const {
        return {image_.width(), image_.height(), std::countr_zero(static_cast<unsigned>(tile_))};
    }
    rect tile_box(std::size_t i) const { return tiles().pixels(i, image_.width(), image_.height()); }

    /// A tile's pixel, counted from its first, as one of the picture's.
    std::uint32_t pixel_in(const rect& box, std::size_t pixel) const {
        const auto width = static_cast<std::size_t>(box.width());
        return static_cast<std::uint32_t>((static_cast<std::size_t>(box.y0) + pixel / width) *
                                              static_cast<std::size_t>(image_.width()) +
                                          static_cast<std::size_t>(box.x0) + pixel % width);
    }

    /// The points of a tile that matter: where there is light to lose, or all for the sake of labels. Pixels of
    /// triangles of which all is known get their share of light at once. Neighbours' answers are as good as random, so
    /// the loop does without branches.
    void find_points(std::span<const point_finder> finders, const rect& box, std::span<float> lit, point_list& into) {
        const auto width = static_cast<std::size_t>(box.width()), height = static_cast<std::size_t>(box.height());
        struct pixels_of_surface {
            uninitialized_vector<shown_pixel> room;
            std::size_t count = 0;
        };
        std::vector<pixels_of_surface> lists(surfaces_.size());
        const surface* last = nullptr;
        const shadow::known* known = nullptr;  // of the triangles of that
        pixels_of_surface* to = nullptr;
        std::uint32_t first_id = 0, ids_of_last = 0;
        for (std::size_t row = 0; row < height; ++row) {
            const int y = box.y0 + static_cast<int>(row);
            const std::uint32_t* const ids = &ids_(box.x0, y);
            float *const direct = &image_(box.x0, y), *const rest = &rest_(box.x0, y);
            float* const share = lit.data() + row * width;
            for (std::size_t x = 0; x < width; ++x) {
                if (ids[x] - first_id >= ids_of_last) {
                    if (ids[x] == shadow::invalid_id) {
                        share[x] = direct[x] = rest[x] = 0;
                        continue;
                    }
                    last = &surface_of(surfaces_, ids[x]);
                    first_id = last->first_id;
                    ids_of_last = static_cast<std::uint32_t>(last->mesh.triangles.size());
                    const auto number = static_cast<std::size_t>(last - surfaces_.data());
                    known = known_[number].empty() ? nullptr : known_[number].data();
                    to = &lists[number];
                    if (to->room.empty()) to->room.resize(width * height);
                }
                const std::uint32_t triangle = ids[x] - first_id;
                const auto answer = known != nullptr ? known[triangle] : shadow::known::nothing;
                share[x] = answer == shadow::known::lit ? 1.0f : 0.0f;
                if constexpr (labelled)
                    if (answer == shadow::known::dark)
                        labels_.shadow(box.x0 + static_cast<int>(x), y) = name_of(last->caster);
                to->room[to->count] = {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(row), triangle};
                const bool matters = labelled || direct[x] > 0;
                to->count += static_cast<std::size_t>(answer == shadow::known::nothing) & std::size_t{matters};
            }
        }
        for (std::size_t i = 0; i < lists.size(); ++i)
            if (lists[i].count > 0)
                dispatch(point_kernel{finders[i], std::span(lists[i].room).first(lists[i].count),
                                      view_.has_near_light(), labelled, box, into},
                         level_);
    }

    /// Pixels of a tile from what the light makes of them and how much of it arrives.
    /// @param lit  of the pixels that need no point
    void finish(const rect& box, const point_list& points, const shadow::shares& light, std::span<float> lit) {
        const auto width = static_cast<std::size_t>(box.width());
        for (std::size_t i = 0; i < points.facing; ++i) lit[points.pixel(i)] = light.lit[i];
        for (int y = box.y0; y < box.y1; ++y) {
            const float* const share = lit.data() + static_cast<std::size_t>(y - box.y0) * width;
            float* const value = &image_(box.x0, y);
            const float* const rest = &rest_(box.x0, y);
            dispatch(lit_row_kernel{rest, share, value, width}, level_);
        }
        if constexpr (labelled) label_shadows(points, light, [&](std::size_t pixel) { return pixel_in(box, pixel); });
    }

    /// Names the caster of each shadow, see light_pass.hpp.
    /// @param pixel_of  the picture's pixel by the list's number of it
    template <class PixelOf>
    void label_shadows(const point_list& points, const shadow::shares& light, const PixelOf& pixel_of) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const bool is_averted = i >= points.facing;
            if (!is_averted && !(light.lit[i] < 0.5f)) continue;
            const std::uint32_t caster = is_averted && light.caster[i] >= targets_ ? points.caster(i) : light.caster[i];
            // A lit share of 0 without a caster is one that is yet to be tested.
            if (caster == shadow::invalid_id) continue;
            labels_.shadow.pixels()[pixel_of(points.pixel(i))] = name_of(caster);
        }
    }
    std::uint16_t name_of(std::uint32_t caster) const {
        return caster < targets_ ? static_cast<std::uint16_t>(caster + 1) : labels::by_seabed;
    }

    const overhead_geometry& view_;
    const std::vector<surface>& surfaces_;
    const image<std::uint32_t>& ids_;
    image<float>& rest_;
    image<float>& image_;
    Labels& labels_;
    std::vector<uninitialized_vector<shadow::known>> known_;  ///< of the surfaces' triangles, where anything is
    std::uint32_t targets_;
    int tile_;
    isa level_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
