// Declares the common public types, for headers that only name them. Includes config.hpp alone: no other header of the
// library, no GLM.
//
//     #include <insonify/fwd.hpp>
//     insonify::frame<> draw_pipeline(const insonify::scene& survey, const insonify::overhead& rig);
//
// Of filters and seabeds, only the most used are listed; include the header of any other.
#pragma once

#include <insonify/config.hpp>

#include <cstdint>

namespace insonify {
inline namespace INSONIFY_ABI {

// Images and executors
template <class T>
struct rgb;
using rgb8 = rgb<std::uint8_t>;
template <class T>
class image;
template <class T>
class image_view;
struct rect;
class context;
class executor_ref;
struct serial_executor;
class thread_pool;
enum class isa;

// Errors
struct invalid_input;
struct io_error;

// Shapes
struct affine;
struct bounding_box;
struct camera;
struct capsule;
struct cone;
struct cube;
struct cylinder;
struct hemisphere;
struct mesh;
struct mesh_view;
struct pose;
class shared_mesh;
struct sphere;

namespace seabed {

class any;
struct flat;
struct grid;
struct heightfield;
struct mud;
struct none;
struct ripples;
struct rock;
enum class sediment : std::uint8_t;
enum class type : std::uint8_t;
struct type_properties;

}  // namespace seabed

namespace shadow {

struct exact;
struct map;
struct none;
struct pcf;
struct penumbra;

}  // namespace shadow

// Filters
struct color_table;
struct distribution;
struct equalize;
struct gaussian;
struct histogram;
class match_binned;
class match_histogram;
struct salt_and_pepper;
struct speckle;

// Pictures and recordings
struct labels;
struct lambert;
struct lambert_backscatter;
struct material;
struct no_labels;
struct overhead;
struct ping;
struct ping_numbers;
struct render_stats;
struct scene;
struct target;
struct target_label;
struct visibility;
enum class across_track;
template <across_track Axis>
struct side_scan_rig;
template <class Labels = labels>
struct frame;

}  // namespace INSONIFY_ABI
}  // namespace insonify
