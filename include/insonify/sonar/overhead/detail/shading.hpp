// Shaders of overhead pictures: light of each visible pixel, over SIMD lanes.
//
// Shadows of undecided triangles, and labels, are later passes over the images written here (render.hpp).
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/shared_mesh.hpp>
#include <insonify/raster/draw.hpp>
#include <insonify/seabed/heightfield.hpp>
#include <insonify/shadow/policy.hpp>
#include <insonify/sonar/backscatter.hpp>
#include <insonify/sonar/overhead/detail/undecided_light.hpp>
#include <insonify/sonar/overhead/rig.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A mesh in the rig's frame.
struct placed_mesh {
    mesh_view shape;
    bounding_box box;  ///< of the shape, in its own frame
    affine to_rig;
    surface_kind kind = surface_kind::open;
    const regular_grid* grid = nullptr;  ///< see shared_mesh
};

/// Varyings, in the rig's frame. Horizontal coordinates follow from the pixel.
struct surface_varyings {
    glm::vec3 normal;
    float height;
};

/// Whether a mesh with this box is far from the origin for its size.
inline bool is_far_from_origin(const bounding_box& box) {
    if (box.empty()) return false;
    const glm::dvec3 size = box.size();
    const double longest = (std::max)({size.x, size.y, size.z});
    for (int axis = 0; axis < 3; ++axis)
        if (numeric::abs(box.centre()[axis]) > 2 * longest) return true;
    return false;
}

/// Transforms normals: the cofactors over a power of two near their size. Very short normals count as missing, and must
/// not be short because the pose scales the mesh.
inline glm::mat3 normal_matrix(const glm::dmat3& linear) {
    glm::dmat3 areas = numeric::cofactors(linear);
    double square = 0;
    for (int i = 0; i < 3; ++i) square = (std::max)(square, numeric::dot(areas[i], areas[i]));
    if (!(square > 0) || !numeric::is_finite(square)) return glm::mat3(areas);
    double unit = 1;
    while (unit * unit > 2 * square) unit /= 2;
    while (2 * unit * unit < square) unit *= 2;
    for (int i = 0; i < 3; ++i) areas[i] /= unit;
    return glm::mat3(areas);
}

/// Vertex shader of a mesh in the rig's picture.
struct surface_vertex_shader {
    const overhead_geometry& view;
    glm::vec3 centre{0};  ///< subtracted before positions are multiplied
    glm::mat3 linear;
    glm::vec3 offset;
    glm::mat3 normals;

    surface_vertex_shader(const overhead_geometry& rig, const placed_mesh& shape)
        : view(rig), linear(shape.to_rig.linear), normals(normal_matrix(shape.to_rig.linear)) {
        // Products of coordinates much larger than the mesh would cancel, and leave their rounding errors.
        if (is_far_from_origin(shape.box)) centre = glm::vec3(shape.box.centre());
        offset = glm::vec3(transform_point(shape.to_rig, glm::dvec3(centre)));
    }

    vertex_output<surface_varyings> operator()(const vertex& v) const {
        const glm::vec3 position = numeric::product(linear, v.position - centre) + offset;
        return {view.clip(position), {numeric::product(normals, v.normal), position.z}};
    }
    /// See vertex_lane_shader.
    template <class Floats>
    INSONIFY_INLINE void operator()(Floats (&clip)[4], Floats* varyings, const Floats (&position)[3],
                                    const Floats (&normal)[3]) const {
        Floats placed[3];
        const Floats from_centre[3] = {position[0] - centre.x, position[1] - centre.y, position[2] - centre.z};
        numeric::product(placed, linear, from_centre);
        for (int i = 0; i < 3; ++i) placed[i] = placed[i] + offset[i];
        numeric::product(varyings, normals, normal);
        varyings[3] = placed[2];
        view.clip(clip, placed);
    }
};

/// The bottom or a target as it is drawn, for the passes over the picture.
struct drawn_object {
    placed_mesh placed;
    std::uint32_t first_id = 0;               ///< of its triangles in the visibility buffer
    std::uint32_t caster = 0;                 ///< index into the casters
    std::uint16_t instance = 0;               ///< as in labels::instance
    std::uint8_t seabed = 0;                  ///< as in labels::seabed, if there are no types
    material whole;                           ///< if there are no types
    const seabed::type* types = nullptr;      ///< by vertex, of a bottom of several types
    const material* materials = nullptr;      ///< by type
    std::uint16_t self_shadow_label = 0;      ///< label in labels::shadow where the object shades itself
    const shadow::decision* known = nullptr;  ///< lit, dark or undecided, by triangle; null if none is decided
};

/// The images that shading writes; those that may be null are optional.
struct shaded_images {
    image<float>& picture;
    undecided_light* undecided = nullptr;    ///< if there is a shadow policy
    image<std::uint32_t>* ids = nullptr;     ///< the visibility buffer
    image<std::uint8_t>* types = nullptr;    ///< seabed::type, of bottoms of several types
    image<std::uint16_t>* shadow = nullptr;  ///< labels of known casters, as in labels::shadow

    void clear(const rect& tile) const {
        if (undecided != nullptr) undecided->clear(tile);
        for (int y = tile.y0; y < tile.y1; ++y) {
            std::fill_n(&picture(tile.x0, y), tile.width(), 0.0f);
            if (ids != nullptr) std::fill_n(&(*ids)(tile.x0, y), tile.width(), shadow::invalid_id);
        }
    }
};

/// Fragment shader over lanes of one object.
template <class Law>
class surface_shader {
  public:
    surface_shader(const overhead_geometry& view, const drawn_object& object, const Law& law, const shaded_images& into)
        : object_(object),
          into_(into),
          law_(law),
          is_point_light_(view.has_point_light()),
          left_(0.5f * static_cast<float>(1 - view.rig().size.x)),
          top_(0.5f * static_cast<float>(view.rig().size.y - 1)),
          ray_step_(static_cast<float>(view.ray_step())),
          altitude_(view.rig().altitude),
          intensity_(view.rig().intensity),
          sky_(view.rig().sky),
          ambient_(view.rig().ambient) {
        const glm::vec3 light(is_point_light_ ? view.light_position() : view.light().to_light());
        for (int i = 0; i < 3; ++i) to_light_[i] = light[i];
    }

    void clear(const rect& tile) const { into_.clear(tile); }

    template <int N>
    INSONIFY_INLINE void operator()(const fragment_lanes<N, surface_varyings>& f) const {
        using ints = lanes<std::int32_t, N>;
        using floats = lanes<float, N>;
        const floats side = f.front ? floats{} + 1.0f : floats{} - 1.0f;
        floats normal[3], length, to_light[3];
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA { f.interpolate(normal[i], i); });
        const floats square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
        const ints usable = ints(square > 0x1p-40f) & ints(square < 0x1p100f);
        const ints invalid = f.visible & ints(usable == 0);
        if (any(invalid)) use_facets<N>(normal, f, invalid);
        square_root<N>(length, normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        length = length > 0.0f ? length : floats{} + 1.0f;
        const floats signed_inverse_length = side / length;
        point_to_light<N>(to_light, f);
        floats sine =
            signed_inverse_length * (normal[0] * to_light[0] + normal[1] * to_light[1] + normal[2] * to_light[2]);
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
        const floats rest = reflectivity * (sky * (0.5f * (1.0f + signed_inverse_length * normal[2])) + ambient);
        const floats one = floats{} + 1.0f, sum = rest + direct;
        const floats all = sum < one ? sum : one;
        if (into_.undecided == nullptr)
            f.store(into_.picture, all);
        else
            store_known<N>(f, all, rest, direct);
        if (into_.ids == nullptr) return;
        lanes<std::uint32_t, N> ids;
        load(ids, f.triangles);
        f.store(*into_.ids, lanes<std::uint32_t, N>(ids + object_.first_id));
    }

  private:
    /// Stores the light of pixels whose triangles are known to be lit or dark, and lists the others as undecided.
    /// @param all  light if nothing blocks the source
    template <int N>
    INSONIFY_INLINE void store_known(const fragment_lanes<N, surface_varyings>& f, const lanes<float, N>& all,
                                     const lanes<float, N>& rest, const lanes<float, N>& direct) const {
        using ints = lanes<std::int32_t, N>;
        using floats = lanes<float, N>;
        floats value = rest < 1.0f ? rest : floats{} + 1.0f;
        // Labels need the casters of pixels that the source cannot light, too.
        ints undecided = into_.shadow != nullptr ? ints{} - 1 : ints(direct > 0.0f), is_dark{};
        if (object_.known != nullptr) {
            ints known;
            gather<N>(known, [&](int k) { return static_cast<std::int32_t>(object_.known[f.triangles[k]]); });
            const ints is_lit = ints(known == static_cast<std::int32_t>(shadow::decision::lit));
            is_dark = ints(known == static_cast<std::int32_t>(shadow::decision::dark));
            value = is_lit ? all : value;
            undecided = undecided & ints(known == static_cast<std::int32_t>(shadow::decision::undecided));
        }
        f.store(into_.picture, value);
        if (into_.shadow != nullptr) {
            lanes<std::uint16_t, N> caster;
            convert(caster, is_dark ? ints{} + static_cast<std::int32_t>(object_.self_shadow_label) : ints{});
            f.store(*into_.shadow, caster);
        }
        static_assert(N <= 8);
        const unsigned which = movemask<N>(f.visible);
        into_.undecided->set<N>(f.x, f.y, which, movemask<N>(undecided) & which, f.triangles, object_.first_id, direct);
    }

    /// Replaces normals that are zero or not finite by the facet's.
    template <int N>
    INSONIFY_RARE void use_facets(lanes<float, N> (&normal)[3], const fragment_lanes<N, surface_varyings>& f,
                                  const lanes<std::int32_t, N>& where) const {
        for (int k = 0; k < N; ++k) {
            if (lane(where, k) == 0) continue;
            const glm::uvec3& t = object_.placed.shape.triangles[f.triangles[k]];
            const auto corner = [&](int i) {
                return transform_point(object_.placed.to_rig, glm::dvec3(object_.placed.shape.positions[t[i]]));
            };
            const glm::dvec3 facet = unit(numeric::cross(corner(1) - corner(0), corner(2) - corner(0)));
            for (int i = 0; i < 3; ++i) set_lane(normal[i], k, static_cast<float>(facet[i]));
        }
    }

    /// The seabed's type at the vertex with the largest weight.
    template <int N>
    INSONIFY_INLINE std::uint8_t type_at(const fragment_lanes<N, surface_varyings>& f, int k) const {
        const glm::uvec3& t = object_.placed.shape.triangles[f.triangles[k]];
        const float a = lane(f.weights[0], k), b = lane(f.weights[1], k), c = lane(f.weights[2], k);
        return static_cast<std::uint8_t>(object_.types[a >= b ? (a >= c ? t.x : t.z) : (b >= c ? t.y : t.z)]);
    }

    /// Sets the unit vector to the light.
    template <int N>
    INSONIFY_INLINE void point_to_light(lanes<float, N> (&into)[3],
                                        const fragment_lanes<N, surface_varyings>& f) const {
        using floats = lanes<float, N>;
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA { load(into[i], to_light_[i]); });
        if (!is_point_light_) return;
        floats altitude, step, column, height, square = floats{}, length;
        load(altitude, altitude_), load(step, ray_step_);
        iota<float, N>(column);
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

    template <int N>
    INSONIFY_INLINE void law(lanes<float, N>& into, const lanes<float, N>& sine) const {
        if constexpr (requires { law_.in_lanes(into, sine); })
            law_.in_lanes(into, sine);
        else
            gather<N>(into, [&](int k) { return static_cast<float>(law_(lane(sine, k))); });
    }

    const drawn_object& object_;
    shaded_images into_;
    Law law_;
    bool is_point_light_;
    float left_, top_;           ///< from the picture's middle to the first pixel's centre, in pixels
    broadcast<float> ray_step_;  ///< see overhead_geometry::ray_step
    broadcast<float> altitude_, intensity_, sky_, ambient_;  ///< the rig's
    broadcast<float> to_light_[3];                           ///< unit vector, or the position of a point light
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
