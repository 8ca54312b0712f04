// Who is in whose shadow, asked ray by ray: every pixel's own point on its own triangle, and every triangle that may
// stand between it and the light.
//
// The point is where the ray through the pixel's centre meets the triangle's plane, in doubles: what the rasterizer
// interpolates lies beside it by what rounding the corners to sub-pixels moves, and that moves a shadow's edge too.
#pragma once

#include <insonify/shadow/exact.hpp>
#include <insonify/shadow/map.hpp>
#include <insonify/shadow/policy.hpp>
#include <insonify/sonar/illumination.hpp>
#include <insonify/sonar/rig.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::detail {

/// The lights of a scene, and who stands in each.
class exact_shadows {
  public:
    /// @param bottom     the seabed, or null; it has to outlive this, and so do the targets
    /// @param targets    in the order of their instance numbers
    /// @param shown      around all that the picture may show
    template <executor E>
    exact_shadows(const shadow::exact&, const overhead_geometry& view, const placed_mesh* bottom,
                  std::span<const placed_mesh> targets, const bounding_box& shown, E& ex)
        : exact_shadows(view, bottom, targets, ex) {
        lights_.push_back(light_at(view, {0, 0}));
        // Rays of parallel light that reach none of it need not be asked.
        const shadow::map_extent asked = shadow::extent_of(shown, {}, view.light());
        if (!asked.empty()) lights_[0].rays.keep_to(asked.lowest, asked.highest);
        cast(ex);
    }
    template <executor E>
    exact_shadows(const shadow::penumbra& p, const overhead_geometry& view, const placed_mesh* bottom,
                  std::span<const placed_mesh> targets, const bounding_box&, E& ex)
        : exact_shadows(view, bottom, targets, ex) {
        const double radius = shadow::radius_of(p);
        for (int i = 0; i < p.samples; ++i) {
            // A sunflower's seeds fill a disc evenly, ring by ring.
            const double share = i == 0 ? 0 : numeric::square_root((i + 0.5) / p.samples);
            const auto [sine, cosine] = numeric::sin_cos_turns(0.6180339887498949 * i);
            const glm::dvec2 at = radius * share * glm::dvec2(cosine, sine);
            if (is_up(view, at)) lights_.push_back(light_at(view, at));
        }
        points_ = p.samples;
        cast(ex);
    }

    exact_shadows(const exact_shadows&) = delete;  // casters point to shapes

    const exact_shadows& within(const pixel_box&) const { return *this; }

    /// Marks how much of the light reaches what the `useful` pixels show.
    /// @param f      their fragments
    /// @param shape  what they show: 0 the seabed, else the instance
    template <int N, class Fragments>
    INSONIFY_INLINE void operator()(light_shares<N>& shares, const Fragments& f, std::uint16_t shape,
                                    const lanes<std::int32_t, N>& useful) const {
        receivers<N> at;
        const unsigned asked = set_lanes<N>(useful);
        for (unsigned rest = asked; rest != 0; rest &= rest - 1) {
            const int k = std::countr_zero(rest);
            at.find(k, view_, shapes_[shape], f.triangles[k], f.x + k, f.y,
                    {lane(f.weights[1], k), lane(f.weights[2], k)});
        }
        int lit[static_cast<unsigned>(N)] = {};
        for (const light& l : lights_) {
            const unsigned dark = ask<N>(l, at, shape, asked, &l == &lights_[0] ? &shares : nullptr);
            for (unsigned rest = asked & ~dark; rest != 0; rest &= rest - 1) ++lit[std::countr_zero(rest)];
        }
        for (unsigned rest = asked; rest != 0; rest &= rest - 1) {
            const int k = std::countr_zero(rest);
            set_lane(shares.lit, k, static_cast<float>(lit[k]) / static_cast<float>(points_));
        }
    }

  private:
    /// A mesh in the rig's frame, its corners in doubles.
    struct placed_shape {
        const placed_mesh* placed = nullptr;  ///< null for nothing
        std::vector<glm::dvec3> corners;
    };
    /// A point of the light.
    struct light {
        shadow::light_rays rays;
        std::vector<shadow::light_blockers> casters;  ///< one for each shape
    };
    /// The points that pixels show.
    template <int N>
    struct receivers {
        glm::dvec3 position[static_cast<unsigned>(N)], normal[static_cast<unsigned>(N)],
            back[static_cast<unsigned>(N)];  ///< back: to the camera

        void find(int k, const overhead_geometry& view, const placed_shape& s, std::uint32_t triangle, int x, int y,
                  const glm::dvec2& rounded) {
            const glm::uvec3& t = s.placed->shape.triangles[triangle];
            const glm::dvec3 &a = s.corners[t.x], ab = s.corners[t.y] - a, ac = s.corners[t.z] - a;
            // Tomas Moeller, Ben Trumbore. Fast, Minimum Storage Ray/Triangle Intersection. 1997.
            const glm::dvec3 ray = view.ray(x, y), from = view.eye() - a, p = numeric::cross(ray, ac);
            const double scale = 1 / numeric::dot(ab, p);
            double b = numeric::dot(from, p) * scale, c = numeric::dot(ray, numeric::cross(from, ab)) * scale;
            // A triangle that is seen from its edge may be shown by a pixel whose centre misses its plane.
            constexpr double beside = 0x1p-6;
            if (!(b >= -beside && c >= -beside && b + c <= 1 + beside)) {
                b = rounded.x;
                c = rounded.y;
            }
            position[k] = a + b * ab + c * ac;
            normal[k] = numeric::cross(ab, ac);
            back[k] = from;
        }
    };

    template <executor E>
    exact_shadows(const overhead_geometry& view, const placed_mesh* bottom, std::span<const placed_mesh> targets, E& ex)
        : view_(view) {
        shapes_.resize(targets.size() + 1);
        reach_ = static_cast<double>(view.rig().altitude);
        const auto place = [&](placed_shape& s, const placed_mesh& placed) {
            s = {&placed, shadow::placed_corners(placed.shape, placed.to_rig, ex)};
            reach_ = (std::max)(reach_, shadow::reach_of(s.corners));
        };
        if (bottom != nullptr) place(shapes_[0], *bottom);
        for (std::size_t i = 0; i < targets.size(); ++i) place(shapes_[i + 1], targets[i]);
    }

    static bool is_up(const overhead_geometry& view, const glm::dvec2& beside) {
        return view.has_near_light() || view.toward_light(beside).z > 0;
    }
    light light_at(const overhead_geometry& view, const glm::dvec2& beside) const {
        if (view.has_near_light()) return {{shadow::point_light{view.light_position(beside)}, reach_}, {}};
        if (beside == glm::dvec2(0)) return {{view.light(), reach_}, {}};
        const glm::dvec3 d = view.toward_light(beside);
        const double level = numeric::square_root(d.x * d.x + d.y * d.y);
        return {{shadow::light_frame({numeric::atan2(-d.y, -d.x), numeric::atan2(d.z, level)}), reach_}, {}};
    }

    template <executor E>
    void cast(E& ex) {
        for (light& l : lights_)
            for (const placed_shape& s : shapes_) {
                if (s.placed == nullptr) {
                    l.casters.emplace_back();
                    continue;
                }
                l.casters.emplace_back(l.rays, s.placed->shape, s.corners, s.placed->is_solid, s.placed->is_mirrored(),
                                       ex);
            }
    }

    /// Which points one light doesn't reach; a target's shadow goes on over what would be dark without it.
    /// @param blame  where to leave who stops it, or null
    template <int N>
    INSONIFY_INLINE unsigned ask(const light& l, const receivers<N>& at, std::uint16_t itself, unsigned asked,
                                 light_shares<N>* blame) const {
        unsigned dark = 0;
        const auto darken = [&](unsigned points, std::uint16_t by) {
            dark |= points;
            if (blame == nullptr) return;
            for (; points != 0; points &= points - 1)
                set_lane(blame->caster, std::countr_zero(points), std::int32_t{by});
        };
        for (std::size_t i = 1; i < l.casters.size(); ++i)
            darken(l.casters[i].template stop<N>(l.rays, at.position, asked & ~dark), static_cast<std::uint16_t>(i));
        unsigned turned = 0;
        for (unsigned rest = asked & ~dark; rest != 0; rest &= rest - 1) {
            const int k = std::countr_zero(rest);
            if (!shadow::is_faced(at.normal[k], l.rays.toward(at.position[k]), at.back[k])) turned |= 1u << k;
        }
        darken(turned, itself == labels::no_instance ? labels::by_seabed : itself);
        darken(l.casters[0].template stop<N>(l.rays, at.position, asked & ~dark), labels::by_seabed);
        return dark;
    }

    overhead_geometry view_;
    std::vector<placed_shape> shapes_;  ///< the seabed and the targets
    std::vector<light> lights_;         ///< the middle first
    int points_ = 1;                    ///< of the light, with those below the horizon
    double reach_ = 0;
};

}  // namespace insonify::inline INSONIFY_ABI::detail

INSONIFY_ARITHMETIC_END
