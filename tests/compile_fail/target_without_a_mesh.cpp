// A target's shape needs a mesh.
// expect: a target's shape is a mesh, a shared_mesh, or of a type with a function to_mesh
#include <insonify/insonify.hpp>

namespace in = insonify;

namespace user {
struct anchor {};
#if !defined(INSONIFY_COMPILE_FAIL)
in::mesh to_mesh(const anchor&) {
    return to_mesh(in::cube{});
}
#endif
}  // namespace user

void add_anchor(in::scene& scene) {
    scene.add(user::anchor{}, {}, "anchor");
}
