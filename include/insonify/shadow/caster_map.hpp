// Hard shadows with the edges of the casters themselves: a map says who stands in the light near a point, and where its
// texels disagree about the point, the triangles that they name are asked.
//
// A ray towards the light that leaves the outside of something solid enters through a side that faces away from the
// light. So for solids only those sides are drawn into the map: half of the triangles, and no lit surface is ever
// compared with itself, which needs no bias.
#pragma once

#include <insonify/core/lanes.hpp>
#include <insonify/core/unfilled.hpp>
#include <insonify/raster/draw.hpp>
#include <insonify/shadow/map.hpp>

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
    /// @param reach     how far from the frame's origin what is asked about lies, along v and z
    /// @param texel     metres, the same along u and v; grows if more than `largest` texels a side were needed
    /// @throws invalid_input as height_map does
    template <executor E>
    caster_map(const light_frame& frame, const mesh_view& m, const affine& to_world, bool is_solid,
               const map_extent& extent, double reach, double texel, int largest, E& ex)
        : frame_(frame), mesh_(m), grid_(extent, texel, largest, stretch(frame)) {
        if (grid_.empty()) return;
        tolerance_ = static_cast<float>(0x1p-21 * reach);
        const std::size_t width = pitch(), height = static_cast<std::size_t>(grid_.rows) + 2;
        heights_.resize(width * height);
        names_.resize(width * height);
        // A frame of empty texels around it all saves asking whether a neighbour is on the map.
        const float nothing = empty_depth(keep_depth::larger);
        std::fill_n(heights_.begin(), width, nothing);
        std::fill_n(heights_.end() - static_cast<std::ptrdiff_t>(width), width, nothing);
        for (std::size_t row = 1; row + 1 < height; ++row)
            heights_[row * width] = heights_[(row + 1) * width - 1] = nothing;

        const glm::dvec2 texels = 1.0 / grid_.texel;
        const glm::dvec2& travel = frame.travel();
        to_map_[0] = glm::vec3(texels.x * glm::dvec3(travel.x, travel.y, frame.cot_elevation()));
        to_map_[1] = glm::vec3(texels.y * glm::dvec3(-travel.y, travel.x, 0));
        to_map_[2] = {0, 0, static_cast<float>(1 / grid_.relief)};
        start_ =
            glm::vec3(0.5 - texels.x * grid_.origin.x, 0.5 - texels.y * grid_.origin.y, -grid_.floor / grid_.relief);

        to_light_.offset = frame(to_world.offset);
        for (int i = 0; i < 3; ++i)
            to_light_.linear[i] = frame(to_world.offset + to_world.linear[i]) - to_light_.offset;
        axes_ = glm::mat3(to_light_.linear);

        const bool mirrored = numeric::determinant(to_world.linear) < 0;
        const cull_mode lit_side = mirrored ? cull_mode::front : cull_mode::back;  // see map_grid::placing
        insonify::detail::draw_names(
            m, grid_.placing(frame, to_world),
            image_view<float>(heights_.data() + width + 1, grid_.columns, grid_.rows,
                              static_cast<std::ptrdiff_t>(width)),
            image_view<std::uint32_t>(names_.data() + width + 1, grid_.columns, grid_.rows,
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
        const float* const heights = heights_.data();
        gather_pairs<N>(h[0], h[1], [&](int k) { return heights + lane(first, k); });
        gather_pairs<N>(h[2], h[3], [&](int k) { return heights + lane(first, k) + width; });
        floats low = h[0], high = h[0];
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA {
            low = h[i + 1] < low ? h[i + 1] : low;
            high = h[i + 1] > high ? h[i + 1] : high;
        });
        // All four below; or all four above by more than they differ, which is how far a surface may go on changing.
        // Nothing is minus infinity: beside something, it makes the difference infinite.
        const floats spread = high - low;
        const ints is_lit = (ints(height > high) & ints(low >= 0.0f)) | ints(high < 0.0f);
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
    /// How much longer than wide a texel is: low light spreads heights so far along u that it still tells them apart.
    static double stretch(const light_frame& frame) { return (std::min)((std::max)(frame.cot_elevation(), 1.0), 1.5); }

    std::size_t pitch() const { return static_cast<std::size_t>(grid_.columns) + 2; }

    /// Asks the triangles that the four texels from `first` on name. One that covers the point decides if it is above.
    /// Else, if any of their planes passes above, the point may lie between them or at an edge, where triangles are
    /// thin under grazing light and may have met no texel's centre: there their neighbours in the mesh are asked too.
    INSONIFY_RARE bool is_behind_one_of(std::size_t first, const glm::dvec3& uvz) const {
        const glm::vec3 start(to_light_.offset - uvz);
        std::uint32_t names[4];
        int count = 0;
        for (const std::size_t texel : {first, first + 1, first + pitch(), first + pitch() + 1})
            if (heights_[texel] >= 0) names[count++] = names_[texel];
        if (count == 0) return false;
        const sight named = see(start, [&](int k) { return names[(std::min)(k, count - 1)]; });
        if (named.is_behind) return true;
        if (!named.is_above) return false;

        neighbourhood around{*this, start};
        for (int i = 0; i < count; ++i)
            if (around.is_behind(names[i])) return true;
        for (int i = 0; i < count; ++i)
            if (around.is_behind(before(names[i], strip(names[i]))) ||
                around.is_behind(after(names[i], strip(names[i]))))
                return true;
        return false;
    }

    /// Four triangles, as the light sees them at a point.
    struct sight {
        bool is_behind;  ///< one of them covers the point and passes above
        bool is_above;   ///< the plane of one of them does
    };
    /// @param start  from the point to the mesh's origin, in the light's frame
    /// @param name   name(k): the triangles
    template <class Name>
    sight see(const glm::vec3& start, const Name& name) const {
        using namespace insonify::detail;
        constexpr int N = INSONIFY_SIMD ? 4 : 1;
        using floats = lanes<float, N>;
        using ints = lanes<std::int32_t, N>;
        sight all{false, false};
        for (int first = 0; first < 4; first += N) {
            floats u[3], v[3], z[3];
            for (int i = 0; i < 3; ++i) {
                const auto corner = [&](int k) -> const glm::vec3& {
                    return mesh_.positions[mesh_.triangles[name(first + k)][i]];
                };
                floats px, py, pz;
                gather_pairs<N>(px, py, [&](int k) { return &corner(k).x; });
                gather<N>(pz, [&](int k) { return corner(k).z; });
                u[i] = px * axes_[0].x + py * axes_[1].x + pz * axes_[2].x + start.x;
                v[i] = px * axes_[0].y + py * axes_[1].y + pz * axes_[2].y + start.y;
                z[i] = px * axes_[0].z + py * axes_[1].z + pz * axes_[2].z + start.z;
            }
            const floats a = u[1] * v[2] - v[1] * u[2], b = u[2] * v[0] - v[2] * u[0], c = u[0] * v[1] - v[0] * u[1];
            const ints covered = (ints(a >= 0.0f) & ints(b >= 0.0f) & ints(c >= 0.0f)) |
                                 (ints(a <= 0.0f) & ints(b <= 0.0f) & ints(c <= 0.0f));
            const floats height = (a * z[0] + b * z[1] + c * z[2]) / (a + b + c);
            all.is_behind |= any(ints(covered & ints(height > tolerance_)));
            all.is_above |= any(ints(height > tolerance_));
        }
        return all;
    }

    /// Meshes are mostly written such that neighbours come after one another; grids, strip by strip. How many triangles
    /// a grid's strip has shows in the indices of each: its corners lie in two rows of vertices.
    std::uint32_t strip(std::uint32_t name) const {
        const glm::uvec3& t = mesh_.triangles[name];
        return 2 * ((std::max)({t.x, t.y, t.z}) - (std::min)({t.x, t.y, t.z}) - 1);
    }
    std::uint32_t before(std::uint32_t name, std::uint32_t steps) const { return name - (std::min)(name, steps); }
    std::uint32_t after(std::uint32_t name, std::uint32_t steps) const {
        return name + (std::min)(static_cast<std::uint32_t>(mesh_.triangles.size() - 1) - name, steps);
    }

    /// What has been asked around a point.
    struct neighbourhood {
        const caster_map& map;
        const glm::vec3& start;
        std::uint32_t asked[12]{};
        int count = 0;

        /// Whether one of the four triangles before a name or of the four after it is in the way, and news.
        bool is_behind(std::uint32_t name) {
            for (int i = 0; i < count; ++i)
                if (name - asked[i] + 2 <= 4) return false;  // as good as asked
            asked[count++] = name;
            const auto steps = [](int k) { return static_cast<std::uint32_t>(k + 1); };
            return map.see(start, [&](int k) { return map.before(name, steps(k)); }).is_behind ||
                   map.see(start, [&](int k) { return map.after(name, steps(k)); }).is_behind;
        }
    };

    light_frame frame_;
    mesh_view mesh_;
    affine to_light_;  ///< from the mesh to (u, v, z)
    glm::mat3 axes_;   ///< its linear part
    map_grid grid_;
    float tolerance_ = 0;          ///< metres that floats hold places to; what lies no higher than that touches
    glm::vec3 to_map_[3], start_;  ///< from positions to column, row and height
    insonify::detail::unfilled_vector<float> heights_;        ///< with the frame of empty texels
    insonify::detail::unfilled_vector<std::uint32_t> names_;  ///< the same texels
};

}  // namespace insonify::inline INSONIFY_ABI::shadow

INSONIFY_ARITHMETIC_END
