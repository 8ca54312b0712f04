// Normals of a heightfield, by finite differences of its vertices.
//
// Central differences resolve the relief of the drawn mesh and nothing finer, for every model. The slope of a wave of n
// vertices is reduced by sin(2 pi / n) / (2 pi / n): 0.90 at 8, 0.97 at 16.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/seabed/detail/central_difference.hpp>
#include <insonify/seabed/heightfield.hpp>

#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

namespace detail::inline INSONIFY_FLAGS {

/// The normals of one row of vertices.
class row_normals {
  public:
    /// @param out  one for each vertex of the row
    row_normals(const heightfield& field, int row, glm::vec3* out)
        : width_(static_cast<std::size_t>(field.heights.width())),
          here_(field.heights.row(row).data()),
          back_(field.heights.row(row > 0 ? row - 1 : row).data()),
          ahead_(field.heights.row(row + 1 < field.heights.height() ? row + 1 : row).data()),
          inner_(row > 0 && row + 1 < field.heights.height()),
          z_(2 * static_cast<float>(field.spacing)),
          out_(out) {}

    void compute() const { insonify::detail::dispatch(*this, best_isa()); }

    template <int N>
    INSONIFY_INLINE void run() const {
        using floats = insonify::detail::lanes<float, N>;
        using ints = insonify::detail::lanes<std::int32_t, N>;
        using insonify::detail::load;
        compute_one(0);
        std::size_t i = 1;
        const float twice = inner_ ? 1.0f : 2.0f;  // one-sided differences at an edge are doubled
        for (; i + N < width_; i += N) {
            floats left, right, back, ahead, here, length, x, y;
            load(left, here_ + i - 1);
            load(right, here_ + i + 1);
            load(back, back_ + i);
            load(ahead, ahead_ + i);
            load(here, here_ + i);
            // Missing data is rare and takes the scalar path.
            ints bits;
            const floats known = (left - left) + (right - right) + (back - back) + (ahead - ahead) + (here - here);
            std::memcpy(&bits, &known, sizeof bits);
            if (insonify::detail::any(ints((bits & 0x7FFFFFFF) != 0))) {
                for (std::size_t k = 0; k < N; ++k) compute_one(i + k);
                continue;
            }
            x = right - left;
            y = twice * (ahead - back);
            insonify::detail::square_root<N>(length, x * x + y * y + z_ * z_);
            const floats inverse = 1.0f / length;
            float stored[3][static_cast<std::size_t>(N)];
            insonify::detail::store(stored[0], floats((0.0f - x) * inverse));
            insonify::detail::store(stored[1], floats((0.0f - y) * inverse));
            insonify::detail::store(stored[2], floats(z_ * inverse));
            for (std::size_t k = 0; k < N; ++k) out_[i + k] = {stored[0][k], stored[1][k], stored[2][k]};
        }
        for (; i < width_; ++i) compute_one(i);
    }

  private:
    void compute_one(std::size_t i) const {
        const std::size_t left = i > 0 ? i - 1 : i, right = i + 1 < width_ ? i + 1 : i;
        const float dx = central_difference(here_[left], here_[i], here_[right], right - left == 2);
        const float dy = central_difference(back_[i], here_[i], ahead_[i], inner_);
        const float inverse = 1 / numeric::square_root(dx * dx + dy * dy + z_ * z_);
        out_[i] = {(0.0f - dx) * inverse, (0.0f - dy) * inverse, z_ * inverse};
    }

    std::size_t width_;
    const float *here_, *back_, *ahead_;
    bool inner_;
    float z_;  // twice the spacing
    glm::vec3* out_;
};

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Unit normals at the vertices of a heightfield, by central differences, one-sided at edges and beside missing
/// vertices; straight up at these.
/// @throws invalid_input as `validate`
template <executor_argument Executor = serial_executor>
image<glm::vec3> normals(const heightfield& field, Executor&& ex = serial_executor{}) {
    validate(field);
    image<glm::vec3> result(field.heights.width(), field.heights.height(), insonify::detail::uninitialized{});
    ex.bulk(static_cast<std::size_t>(field.heights.height()), [&](std::size_t j) {
        const int row = static_cast<int>(j);
        detail::row_normals(field, row, result.row(row).data()).compute();
    });
    return result;
}

}  // namespace INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
