// fwd.hpp alone is enough for the declarations of a user's header; what they declare is what the library defines.
#include <insonify/fwd.hpp>

namespace user {

namespace in = insonify;

struct survey {
    const in::scene* scene = nullptr;
    const in::seabed::any* seabed = nullptr;
    in::seabed::type kind{};
    in::isa level{};
};

in::frame<> draw(const in::scene& scene, const in::overhead& rig, in::executor_ref ex);
in::frame<in::no_labels> draw_unlabelled(const in::scene& scene, const in::overhead& rig);
in::image<in::rgb8> colored(const in::image<float>& picture, const in::color_table& colors);
void look(in::image_view<float> picture, const in::speckle& noise, const in::match_histogram& match);
void place(in::scene& scene, const in::shared_mesh& shape, const in::pose& placement, const in::seabed::ripples& sand);

template <class T>
constexpr bool is_complete = requires {
    sizeof(T);
};
static_assert(!is_complete<in::overhead>);

}  // namespace user

#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>

namespace user {

in::frame<> draw(const in::scene& scene, const in::overhead& rig, in::executor_ref) {
    return {in::image<float>(rig.size.x, rig.size.y, static_cast<float>(scene.targets.size())), {}, {}, {}};
}
in::frame<in::no_labels> draw_unlabelled(const in::scene&, const in::overhead&) {
    return {};
}
in::image<in::rgb8> colored(const in::image<float>& picture, const in::color_table& colors) {
    return picture | colors;
}
void look(in::image_view<float> picture, const in::speckle& noise, const in::match_histogram& match) {
    picture | (match | noise);
}
void place(in::scene& scene, const in::shared_mesh& shape, const in::pose& placement, const in::seabed::ripples& sand) {
    scene.seabed = sand;
    scene.add(shape, placement, "shape");
}

// A name that fwd.hpp declares and the library defines elsewhere is ambiguous, or stays incomplete.
template <class... T>
constexpr bool are_defined = (... && (sizeof(T) > 0));
static_assert(are_defined<in::affine, in::bounding_box, in::camera, in::capsule, in::cone, in::context, in::cube,
                          in::cylinder, in::hemisphere, in::invalid_input, in::io_error, in::mesh, in::mesh_view,
                          in::rect, in::serial_executor, in::sphere, in::thread_pool>);
static_assert(
    are_defined<in::distribution, in::equalize, in::gaussian, in::histogram, in::match_binned, in::salt_and_pepper,
                in::lambert, in::lambert_backscatter, in::material, in::ping, in::ping_numbers, in::render_stats,
                in::side_scan_rig<in::across_track::slant_range>, in::target, in::target_label, in::visibility>);
static_assert(are_defined<in::seabed::flat, in::seabed::grid, in::seabed::heightfield, in::seabed::mud,
                          in::seabed::none, in::seabed::rock, in::seabed::sediment, in::seabed::type_properties,
                          in::shadow::exact, in::shadow::map, in::shadow::none, in::shadow::pcf, in::shadow::penumbra>);

}  // namespace user
