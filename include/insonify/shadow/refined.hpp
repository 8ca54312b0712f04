// Hard shadows with the edges of the casters themselves: a map says who stands in the light near a point, and where its
// texels disagree about the point, the triangles that they name are asked.
//
// A ray towards the light that leaves the outside of something solid enters through a side that faces away from the
// light. So for solids only those sides are drawn into the map: half of the triangles, and no lit surface is ever
// compared with itself, which needs no bias.
#pragma once

#include <insonify/core/lanes.hpp>
#include <insonify/raster/draw.hpp>
#include <insonify/shadow/map.hpp>

#include <memory>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // wide vectors stay inside always-inlined code
#endif

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::shadow {

/// One mesh as a caster: for every ray of a grid of them the height of what it meets first, and which triangle that is.
class caster_map {
  public:
    /// Casts nothing.
    caster_map() : frame_(directional_light{}) {}

    /// @param frame     of the light
    /// @param m         the mesh, which has to outlive the map
    /// @param to_world  from the mesh's frame to the one in which the light is described
    /// @param is_solid  nothing that can be asked about lies inside or below it
    /// @param extent    which rays, and between which heights
    /// @param texel     metres, the same along u and v; grows if more than `largest` texels a side were needed
    /// @throws invalid_input as height_map does
    template <executor E>
    caster_map(const light_frame& frame, const mesh& m, const affine& to_world, bool is_solid, const map_extent& extent,
               double texel, int largest, E& ex)
        : frame_(frame), mesh_(&m), grid_(extent, texel, largest) {
        if (grid_.empty()) return;
        const std::size_t width = pitch(), height = static_cast<std::size_t>(grid_.rows) + 2;
        heights_ = std::make_unique_for_overwrite<float[]>(width * height);
        names_ = std::make_unique_for_overwrite<std::uint32_t[]>(width * height);
        // A frame of empty texels around it all saves asking whether a neighbour is on the map.
        const float nothing = empty_depth(keep_depth::larger);
        std::fill_n(heights_.get(), width, nothing);
        std::fill_n(heights_.get() + (height - 1) * width, width, nothing);
        for (std::size_t row = 1; row + 1 < height; ++row)
            heights_[row * width] = heights_[(row + 1) * width - 1] = nothing;

        const double texels = 1 / grid_.texel;
        const glm::dvec2& travel = frame.travel();
        to_map_[0] = glm::vec3(texels * glm::dvec3(travel.x, travel.y, frame.cot_elevation()));
        to_map_[1] = glm::vec3(texels * glm::dvec3(-travel.y, travel.x, 0));
        to_map_[2] = {0, 0, static_cast<float>(1 / grid_.relief)};
        start_ = glm::vec3(0.5 - texels * grid_.origin.x, 0.5 - texels * grid_.origin.y, -grid_.floor / grid_.relief);

        to_light_.offset = frame(to_world.offset);
        for (int i = 0; i < 3; ++i)
            to_light_.linear[i] = frame(to_world.offset + to_world.linear[i]) - to_light_.offset;

        const bool mirrored = numeric::determinant(to_world.linear) < 0;
        const cull_mode lit_side = mirrored ? cull_mode::front : cull_mode::back;  // see map_grid::placing
        insonify::detail::draw_names(
            m, grid_.placing(frame, to_world),
            image_view<float>(heights_.get() + width + 1, grid_.columns, grid_.rows,
                              static_cast<std::ptrdiff_t>(width)),
            image_view<std::uint32_t>(names_.get() + width + 1, grid_.columns, grid_.rows,
                                      static_cast<std::ptrdiff_t>(width)),
            {.cull = is_solid ? lit_side : cull_mode::none, .keep = keep_depth::larger, .load = depth_load::clear}, ex);
    }

    bool empty() const { return grid_.empty(); }

    /// Marks which of the `asked` points are dark; positions are in the frame in which the light is described.
    template <int N>
    INSONIFY_INLINE void darken(insonify::detail::lanes<std::int32_t, N>& dark,
                                const insonify::detail::lanes<std::int32_t, N>& asked,
                                const insonify::detail::lanes<float, N> (&position)[3]) const {
        using namespace insonify::detail;
        using ints = lanes<std::int32_t, N>;
        using floats = lanes<float, N>;
        dark = ints{};
        if (empty()) return;
        // Continuous texels from the outer frame's first centre, so the four around a point are those of its floor and
        // one on.
        const floats& x = position[0];
        const floats& y = position[1];
        const floats& z = position[2];
        const floats column = x * to_map_[0].x + y * to_map_[0].y + z * to_map_[0].z + start_.x;
        const floats row = x * to_map_[1].x + y * to_map_[1].y + start_.y;
        const floats height = z * to_map_[2].z + start_.z;
        const ints on_map = asked & ints(column >= 0.0f) & ints(column < static_cast<float>(grid_.columns + 1)) &
                            ints(row >= 0.0f) & ints(row < static_cast<float>(grid_.rows + 1));
        if (!any(on_map)) return;
        ints first_column, first_row;
        convert(first_column, floats(on_map ? column : floats{}));
        convert(first_row, floats(on_map ? row : floats{}));
        const auto width = static_cast<std::int32_t>(pitch());
        const ints first = first_row * width + first_column;
        floats h[4];
        const float* const heights = heights_.get();
        gather_pairs<N>(h[0], h[1], [&](int k) { return heights + lane(first, k); });
        gather_pairs<N>(h[2], h[3], [&](int k) { return heights + lane(first, k) + width; });
        floats low = h[0], high = h[0];
        for (int i = 1; i < 4; ++i) {
            low = h[i] < low ? h[i] : low;
            high = h[i] > high ? h[i] : high;
        }
        // All four below by more than they differ, or above by as much: that is how far a surface may go on changing.
        // Nothing is minus infinity: beside something, it makes the difference infinite.
        const floats spread = high - low;
        const ints is_lit = ints(height > high + spread) | ints(high < 0.0f);
        const ints is_dark = ints(height < low - spread);
        dark = on_map & is_dark;
        const ints doubtful = on_map & ints(ints(is_lit | is_dark) == 0);
        if (!any(doubtful)) return;
        for (int k = 0; k < N; ++k)
            if (lane(doubtful, k) != 0) {
                const glm::dvec3 uvz = frame_(glm::dvec3(lane(x, k), lane(y, k), lane(z, k)));
                const bool behind = is_behind_one_of(static_cast<std::size_t>(lane(first, k)), uvz);
                set_lane(dark, k, behind ? std::int32_t{-1} : std::int32_t{0});
            }
    }

  private:
    std::size_t pitch() const { return static_cast<std::size_t>(grid_.columns) + 2; }

    /// Asks the triangles that the four texels from `first` on name. One that covers the point decides if it is above.
    /// Else the point lies between them, inside of a surface if all four pass above; or at its edge, where triangles
    /// are thin under grazing light and may have met no texel's centre: there their neighbours in the mesh are asked
    /// too.
    INSONIFY_RARE bool is_behind_one_of(std::size_t first, const glm::dvec3& uvz) const {
        const std::size_t texels[] = {first, first + 1, first + pitch(), first + pitch() + 1};
        int above = 0;
        bool is_above = false;
        std::uint32_t asked = insonify::detail::tile_buffer<true>::nobody;
        for (const std::size_t texel : texels) {
            if (!(heights_[texel] >= 0)) continue;
            if (names_[texel] != asked) {
                asked = names_[texel];
                const sight s = seen_from(asked, uvz);
                if (s.is_behind()) return true;
                is_above = s.above > 0;
            }
            above += is_above ? 1 : 0;
        }
        if (above == 0 || above == 4) return above == 4;

        // Meshes are mostly written such that neighbours come after one another.
        constexpr std::uint32_t reach = 4;
        const auto last = static_cast<std::uint32_t>(mesh_->triangles.size() - 1);
        asked = insonify::detail::tile_buffer<true>::nobody;
        for (const std::size_t texel : texels) {
            if (!(heights_[texel] >= 0) || names_[texel] == asked) continue;
            asked = names_[texel];
            const std::uint32_t before = asked - (std::min)(asked, reach), after = (std::min)(last - asked, reach);
            for (std::uint32_t t = before; t <= asked + after; ++t)
                if (seen_from(t, uvz).is_behind()) return true;
        }
        return false;
    }

    /// A triangle as the light sees it at a point.
    struct sight {
        bool covered;
        double above;  ///< metres from the point up to the triangle's plane

        bool is_behind() const { return covered && above > 1e-6; }
    };
    sight seen_from(std::uint32_t triangle, const glm::dvec3& uvz) const {
        const glm::uvec3& index = mesh_->triangles[triangle];
        glm::dvec3 corner[3];
        for (int i = 0; i < 3; ++i) corner[i] = transform_point(to_light_, mesh_->positions[index[i]]) - uvz;
        const auto share = [](const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.y - a.y * b.x; };
        const double a = share(corner[1], corner[2]), b = share(corner[2], corner[0]), c = share(corner[0], corner[1]);
        const bool covered = (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
        return {covered, (a * corner[0].z + b * corner[1].z + c * corner[2].z) / (a + b + c)};
    }

    light_frame frame_;
    const mesh* mesh_ = nullptr;
    affine to_light_;  ///< from the mesh to (u, v, z)
    map_grid grid_;
    glm::vec3 to_map_[3], start_;             ///< from positions to column, row and height
    std::unique_ptr<float[]> heights_;        ///< with the frame of empty texels
    std::unique_ptr<std::uint32_t[]> names_;  ///< the same texels
};

}  // namespace insonify::inline INSONIFY_ABI::shadow

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

INSONIFY_ARITHMETIC_END
