// From what a pixel shows to its light: the surface's smooth normal, the backscatter law, and what the surface sends
// back without the light, several pixels at a time.
//
// Shadows and labels are no part of it: they are passes of their own over what this one leaves (render.hpp).
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/raster/draw.hpp>
#include <insonify/seabed/heightfield.hpp>
#include <insonify/shadow/policy.hpp>
#include <insonify/sonar/backscatter.hpp>
#include <insonify/sonar/overhead/detail/placed_mesh.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// What pixels between the vertices are shaded from, in the rig's frame. The pixel's place gives the rest.
struct surface_varyings {
    glm::vec3 normal;
    float height;
};

/// Places the vertices of an object in the rig's frame and in its picture.
struct surface_placement {
    const overhead_geometry& view;
    glm::mat3 linear;
    glm::vec3 offset;
    glm::mat3 normals;

    surface_placement(const overhead_geometry& rig, const placed_mesh& shape)
        : view(rig),
          linear(shape.to_rig.linear),
          offset(shape.to_rig.offset),
          normals(numeric::cofactors(shape.to_rig.linear)) {}

    placed_vertex<surface_varyings> operator()(const vertex& v) const {
        const glm::vec3 position = place(v.position);
        return {view.clip(position), {numeric::product(normals, v.normal), position.z}};
    }
    glm::vec3 place(const glm::vec3& position) const { return numeric::product(linear, position) + offset; }
    /// See lane_shader.
    template <class Floats>
    INSONIFY_INLINE void operator()(Floats (&clip)[4], Floats* varyings, const Floats (&position)[3],
                                    const Floats (&normal)[3]) const {
        Floats placed[3];
        numeric::product(placed, linear, position);
        for (int i = 0; i < 3; ++i) placed[i] = placed[i] + offset[i];
        numeric::product(varyings, normals, normal);
        varyings[3] = placed[2];
        view.clip(clip, placed);
    }
};

/// An object of the picture: what it is made of, and its number.
struct surface {
    mesh_view mesh;
    affine to_rig;
    std::uint32_t first_id = 0;           ///< of its triangles in the visibility buffer
    std::uint32_t caster = 0;             ///< its number among the casters
    std::uint16_t instance = 0;           ///< as in labels::instance
    std::uint8_t seabed = 0;              ///< as in labels::seabed, unless there are types
    material whole;                       ///< of all of it, unless there are types
    const seabed::type* types = nullptr;  ///< by vertex: the bottom's, where there are several
    const material* materials = nullptr;  ///< by type
};

/// What shading leaves for each pixel. A null pointer leaves it out.
struct shaded_images {
    image<float>& direct;                  ///< what the light makes of it, unshadowed; with the rest, if there is no
                                           ///< image for that
    image<float>* rest = nullptr;          ///< what it shows without the light
    image<std::uint32_t>* ids = nullptr;   ///< the visibility buffer
    image<std::uint8_t>* types = nullptr;  ///< seabed::type, where an object has several

    void clear(const pixel_box& tile) const {
        for (int y = tile.y0; y <= tile.y1; ++y) {
            std::fill_n(&direct(tile.x0, y), tile.width(), 0.0f);
            if (rest != nullptr) std::fill_n(&(*rest)(tile.x0, y), tile.width(), 0.0f);
            if (ids != nullptr) std::fill_n(&(*ids)(tile.x0, y), tile.width(), shadow::invalid_id);
        }
    }
};

/// Shades an object's visible pixels.
template <class Law>
class surface_shader {
  public:
    surface_shader(const overhead_geometry& view, const surface& object, const Law& law, const shaded_images& into)
        : object_(object),
          into_(into),
          law_(law),
          is_near_(view.has_near_light()),
          left_(0.5f * static_cast<float>(1 - view.rig().size.x)),
          top_(0.5f * static_cast<float>(view.rig().size.y - 1)),
          ray_step_(static_cast<float>(view.ray_step())),
          altitude_(view.rig().altitude),
          intensity_(view.rig().intensity),
          sky_(view.rig().sky),
          ambient_(view.rig().ambient) {
        const glm::vec3 light(is_near_ ? view.light_position() : view.light().to_light());
        for (int i = 0; i < 3; ++i) to_light_[i] = light[i];
    }

    void clear(const pixel_box& tile) const { into_.clear(tile); }

    /// Shades the pixels of one tile.
    struct tile_shader {
        const surface_shader& whole;

        template <int N>
        INSONIFY_INLINE void operator()(const fragment_lanes<N, surface_varyings>& f) const {
            whole.shade(f);
        }
    };
    tile_shader on(const pixel_box&) const { return {*this}; }

  private:
    template <int N>
    INSONIFY_INLINE void shade(const fragment_lanes<N, surface_varyings>& f) const {
        using ints = lanes<std::int32_t, N>;
        using floats = lanes<float, N>;
        const floats side = f.front ? floats{} + 1.0f : floats{} - 1.0f;
        floats normal[3], length, to_light[3];
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA { f.interpolate(normal[i], i); });
        const floats square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
        const ints unknown = f.visible & ~(ints(square > 0x1p-40f) & ints(square < 0x1p100f));
        if (any(unknown)) use_facets<N>(normal, f, unknown);
        square_root<N>(length, normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        length = length > 0.0f ? length : floats{} + 1.0f;
        const floats turned = side / length;
        point_to_light<N>(to_light, f);
        floats sine = turned * (normal[0] * to_light[0] + normal[1] * to_light[1] + normal[2] * to_light[2]);
        sine = sine < 1.0f ? sine : floats{} + 1.0f;
        sine = sine > 0.0f ? sine : floats{};

        floats reflectivity = floats{} + object_.whole.reflectivity;
        if (object_.types != nullptr) {
            std::uint8_t types[static_cast<unsigned>(N)];
            for (int k = 0; k < N; ++k) {
                types[k] = type_at(f, k);
                if (into_.types != nullptr && lane(f.visible, k) != 0) (*into_.types)(f.x + k, f.y) = types[k];
            }
            gather<N>(reflectivity, [&](int k) { return object_.materials[types[k]].reflectivity; });
        }
        floats direct, intensity, sky, ambient;
        law<N>(direct, sine);
        load(intensity, intensity_), load(sky, sky_), load(ambient, ambient_);
        direct = sine > 0.0f ? reflectivity * intensity * direct : floats{};
        const floats rest = reflectivity * (sky * (0.5f * (1.0f + turned * normal[2])) + ambient);
        if (into_.rest == nullptr) {
            const floats one = floats{} + 1.0f, value = rest + direct;
            store_visible<N>(f, floats(value < one ? value : one), into_.direct);
        } else {
            store_visible<N>(f, direct, into_.direct);
            store_visible<N>(f, rest, *into_.rest);
        }
        if (into_.ids == nullptr) return;
        lanes<std::uint32_t, N> ids;
        load(ids, f.triangles);
        store_visible<N>(f, lanes<std::uint32_t, N>(ids + object_.first_id), *into_.ids);
    }

    /// Normals that cancel between the vertices, or are none: the facet's.
    template <int N>
    INSONIFY_RARE void use_facets(lanes<float, N> (&normal)[3], const fragment_lanes<N, surface_varyings>& f,
                                  const lanes<std::int32_t, N>& where) const {
        for (int k = 0; k < N; ++k) {
            if (lane(where, k) == 0) continue;
            const glm::uvec3& t = object_.mesh.triangles[f.triangles[k]];
            const auto corner = [&](int i) { return transform_point(object_.to_rig, object_.mesh.positions[t[i]]); };
            const glm::dvec3 facet = unit(numeric::cross(corner(1) - corner(0), corner(2) - corner(0)));
            for (int i = 0; i < 3; ++i) set_lane(normal[i], k, static_cast<float>(facet[i]));
        }
    }

    /// The seabed's type at the corner that weighs most.
    template <int N>
    INSONIFY_INLINE std::uint8_t type_at(const fragment_lanes<N, surface_varyings>& f, int k) const {
        const glm::uvec3& t = object_.mesh.triangles[f.triangles[k]];
        const float a = lane(f.weights[0], k), b = lane(f.weights[1], k), c = lane(f.weights[2], k);
        return static_cast<std::uint8_t>(object_.types[a >= b ? (a >= c ? t.x : t.z) : (b >= c ? t.y : t.z)]);
    }

    /// The unit vector to the light.
    template <int N>
    INSONIFY_INLINE void point_to_light(lanes<float, N> (&into)[3],
                                        const fragment_lanes<N, surface_varyings>& f) const {
        using floats = lanes<float, N>;
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA { load(into[i], to_light_[i]); });
        if (!is_near_) return;
        floats altitude, step, column, height, square = floats{}, length;
        load(altitude, altitude_), load(step, ray_step_);
        count_up<float, N>(column);
        f.interpolate(height, 3);
        const floats down = altitude - height;
        const floats position[3] = {(column + (static_cast<float>(f.x) + left_)) * step * down,
                                    (top_ - static_cast<float>(f.y)) * step * down, height};
        for (int i = 0; i < 3; ++i) {
            into[i] = into[i] - position[i];
            square = square + into[i] * into[i];
        }
        square_root<N>(length, square);
        length = length > 0.0f ? length : floats{} + 1.0f;
        for (int i = 0; i < 3; ++i) into[i] = into[i] / length;
    }

    template <int N, class T>
    INSONIFY_INLINE static void store_visible(const fragment_lanes<N, surface_varyings>& f, const lanes<T, N>& value,
                                              image<T>& picture) {
        if (f.all_visible)
            store(&picture(f.x, f.y), value);
        else
            for (int k = 0; k < N; ++k)
                if (lane(f.visible, k) != 0) picture(f.x + k, f.y) = lane(value, k);
    }

    template <int N>
    INSONIFY_INLINE void law(lanes<float, N>& into, const lanes<float, N>& sine) const {
        if constexpr (requires { law_.in_lanes(into, sine); })
            law_.in_lanes(into, sine);
        else
            gather<N>(into, [&](int k) { return static_cast<float>(law_(lane(sine, k))); });
    }

    const surface& object_;
    shaded_images into_;
    Law law_;
    bool is_near_;
    float left_, top_;        ///< from the picture's middle to the first pixel's centre, in pixels
    spread<float> ray_step_;  ///< how far the ground is from pixel to pixel, seen from a height of one
    spread<float> altitude_, intensity_, sky_, ambient_;  ///< the rig's
    spread<float> to_light_[3];                           ///< where it stands, if it is near
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
