// The OBJ reader on any text: it makes a mesh that can be drawn, or refuses by its own error.
#include <insonify/geometry/obj.hpp>

#include <cmath>
#include <string_view>

#include "fuzz.hpp"

namespace in = insonify;
using fuzzing::demand;

namespace {

bool is_finite(const glm::vec3& v) {
    return in::numeric::is_finite(v.x) && in::numeric::is_finite(v.y) && in::numeric::is_finite(v.z);
}
bool is_unit(const glm::vec3& v) {
    const glm::dvec3 n(v);
    return std::abs(in::numeric::dot(n, n) - 1) < 1e-6;
}

void check(const in::mesh& m, std::size_t characters) {
    demand(!m.triangles.empty(), "a text without a face is refused");
    // "f 1 1 1" takes two characters for a corner, and a corner makes at most one triangle.
    demand(m.triangles.size() <= characters / 2, "a mesh is not larger than its text");
    demand(m.positions.size() <= 3 * m.triangles.size(), "every position is used");
    demand(m.normals.size() == m.positions.size(), "there is one normal per position");
    for (const glm::uvec3& t : m.triangles)
        for (int i = 0; i < 3; ++i) demand(t[i] < m.positions.size(), "every index has a position");
    for (const glm::vec3& p : m.positions) demand(is_finite(p), "positions are finite");
    for (const glm::vec3& n : m.normals) demand(is_unit(n), "normals are of unit length");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        check(in::read_obj(text), size);
    } catch (const in::io_error&) {  // anything else that is thrown ends the program
    }
    try {
        const in::textured_mesh m = in::read_textured_obj(text);
        check(m.shape, size);
        demand(m.texture_coordinates.size() == m.shape.positions.size(),
               "there is one texture coordinate per position");
        for (const glm::vec2& t : m.texture_coordinates) demand(is_finite({t, 0}), "texture coordinates are finite");
    } catch (const in::io_error&) {
    }
    return 0;
}
