// Vectors and matrices: products with fixed rounding, dominant axes, and whether coordinates are finite. GLM's products
// may be compiled with fused multiply-add, which would make pictures depend on compiler flags. Storage, sums and
// scalings are GLM's.
#pragma once

#include <insonify/core/numeric.hpp>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace numeric {

inline namespace INSONIFY_FLAGS {

/// Whether no coordinate is NaN or infinite.
template <class T>
INSONIFY_INLINE bool is_finite(const glm::vec<3, T>& v) {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

/// Dot product.
template <class T>
INSONIFY_INLINE T dot(const glm::vec<3, T>& a, const glm::vec<3, T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// Dot product in the plane.
template <class T>
INSONIFY_INLINE T dot(const glm::vec<2, T>& a, const glm::vec<2, T>& b) {
    return a.x * b.x + a.y * b.y;
}

/// Euclidean length.
template <int L, class T>
INSONIFY_INLINE T length(const glm::vec<L, T>& v) {
    return square_root(dot(v, v));
}

/// Cross product.
template <class T>
INSONIFY_INLINE glm::vec<3, T> cross(const glm::vec<3, T>& a, const glm::vec<3, T>& b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
/// Cross product in the plane: the signed area of the parallelogram, positive if `b` is counter-clockwise from `a`.
template <class T>
INSONIFY_INLINE T cross(const glm::vec<2, T>& a, const glm::vec<2, T>& b) {
    return a.x * b.y - a.y * b.x;
}

/// Axis of the component of largest magnitude, the first of equal ones.
template <class T>
INSONIFY_INLINE int dominant_axis(const glm::vec<3, T>& v) {
    const T x = abs(v.x), y = abs(v.y), z = abs(v.z);
    return x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
}

/// m v, as GLM stores matrices: by columns.
template <class T>
INSONIFY_INLINE glm::vec<3, T> product(const glm::mat<3, 3, T>& m, const glm::vec<3, T>& v) {
    return {m[0].x * v.x + m[1].x * v.y + m[2].x * v.z, m[0].y * v.x + m[1].y * v.y + m[2].y * v.z,
            m[0].z * v.x + m[1].z * v.y + m[2].z * v.z};
}

/// The same for three coordinates that may be SIMD lanes; `into` and `v` must not overlap.
template <class Floats>
INSONIFY_INLINE void product(Floats* into, const glm::mat3& m, const Floats* v) {
    into[0] = m[0].x * v[0] + m[1].x * v[1] + m[2].x * v[2];
    into[1] = m[0].y * v[0] + m[1].y * v[1] + m[2].y * v[2];
    into[2] = m[0].z * v[0] + m[1].z * v[1] + m[2].z * v[2];
}

/// Matrix product a b.
template <class T>
glm::mat<3, 3, T> product(const glm::mat<3, 3, T>& a, const glm::mat<3, 3, T>& b) {
    return {product(a, b[0]), product(a, b[1]), product(a, b[2])};
}

/// Cofactor matrix: det(m) times the inverse transpose, which transforms area vectors (cross products of edges).
template <class T>
glm::mat<3, 3, T> cofactors(const glm::mat<3, 3, T>& m) {
    return {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
}

/// Determinant of a matrix.
template <class T>
T determinant(const glm::mat<3, 3, T>& m) {
    return dot(m[0], cross(m[1], m[2]));
}

}  // namespace INSONIFY_FLAGS

}  // namespace numeric
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
