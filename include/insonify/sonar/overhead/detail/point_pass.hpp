// Computes the surface points of undecided pixels, and whether each faces the light.
//
// The point is where the ray through the pixel's centre meets the plane of the pixel's triangle, in doubles, clamped to
// the triangle: sub-pixel snapping may cover pixels slightly outside it. Everything is computed in the mesh's own
// frame, into which the camera and the light are transformed once.
//
// Based on: Christopher A. Burns, Warren A. Hunt. The Visibility Buffer: A Cache-Friendly Approach to Deferred Shading.
// JCGT 2, 2013. Tomas Moeller, Ben Trumbore. Fast, Minimum Storage Ray/Triangle Intersection. 1997.
#pragma once

#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/core/simd/transpose.hpp>
#include <insonify/sonar/overhead/detail/shading.hpp>
#include <insonify/sonar/overhead/detail/shadow_points.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The camera and the light from an object's own frame.
struct view_from_object {
    glm::dvec3 eye;                      ///< the camera
    glm::dvec3 corner_ray, right, down;  ///< rays through pixels: of pixel (0, 0), and from pixel to pixel
    glm::dvec3 light;                    ///< towards a parallel light, or the position of a point light

    view_from_object(const overhead_geometry& view, const affine& to_rig) {
        const affine back = inverse(to_rig);
        eye = transform_point(back, view.eye());
        corner_ray = transform_direction(back, view.ray(0, 0));
        right = transform_direction(back, view.ray(1, 0) - view.ray(0, 0));
        down = transform_direction(back, view.ray(0, 1) - view.ray(0, 0));
        light = view.has_point_light() ? transform_point(back, view.light_position())
                                       : transform_direction(back, view.light().to_light());
    }
};

/// Finds the points of some pixels of one object.
struct point_kernel {
    const drawn_object& object;
    const view_from_object& from;
    std::span<const undecided_pixel> pixels;  ///< with the ids of triangles within the object
    bool has_point_light;
    bool includes_facing_away;
    const rect& box;      ///< the tile's pixels
    std::uint32_t pitch;  ///< pixels from one row of the picture to the next
    point_list& points;

    template <int Width>
    INSONIFY_INLINE void run() const {
        constexpr int N = Width > 1 ? Width / 2 : 1;
        for (std::size_t i = 0; i < pixels.size(); i += N) {
            prefetch_ahead<N>(i);
            find<N>(i, (std::min)(pixels.size() - i, std::size_t{N}));
        }
    }

  private:
    /// Prefetches the triangles of pixels a few rounds ahead of `i`, and the vertices of those fetched before.
    template <int N>
    INSONIFY_INLINE void prefetch_ahead(std::size_t i) const {
        const mesh_view& m = object.placed.shape;
        const auto some = [&](int rounds) {
            const std::size_t first = (std::min)(i + static_cast<std::size_t>(rounds * N), pixels.size());
            return pixels.subspan(first, (std::min)(pixels.size() - first, std::size_t{N}));
        };
        for (const undecided_pixel& p : some(4)) prefetch(&m.triangles[p.id]);
        for (const undecided_pixel& p : some(2))
            for (int k = 0; k < 3; ++k) prefetch(&m.positions[m.triangles[p.id][k]]);
    }
    template <class Reals>
    INSONIFY_INLINE static void cross(Reals (&into)[3], const Reals (&a)[3], const Reals (&b)[3]) {
        into[0] = a[1] * b[2] - b[1] * a[2];
        into[1] = a[2] * b[0] - b[2] * a[0];
        into[2] = a[0] * b[1] - b[0] * a[1];
    }
    template <class Reals>
    INSONIFY_INLINE static void dot(Reals& into, const Reals (&a)[3], const Reals (&b)[3]) {
        into = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    template <int N>
    using corners = const glm::uvec3 * [static_cast<unsigned>(N)];

    /// The vectors at one corner of each triangle. Loads four floats each, unless a vector is the last of the array,
    /// where the fourth float would lie beyond the end.
    template <int N>
    INSONIFY_INLINE static void fetch(lanes<float, N> (&into)[3], const glm::vec3* vectors, const corners<N>& t,
                                      int corner, bool has_last) {
#if INSONIFY_SIMD
        if constexpr (N >= 4) {
            if (!has_last) {
                lanes<float, N> columns[4];
                transpose<N>(columns, [&](int k) { return &vectors[(*t[k])[corner]].x; });
                unroll<3>([&](int axis) INSONIFY_INLINE_LAMBDA { into[axis] = columns[axis]; });
                return;
            }
        }
#endif
        (void)has_last;
        unroll<3>([&](int axis) INSONIFY_INLINE_LAMBDA {
            gather<N>(into[axis], [&](int k) { return vectors[(*t[k])[corner]][axis]; });
        });
    }
    template <int N>
    INSONIFY_INLINE static void fetch(lanes<double, N> (&into)[3], const glm::vec3* vectors, const corners<N>& t,
                                      int corner, bool has_last) {
        lanes<float, N> narrow[3];
        fetch<N>(narrow, vectors, t, corner, has_last);
        unroll<3>([&](int axis) INSONIFY_INLINE_LAMBDA { convert(into[axis], narrow[axis]); });
    }

    template <int N>
    INSONIFY_INLINE void find(std::size_t start, std::size_t count) const {
        using reals = lanes<double, N>;
        using bits = lanes<std::int64_t, N>;
        const mesh_view& m = object.placed.shape;
        const affine& to_rig = object.placed.to_rig;
        corners<N> t;
        std::uint32_t greatest = 0;
        reals column, row;
        const auto pixel = [&](int k) -> const undecided_pixel& {
            return pixels[start + (std::min)(static_cast<std::size_t>(k), count - 1)];
        };
        for (int k = 0; k < N; ++k) {
            t[k] = &m.triangles[pixel(k).id];
            greatest = (std::max)(greatest, (std::max)((std::max)(t[k]->x, t[k]->y), t[k]->z));
        }
        gather<N>(column, [&](int k) { return static_cast<double>(box.x0 + pixel(k).column); });
        gather<N>(row, [&](int k) { return static_cast<double>(box.y0 + pixel(k).row); });
        const bool has_last = greatest + 1 >= m.positions.size();

        // Where the ray through each pixel meets its triangle: a + b ab + c ac.
        reals a[3], ab[3], ac[3], ray[3], to_eye[3], p[3], q[3], scale, b, c;
        fetch<N>(a, m.positions.data(), t, 0, has_last);
        fetch<N>(ab, m.positions.data(), t, 1, has_last);
        fetch<N>(ac, m.positions.data(), t, 2, has_last);
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA {
            ab[i] = ab[i] - a[i];
            ac[i] = ac[i] - a[i];
            ray[i] = from.corner_ray[i] + row * from.down[i] + column * from.right[i];
            to_eye[i] = from.eye[i] - a[i];
        });
        cross(p, ray, ac);
        cross(q, to_eye, ab);
        dot(scale, ab, p);
        scale = 1.0 / scale;
        dot(b, to_eye, p);
        dot(c, ray, q);
        b = b * scale;
        c = c * scale;
        const bits inside = bits(b >= border) & bits(c >= border) & bits(b + c <= 1.0 - border);
        if (any(bits(inside == 0))) clamp_to_triangle<N>(b, c);

        // Which side of the facet is seen, and whether the light meets it.
        reals at[3], facet[3], toward[3], seen, along, size, way;
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA {
            at[i] = a[i] + b * ab[i] + c * ac[i];
            toward[i] = has_point_light ? from.light[i] - at[i] : reals{} + from.light[i];
        });
        cross(facet, ab, ac);
        dot(seen, facet, to_eye);
        dot(along, facet, toward);
        dot(size, facet, facet);
        dot(way, toward, toward);
        along = seen > 0.0 ? along : 0.0 - along;
        const bits faces = bits(along > 0.0) & bits(along * along > (min_facing_sine * min_facing_sine * size) * way);
        double places[3][static_cast<unsigned>(N)];
        std::int64_t facing[static_cast<unsigned>(N)];
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA {
            store(places[i], reals(to_rig.linear[0][i] * at[0] + to_rig.linear[1][i] * at[1] +
                                   to_rig.linear[2][i] * at[2] + to_rig.offset[i]));
        });
        store(facing, faces);
        for (std::size_t k = 0; k < count; ++k) {
            if (facing[k] == 0 && !includes_facing_away) continue;
            const undecided_pixel& shown = pixels[start + k];
            points.add(facing[k] != 0, places[0][k], places[1][k], places[2][k], object.caster, shown.id,
                       static_cast<std::uint32_t>(box.y0 + shown.row) * pitch +
                           static_cast<std::uint32_t>(box.x0 + shown.column),
                       shown.direct);
        }
    }

    /// Facets at a smaller sine to the light count as facing away: vertices are rounded to 2^-24, and facets
    /// parallel to the light up to that error are dark.
    static constexpr double min_facing_sine = 0x1p-22;

    /// Points keep this barycentric distance from the edges of their triangle, unless it is seen edge-on: a point on an
    /// edge would lie in the adjacent triangle, too, which then would not block it.
    static constexpr double border = 0x1p-20;

    /// Sub-pixel snapping may draw a pixel slightly outside its triangle, where weights are negative; a triangle seen
    /// edge-on gives NaN or infinity.
    template <int N>
    INSONIFY_RARE static void clamp_to_triangle(lanes<double, N>& b, lanes<double, N>& c) {
        using reals = lanes<double, N>;
        const auto clamp = [](reals& x) INSONIFY_INLINE_LAMBDA {
            x = x > border ? x : reals{} + border;
            x = x < 0x1p60 ? x : reals{} + 0x1p60;
        };
        clamp(b);
        clamp(c);
        const reals sum = b + c, scale = sum > 1.0 - border ? (1.0 - border) / sum : reals{} + 1.0;
        b = b * scale;
        c = c * scale;
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
