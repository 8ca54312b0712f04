// Randomly scattered features, at most one per lattice cell: finds those that a row crosses, and adds round ones.
#pragma once

#include <insonify/seabed/detail/interpolation.hpp>
#include <insonify/seabed/detail/stretch.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

/// Calls `visit(first, count)` for runs of lattice columns whose features may reach a sample of the stretch: each such
/// column once, in rising order.
/// @param reach  columns that a feature extends beyond its own
template <class Visit>
INSONIFY_INLINE void visit_columns(const lattice& l, const stretch& part, std::int64_t reach, Visit&& visit) {
    const std::int64_t first = numeric::floor_to_int(l.u(part.x[0])), last = numeric::floor_to_int(l.u(part.last()));
    const bool sparse = last - first > 4 * static_cast<std::int64_t>(part.count);
    std::int64_t next = first - reach;
    for (std::size_t i = sparse ? 0 : part.count - 1; i < part.count; ++i) {
        // Where samples are far apart, columns between them reach none.
        const std::int64_t column = numeric::floor_to_int(l.u(part.x[i]));
        if (sparse) next = (std::max)(next, column - reach);
        const std::int64_t count = column + reach + 1 - next;
        if (count > 0) visit(next, count);
        next += (std::max)(count, std::int64_t{0});
    }
}

/// Mounds and pockmarks: a cell holds one round bump or dent, wholly inside it, or none.
class round_marks {
  public:
    round_marks() = default;
    /// @param cell          metres
    /// @param filled, high  fractions of all cells that hold a mark, and that hold a mound
    /// @param mound, pock   height and depth of the largest, metres
    round_marks(double cell, float filled, float high, float mound, float pock, cell_hash hash)
        : hash_(hash), filled_(filled), high_(high), mound_(mound), pock_(-pock) {
        lattice_.frequency = 1 / cell;
    }

    void add(const stretch& part, stretch_values& values, isa level = best_isa()) const {
        if (filled_ > 0) add_relief(*this, part, values, level);
    }

    /// The largest dent and the largest bump, metres; 0 where there are none.
    double lowest() const { return filled_ > high_ ? 1.00001 * static_cast<double>(pock_) : 0; }
    double highest() const { return high_ > 0 ? 1.00001 * static_cast<double>(mound_) : 0; }

  private:
    friend relief_kernel<round_marks>;

    template <int N>
    INSONIFY_INLINE void add_lanes(const stretch& part, float* values) const {
        const lattice& l = lattice_;
        const float band_gain = band_limit_gain(1 / l.frequency, part.grid_spacing);  // the largest span half a cell
        if (band_gain == 0) return;
        const lattice_coordinate v(l.v(part.y));
        const cell_hash::row hash = hash_[v.cell];
        visit_columns(l, part, 0, [&](std::int64_t first, std::int64_t count) INSONIFY_INLINE_LAMBDA {
            for (std::int64_t column = first; column < first + count; ++column)
                add_mark<N>(part, values, band_gain, v.fraction, column, hash(column));
        });
    }

    template <int N>
    INSONIFY_INLINE void add_mark(const stretch& part, float* values, float band_gain, float up, std::int64_t column,
                                  std::uint64_t bits) const {
        const lattice& l = lattice_;
        const signed_pair centre(bits), traits(scramble(bits));
        const float chance = 0.5f * traits.b + 0.5f;
        if (chance >= filled_) return;
        const float radius = 0.175f + 0.075f * traits.a;  // in cells; a quarter at most
        const float y = up - (0.5f + 0.25f * centre.b);
        const float y_square = y * y, inverse_square = 1 / (radius * radius);
        if (y_square >= radius * radius) return;
        const float height = band_gain * ((chance < high_ ? mound_ : pock_) * (radius * 4));

        const double middle = 0.5 + 0.25 * static_cast<double>(centre.a), reach = static_cast<double>(radius);
        const double left = static_cast<double>(column) + middle;
        const double cell = 1 / l.frequency;
        const stretch::range reached = part.within((left - reach) * cell, (left + reach) * cell);
        for (std::size_t i = reached.begin; i < reached.end; i += N) {
            lanes<float, N> dx, inside, sum;
            offsets<N>(dx, &part.x[i], l.frequency, -left);
            inside = 1.0f - (dx * dx + y_square) * inverse_square;
            saturate_lanes(inside);
            insonify::detail::load(sum, values + i);
            sum = sum + height * inside * inside;
            insonify::detail::store(values + i, sum);
        }
    }

    lattice lattice_;
    cell_hash hash_{0, stream::mounds};
    float filled_ = 0, high_ = 0, mound_ = 0, pock_ = 0;
};

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
