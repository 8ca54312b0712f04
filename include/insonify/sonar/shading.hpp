// From what a pixel shows to its value and its labels, several pixels at a time.
#pragma once

#include <insonify/raster/draw.hpp>
#include <insonify/sonar/exact_light.hpp>
#include <insonify/sonar/illumination.hpp>
#include <insonify/sonar/rig.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// Asks for no labels: none are stored or computed.
struct no_labels {};

namespace detail {

/// What pixels between the vertices are shaded from, in the rig's frame. Which pixel it is says the rest.
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
        : view(rig), linear(shape.to_rig.linear), offset(shape.to_rig.offset), normals(shape.normals) {}

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

/// What is the same all over an object: one material, one name.
struct whole_object {
    material surface;
    std::uint16_t instance;
    std::uint8_t seabed;  ///< as in labels::seabed

    static constexpr bool uniform = true;
};

/// The seabed: a material for each of its types, which a pixel takes from the vertex that weighs most.
struct typed_bottom {
    mesh_view surface;
    const std::vector<seabed::type>& types;  ///< by vertex
    const std::array<material, seabed::type_count>& materials;
    static constexpr std::uint16_t instance = labels::no_instance;
    static constexpr bool uniform = false;

    template <class Fragments>
    INSONIFY_INLINE std::uint8_t type_at(const Fragments& f, int k) const {
        const glm::uvec3& t = surface.triangles[f.triangles[k]];
        const float a = lane(f.weights[0], k), b = lane(f.weights[1], k), c = lane(f.weights[2], k);
        const std::uint32_t vertex = a >= b ? (a >= c ? t.x : t.z) : (b >= c ? t.y : t.z);
        return static_cast<std::uint8_t>(types[vertex]);
    }
};

/// Shades an object's visible pixels into a picture and its labels.
template <class Shadows, class Labels, class Law, class Object>
class surface_shader {
  public:
    surface_shader(const overhead_geometry& view, const surface_placement& placement, const mesh_view& shape,
                   int subpixel_bits, const Law& law, const Shadows& shadows, const Object& object,
                   image<float>& picture, Labels& marks)
        : placement_(placement),
          mesh_(shape),
          is_near_(view.has_near_light()),
          law_(law),
          shadows_(shadows),
          object_(object),
          picture_(picture),
          labels_(marks),
          left_(0.5f * static_cast<float>(1 - view.rig().size.x)),
          top_(0.5f * static_cast<float>(view.rig().size.y - 1)),
          ray_step_(static_cast<float>(view.ray_step())),
          corner_step_(ray_step_.values[0] * (1 / static_cast<float>(1 << subpixel_bits))),
          altitude_(view.rig().altitude),
          intensity_(view.rig().intensity),
          sky_(view.rig().sky),
          ambient_(view.rig().ambient) {
        const glm::vec3 light(is_near_ ? view.light_position() : view.light().to_light());
        for (int i = 0; i < 3; ++i) to_light_[i] = light[i];
    }

    /// What shows nothing is black.
    void clear(const pixel_box& tile) const {
        for (int y = tile.y0; y <= tile.y1; ++y) std::fill_n(&picture_(tile.x0, y), tile.width(), 0.0f);
    }

    /// Shades the pixels of one tile.
    struct tile_shader {
        const surface_shader& whole;
        decltype(std::declval<const Shadows&>().within(pixel_box{})) shadows;

        template <int N>
        INSONIFY_INLINE void operator()(const fragment_lanes<N, surface_varyings>& f) const {
            whole.shade(f, shadows);
        }
    };
    tile_shader on(const pixel_box& tile) const { return {*this, shadows_.within(tile)}; }

  private:
    static constexpr bool labelled = std::is_same_v<Labels, labels>;

    template <int N, class TileShadows>
    INSONIFY_INLINE void shade(const fragment_lanes<N, surface_varyings>& f, const TileShadows& shadows) const {
        using ints = lanes<std::int32_t, N>;
        using floats = lanes<float, N>;
        const floats side = f.front ? floats{} + 1.0f : floats{} - 1.0f;
        floats normal[3];
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA { f.interpolate(normal[i], i); });
        const floats square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
        floats length;
        square_root<N>(length, square);
        const floats turned = side / length;
        floats to_light[3];
        point_to_light<N>(to_light, f);
        floats sine = turned * (normal[0] * to_light[0] + normal[1] * to_light[1] + normal[2] * to_light[2]);
        sine = sine < 1.0f ? sine : floats{} + 1.0f;

        light_shares<N> shares;
        if constexpr (!std::is_same_v<Shadows, no_shadow_maps>) {
            // A label wants to know who stands in the light even of what faces away.
            const ints useful = labelled ? f.visible : ints(f.visible & ints(sine > 0.0f));
            if constexpr (std::is_same_v<Shadows, exact_shadows>) {
                if (any(useful)) shadows(shares, f, object_.instance, useful);
            } else if (any(useful)) {
                surface_points<N> at;
                at.x = f.x;
                at.y = f.y;
                at.visible = f.visible;
                at.itself = object_.instance == labels::no_instance ? labels::by_seabed : object_.instance;
                const pixel_rays<N> rays(*this, f);
                rays.position(at.position, f);
                facet_normal<N>(at.facet, rays, f, side);
                shadows(shares, at, useful);
            }
        }

        const floats open_sky = 0.5f * (1.0f + turned * normal[2]);
        const ints is_bright = ints(sine > 0.0f) & ints(shares.lit > 0.0f);
        floats direct;
        law<N>(direct, is_bright ? sine : floats{});
        direct = is_bright ? direct : floats{};
        floats intensity, sky, ambient;
        load(intensity, intensity_), load(sky, sky_), load(ambient, ambient_);
        const floats light = intensity * direct * shares.lit + sky * open_sky + ambient;
        std::uint8_t types[static_cast<unsigned>(N)];
        floats reflectivity;
        if constexpr (Object::uniform) {
            reflectivity = floats{} + object_.surface.reflectivity;
            if constexpr (labelled)
                for (std::uint8_t& type : types) type = object_.seabed;
        } else {
            for (int k = 0; k < N; ++k) types[k] = object_.type_at(f, k);
            gather<N>(reflectivity, [&](int k) { return object_.materials[types[k]].reflectivity; });
        }
        const floats one = floats{} + 1.0f;
        floats value = reflectivity * light;
        value = value > one ? one : value;
        store_visible<N>(f, value, picture_);
        if constexpr (labelled)
            for (int k = 0; k < N; ++k) {
                if (lane(f.visible, k) == 0) continue;
                labels_.instance(f.x + k, f.y) = object_.instance;
                labels_.shadow(f.x + k, f.y) = static_cast<std::uint16_t>(lane(shares.caster, k));
                labels_.seabed(f.x + k, f.y) = types[k];
            }
    }

    /// The unit vector to the light.
    template <int N>
    INSONIFY_INLINE void point_to_light(lanes<float, N> (&into)[3],
                                        const fragment_lanes<N, surface_varyings>& f) const {
        using floats = lanes<float, N>;
        for (int i = 0; i < 3; ++i) load(into[i], to_light_[i]);
        if (!is_near_) return;
        floats position[3], square = floats{}, length;
        pixel_rays<N>(*this, f).position(position, f);
        for (int i = 0; i < 3; ++i) {
            into[i] = into[i] - position[i];
            square = square + into[i] * into[i];
        }
        square_root<N>(length, square);
        length = length > 0.0f ? length : floats{} + 1.0f;
        for (int i = 0; i < 3; ++i) into[i] = into[i] / length;
    }

    /// Rays from the camera through pixels' centres, over what they go down.
    template <int N>
    struct pixel_rays {
        using floats = lanes<float, N>;
        using fragments = fragment_lanes<N, surface_varyings>;
        floats altitude, corner_step;
        floats x, y;

        INSONIFY_INLINE pixel_rays(const surface_shader& s, const fragments& f) {
            load(altitude, s.altitude_), load(corner_step, s.corner_step_);
            floats column, step;
            count_up<float, N>(column);
            load(step, s.ray_step_);
            x = (column + (static_cast<float>(f.x) + s.left_)) * step;
            y = (s.top_ - static_cast<float>(f.y)) * step;
        }
        /// Of what the pixels show.
        INSONIFY_INLINE void position(floats (&into)[3], const fragments& f) const {
            f.interpolate(into[2], 3);
            const floats down = altitude - into[2];
            into[0] = x * down;
            into[1] = y * down;
        }
        /// Of the corner of a compact triangle.
        INSONIFY_INLINE void corner(floats (&into)[3], const fragments& f, int i) const {
            into[2] = f.at_corner(i, 3);
            const floats down = altitude - into[2];
            into[0] = (x + f.right[i] * corner_step) * down;
            into[1] = (y - f.down[i] * corner_step) * down;
        }
    };

    /// Normal of the triangle that a pixel shows, on the side that is seen; not unit.
    template <int N>
    INSONIFY_INLINE void facet_normal(lanes<float, N> (&into)[3], const pixel_rays<N>& rays,
                                      const fragment_lanes<N, surface_varyings>& f, const lanes<float, N>& side) const {
        using floats = lanes<float, N>;
        floats corner[3][3], ab[3], ac[3];
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA { rays.corner(corner[i], f, i); });
        if (f.wide != 0) place_corners<N>(corner, f);
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA {
            ab[i] = corner[1][i] - corner[0][i];
            ac[i] = corner[2][i] - corner[0][i];
        });
        into[0] = side * (ab[1] * ac[2] - ac[1] * ab[2]);
        into[1] = side * (ab[2] * ac[0] - ac[2] * ab[0]);
        into[2] = side * (ab[0] * ac[1] - ac[0] * ab[1]);
    }
    /// Those of wide triangles, from the mesh.
    template <int N>
    INSONIFY_INLINE void place_corners(lanes<float, N> (&corner)[3][3],
                                       const fragment_lanes<N, surface_varyings>& f) const {
        for (int k = 0; k < N; ++k) {
            if ((f.wide >> k & 1) == 0) continue;
            for (int i = 0; i < 3; ++i) {
                const glm::vec3 at = placement_.place(mesh_.positions[mesh_.triangles[f.triangles[k]][i]]);
                for (int axis = 0; axis < 3; ++axis) set_lane(corner[i][axis], k, at[axis]);
            }
        }
    }

    template <int N>
    INSONIFY_INLINE static void store_visible(const fragment_lanes<N, surface_varyings>& f,
                                              const lanes<float, N>& value, image<float>& picture) {
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
            gather<N>(into, [&](int k) { return law_(lane(sine, k)); });
    }

    const surface_placement& placement_;
    mesh_view mesh_;
    bool is_near_;
    Law law_;
    const Shadows& shadows_;
    Object object_;
    image<float>& picture_;
    Labels& labels_;
    float left_, top_;                      ///< from the picture's middle to the first pixel's centre, in pixels
    spread<float> ray_step_, corner_step_;  ///< how far the ground is from pixel to pixel, and from sub-pixel to
                                            ///< sub-pixel, seen from a height of one
    spread<float> altitude_, intensity_, sky_, ambient_;  ///< the rig's
    spread<float> to_light_[3];                           ///< where it stands, if it is near
};

}  // namespace detail
}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
