// Angular blocks scattered over the plane, for broken rock.
//
// Each cell of a lattice may hold one flat-topped, tilted, eight-sided block with steep walls; the surface is the
// highest of the blocks that reach a point. Where blocks are many they meet in Voronoi-like edges, where they are few
// they are boulders.
//
// Based on: Steven Worley. A Cellular Texture Basis Function. SIGGRAPH, 1996.
#pragma once

#include <insonify/seabed/detail/strewn.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

/// One size class of blocks. Continuous; walls no steeper than `steepness`.
class block_layer {
  public:
    /// @param cell       metres: blocks reach 0.3 to 0.9 of it from their centre
    /// @param coverage   in [0, 1]: fraction of the cells that hold a block
    /// @param height     metres: of the highest blocks
    /// @param steepness  slope of the walls
    block_layer(double cell, float coverage, float height, float steepness, cell_hash hash)
        : lattice_(lattice::shifted(cell, hash)),
          hash_(hash),
          coverage_(static_cast<std::int32_t>(coverage * 65536)),
          height_(height),
          wall_(steepness * static_cast<float>(cell)) {}

    /// Gain of the band limit: 1 where the stretch's grid resolves the blocks, 0 where it can't.
    float band_gain_on(const stretch& part) const { return band_limit_gain(2 / lattice_.frequency, part.grid_spacing); }

    /// Raises the values along a stretch, metres, to the tops of the blocks; values between blocks stay.
    template <int N>
    INSONIFY_INLINE void raise(const stretch& part, float* values) const {
        const lattice_coordinate v(lattice_.v(part.y));
        for (int j = -1; j <= 1; ++j) {
            const cell_hash::row hash = hash_[v.cell + j];
            const float dy = v.fraction - static_cast<float>(j) - 0.5f;
            visit_columns(lattice_, part, 1, [&](std::int64_t first, std::int64_t count) INSONIFY_INLINE_LAMBDA {
                for (std::int64_t column = first; column < first + count; column += N) {
                    found<N> some;
                    if (!some.find(*this, hash, dy, static_cast<std::uint32_t>(column), first + count - column))
                        continue;
                    for (int k = 0; k < N; ++k)
                        if (some.is_crossed[k] != 0) raise_to_block<N>(part, values, column + k, block(*this, some, k));
                }
            });
        }
    }

    /// Upper bound of the heights, metres: the middle of the widest block has 0.9 * 1.1 of the height; a top tilts by
    /// half the height per cell along each axis, and its corners are 0.975 of a cell away.
    double upper_bound() const { return 1.00001 * (0.99 + 0.5 * 1.41422 * 0.975) * static_cast<double>(height_); }

  private:
    /// The blocks of N adjacent cells that a row crosses, in most cells none.
    template <int N>
    struct found {
        static constexpr std::size_t size = static_cast<std::size_t>(N);
        alignas(32) std::int32_t is_crossed[size];
        alignas(32) std::uint32_t seeds[size];
        alignas(32) float x[size], y[size], radius[size], chord[size];  // in cells, from the block's centre

        INSONIFY_INLINE bool find(const block_layer& layer, const cell_hash::row& hash, float dy, std::uint32_t column,
                                  std::int64_t columns) {
            using words = lanes<std::uint32_t, N>;
            using ints = lanes<std::int32_t, N>;
            using floats = lanes<float, N>;
            words number, first, second;
            insonify::detail::iota<std::uint32_t, N>(number);
            hash.hash_lanes(first, words(number + column));
            second = (first ^ (first >> 15)) * 0x2C1B3C6Du;
            second = (second ^ (second >> 12)) * 0x297A2D39u;
            second = second ^ (second >> 15);
            const auto signed_fraction = [](floats& into, const words& bits) INSONIFY_INLINE_LAMBDA {
                insonify::detail::convert(into, ints(ints(bits) >> 16));  // the upper half, in [-1/2, 1/2)
                into = into * 0x1p-16f;
            };
            floats up, form, along;
            signed_fraction(up, first);
            signed_fraction(along, second);
            signed_fraction(form, words(second << 16));
            up = dy - up;
            // Medium sizes are the most frequent.
            const floats reach = 0.6f + 1.2f * form * (form < 0.0f ? -form : form);
            // The corners of an octagon lie 1 / cos(pi / 8) from its centre, at most 0.975 of a cell: within one
            // column.
            floats half = reach * reach * 1.1715729f - up * up;
            const ints zero{}, one = zero + 1;
            const auto limit = static_cast<std::uint32_t>((std::min)(columns, std::int64_t{N}));
            const ints chance = ints(first & 0xFFFFu);
            const ints crossed = (half > 0.0f ? one : zero) & (chance < layer.coverage_ ? one : zero) &
                                 (ints(number) < static_cast<std::int32_t>(limit) ? one : zero);
            if (!insonify::detail::any(ints(crossed != 0))) return false;
            half = half > 0.0f ? half : floats{};
            insonify::detail::square_root<N>(half, half);
            insonify::detail::store(is_crossed, crossed);
            insonify::detail::store(seeds, words(first ^ second));
            insonify::detail::store(x, along);
            insonify::detail::store(y, up);
            insonify::detail::store(radius, reach);
            insonify::detail::store(chord, half);
            return true;
        }
    };

    /// The cross section of a block along one row; all terms in y are already evaluated.
    struct block {
        template <int N>
        INSONIFY_INLINE block(const block_layer& layer, const found<N>& some, int k) {
            const std::uint64_t bits = scramble(some.seeds[k] * std::uint64_t{0x9E3779B97F4A7C15u});
            const auto part = [&](int shift) {
                return static_cast<float>(static_cast<std::int16_t>(static_cast<std::uint16_t>(bits >> shift))) *
                       0x1p-15f;
            };
            const float y = some.y[k];
            x = 0.5f + some.x[k];
            radius = some.radius[k];
            chord = some.chord[k];
            // An octagon repeats every eighth of a turn: 16 headings within one.
            constexpr float headings[] = {1.0f,        0.99879546f, 0.99518473f, 0.98917651f, 0.98078528f, 0.97003125f,
                                          0.95694034f, 0.94154407f, 0.92387953f, 0.90398929f, 0.88192126f, 0.85772861f,
                                          0.83146961f, 0.80320753f, 0.77301045f, 0.74095113f};
            constexpr float sines[] = {0.0f,        0.049067674f, 0.09801714f, 0.14673047f, 0.19509032f, 0.24298018f,
                                       0.29028468f, 0.33688985f,  0.38268343f, 0.42755509f, 0.47139674f, 0.51410274f,
                                       0.55557023f, 0.59569930f,  0.63439328f, 0.67155895f};
            cosine = headings[bits & 15];
            sine = sines[bits & 15];
            u = y * sine;
            v = y * cosine;
            wall = layer.wall_;
            // Height grows with width; a tilted top makes one side a ramp and the other a cliff.
            const float middle = layer.height_ * radius * (0.7f + 0.4f * part(48));
            tilt = 0.5f * layer.height_ * part(16);
            top = middle + 0.5f * layer.height_ * part(32) * y;
        }

        float x;             // of the centre, in cells from the left side of its cell
        float cosine, sine;  // of its heading
        float u, v;          // terms of y in the coordinates along and across the heading
        float radius;        // in cells
        float chord;         // half the row's chord of the circumscribed circle
        float wall;          // metres per cell
        float top, tilt;     // metres at x, and metres per cell along the row

        template <class Lanes>
        INSONIFY_INLINE void height_at(Lanes& height, const Lanes& dx) const {
            Lanes along = dx * cosine + u, across = v - dx * sine;
            along = along < 0.0f ? -along : along;
            across = across < 0.0f ? -across : across;
            // The octagon norm: the widest of the four pairs of sides.
            const Lanes wider = along > across ? along : across, corner = 0.70710678f * (along + across);
            const Lanes distance = wider > corner ? wider : corner;
            const Lanes roof = top + tilt * dx, side = (radius - distance) * wall;
            height = roof < side ? roof : side;
        }
    };

    template <int N>
    INSONIFY_INLINE void raise_to_block(const stretch& part, float* values, std::int64_t column, const block& b) const {
        const double from = static_cast<double>(column) - lattice_.offset_x, cell = 1 / lattice_.frequency;
        const double middle = from + static_cast<double>(b.x), reach = static_cast<double>(b.chord);
        const stretch::range reached = part.within((middle - reach) * cell, (middle + reach) * cell);
        for (std::size_t i = reached.begin; i < reached.end; i += N) {
            lanes<float, N> dx, height, highest;
            offsets<N>(dx, &part.x[i], lattice_.frequency, -from);
            b.height_at(height, lanes<float, N>(dx - b.x));
            insonify::detail::load(highest, values + i);
            highest = height > highest ? height : highest;
            insonify::detail::store(values + i, highest);
        }
    }

    lattice lattice_;
    cell_hash hash_;
    std::int32_t coverage_;  // of 65536
    float height_, wall_;
};

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
