// Tests the triangles of one caster against the receivers of a tile: an irregular shadow map, whose samples are the
// receivers themselves.
//
// Each triangle is compared with the receivers of the cells that it touches, several at a time, in float. Results
// within the error of float are decided in double (light_rays.hpp), so that every pair of triangle and receiver has the
// result of the test in double. A receiver's own triangle is skipped by its index; there is no bias.
//
// Based on: Timo Aila, Samuli Laine. Alias-Free Shadow Maps. EGSR 2004. Gregory S. Johnson, Juhyun Lee, Christopher A.
// Burns, William R. Mark. The Irregular Z-Buffer: Hardware Acceleration for Irregular Data Structures. ACM TOG 24,
// 2005.
#pragma once

#include <insonify/shadow/detail/occluders.hpp>
#include <insonify/shadow/detail/receivers.hpp>

#include <bit>
#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// Marks the receivers of a tile that a caster blocks and no earlier caster has blocked.
/// @tparam Decide  decide(triangle, i): whether the triangle blocks receiver i, in doubles
template <class Decide>
struct occlusion_kernel {
    const plane_caster& caster;
    std::span<const insonify::detail::triangle_run> runs;
    std::uint32_t number;  ///< of the caster
    skip may_skip;
    bool front_is_clockwise;  ///< triangles that face the light are clockwise
    float error;              ///< of coordinates on the plane, before they are rounded to float
    receiver_cells& receivers;
    const Decide& decide;

    template <int N>
    INSONIFY_INLINE void run() const {
        insonify::detail::run_reader reader(runs);
        std::uint32_t ids[static_cast<unsigned>(2 * N)];
        while (!reader.empty()) {
            const int count = reader.take_small<N>(ids);
            triangles<N>(ids, count);
        }
    }

  private:
    template <int N>
    INSONIFY_INLINE void triangles(const std::uint32_t* ids, int count) const {
        using namespace insonify::detail;
        using floats = lanes<float, N>;
        using ints = lanes<std::int32_t, N>;
        constexpr int stride = N > 1 ? N / 2 : 1;
        for (int k = 0; k < count; k += stride) caster.prefetch(ids[k] + 2 * N);
        const plane_triangles<N> t([&](int k, int i) -> const plane_vertex& { return caster.corner(ids[k], i); });

        // Cells, with a margin for rounding, and the magnitude of the operands, which bounds the error.
        ints first[2], last[2], missed{};
        floats extent[2], size{};
        unroll<2>([&](int axis) INSONIFY_INLINE_LAMBDA {
            floats low, high;
            range_of(low, high, t.a[axis], t.b[axis], t.c[axis]);
            const float lower = receivers.lower()[axis], scale = receivers.scale()[axis];
            const float last_cell = static_cast<float>(axis == 0 ? receivers.columns() - 1 : receivers.rows() - 1);
            const floats largest_coordinate = high < 0.0f - low ? 0.0f - low : high;
            size = largest_coordinate > size ? largest_coordinate : size;
            const floats margin = 0x1p-20f * (largest_coordinate + receivers.largest()) + error;
            const floats f = (low - margin - lower) * scale, l = (high + margin - lower) * scale;
            missed |= ints(f >= last_cell + 1.0f) | ints(l < 0.0f);
            const ints behind = ints(t.state > 0.0f);
            missed = missed & ~behind;
            cells_between<N>(first[axis], last[axis], f, l, last_cell, behind);
            extent[axis] = (high - low) + 2.0f * receivers.cell()[axis];
        });
        floats low, high;
        range_of(low, high, t.a[2], t.b[2], t.c[2]);
        const float receiver_rounding = 0x1.2p-24f * (std::max)(receivers.highest(), -receivers.lowest()) + error;
        const floats height_rounding = 0x1.2p-24f * (high > 0.0f - low ? high : 0.0f - low) + receiver_rounding;
        missed |=
            ints(high + 2.0f * height_rounding < receivers.lowest()) & ints(t.state == 0.0f);  // below all receivers
        floats ab[3], ac[3];
        unroll<3>([&](int axis) INSONIFY_INLINE_LAMBDA {
            ab[axis] = t.b[axis] - t.a[axis];
            ac[axis] = t.c[axis] - t.a[axis];
        });
        floats area = ab[0] * ac[1] - ab[1] * ac[0];
        const floats area_error = 0x1p-20f * (size + receivers.largest()) * (extent[0] + extent[1]);
        const ints facing = ints((front_is_clockwise ? 0.0f - area : area) > area_error) & ints(t.state == 0.0f);
        const bool all_skip = may_skip == skip::facing
                                  ? !receivers.may_be_on_back_side(number)
                                  : may_skip == skip::facing_self && receivers.are_on_lit_side(number);
        if (all_skip) missed |= facing;
        const unsigned candidates = ~movemask<N>(missed) & ((2u << (count - 1)) - 1);
        if (candidates == 0) return;
        const unsigned some_skip = may_skip != skip::nothing ? movemask<N>(facing) : 0;
        // Counter-clockwise on the plane.
        const ints is_clockwise = ints(area < 0.0f);
        unroll<3>([&](int axis) INSONIFY_INLINE_LAMBDA { exchange(is_clockwise, ab[axis], ac[axis]); });
        area = is_clockwise ? 0.0f - area : area;
        // The rounding error of a coordinate is half a unit in the last place, of a difference twice that; the two
        // products add their own.
        const floats coordinate_error =
            0x1.2p-24f * (size > receivers.largest() ? size : floats{} + receivers.largest()) + error;
        const floats box = extent[0] * extent[1];
        floats edge_error = 4.5f * coordinate_error * (extent[0] + extent[1]) + 0x1p-21f * box;
        const floats slopes = (ab[2] < 0.0f ? 0.0f - ab[2] : ab[2]) + (ac[2] < 0.0f ? 0.0f - ac[2] : ac[2]);
        floats height_error = (edge_error + 0x1p-20f * box) * slopes + 10.0f * box * height_rounding;
        const floats height_error_per_unit =
            3.0f * edge_error + 0x1p-21f * box;  // per unit of height between corner a and the receiver
        edge_error = t.state == 0.0f ? edge_error : floats{} + std::numeric_limits<float>::infinity();
        height_error = t.state == 0.0f ? height_error : floats{} + std::numeric_limits<float>::infinity();

        float values[12][static_cast<unsigned>(N)];
        std::int32_t cells[4][static_cast<unsigned>(N)];
        unroll<3>([&](int axis) INSONIFY_INLINE_LAMBDA {
            store(values[axis], t.a[axis]);
            store(values[3 + axis], ab[axis]);
            store(values[6 + axis], ac[axis]);
        });
        store(values[9], edge_error);
        store(values[10], height_error);
        store(values[11], height_error_per_unit);
        unroll<2>([&](int axis) INSONIFY_INLINE_LAMBDA {
            store(cells[axis], first[axis]);
            store(cells[2 + axis], last[axis]);
        });
        for (unsigned left = candidates; left != 0; left &= left - 1) {
            const auto k = static_cast<std::size_t>(std::countr_zero(left));
            const float one[12] = {values[0][k], values[1][k], values[2][k],  values[3][k],
                                   values[4][k], values[5][k], values[6][k],  values[7][k],
                                   values[8][k], values[9][k], values[10][k], values[11][k]};
            const skip skips = (some_skip >> k & 1) != 0 ? may_skip : skip::nothing;
            for (int row = cells[1][k]; row <= cells[3][k]; ++row)
                compare<N>(one, ids[k], skips, receivers.start(row, cells[0][k]),
                           receivers.start(row, cells[2][k] + 1));
        }
    }

    /// One triangle with the receivers [first, last).
    /// @param skips  the receivers that it is skipped for
    template <int N>
    INSONIFY_INLINE void compare(const float (&t)[12], std::uint32_t id, skip skips, std::uint32_t first,
                                 std::uint32_t last) const {
        using namespace insonify::detail;
        using floats = lanes<float, N>;
        using ints = lanes<std::int32_t, N>;
        ints column;
        iota<std::int32_t, N>(column);
        const float *const us = receivers.u.data(), *const vs = receivers.v.data(),
                           *const heights = receivers.height.data();
        std::int32_t* const casters = receivers.caster.data();
        const float area = t[3] * t[7] - t[4] * t[6];
        for (std::uint32_t i = first; i < last; i += N) {
            floats u, v, height;
            ints mesh, triangle, lit_mesh, blocked;
            load(u, us + i);
            load(v, vs + i);
            load(height, heights + i);
            load(blocked, casters + i);
            u = u - t[0];
            v = v - t[1];
            height = height - t[2];
            const floats to_c = t[3] * v - t[4] * u, to_b = t[7] * u - t[6] * v;  // weights of c and b, times the area
            const floats to_a = area - to_b - to_c;
            const floats above = area * height - (to_b * t[5] + to_c * t[8]);
            const floats error_bound = t[10] + t[11] * (height < 0.0f ? 0.0f - height : height);
            const ints out =
                ints(to_b < -t[9]) | ints(to_c < -t[9]) | ints(to_a < -3 * t[9]) | ints(above > error_bound);
            const ints candidates = ints(out == 0) & ints(blocked == receiver_cells::unblocked) &
                                    ints(column < static_cast<std::int32_t>(last - i));
            if (!any(candidates)) continue;
            load(mesh, receivers.mesh.data() + i);
            load(triangle, receivers.triangle.data() + i);
            const ints is_own = ints(mesh == static_cast<std::int32_t>(number));
            ints skipped = is_own & ints(triangle == static_cast<std::int32_t>(id));
            if (skips != skip::nothing) {
                load(lit_mesh, receivers.lit_mesh.data() + i);
                skipped |= ints(lit_mesh == static_cast<std::int32_t>(number));
                if (skips == skip::facing) skipped |= ~is_own;
            }
            const ints tested = candidates & ~skipped;
            const ints certain = tested & ints(to_b > t[9]) & ints(to_c > t[9]) & ints(to_a > 3 * t[9]) &
                                 ints(above < 0.0f - error_bound);
            store(casters + i, ints(certain ? ints{} + static_cast<std::int32_t>(number) : blocked));
            for (unsigned left = movemask<N>(ints(tested & ~certain)); left != 0; left &= left - 1) {
                const std::size_t at = i + static_cast<std::size_t>(std::countr_zero(left));
                if (decide(id, at)) casters[at] = static_cast<std::int32_t>(number);
            }
        }
    }
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
