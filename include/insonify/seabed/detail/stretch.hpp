// Rows of samples in pieces: a stretch holds the positions of up to `chunk` samples, padded to whole vectors, and
// kernels add relief to its values N lanes at a time.
#pragma once

#include <insonify/core/simd/dispatch.hpp>
#include <insonify/seabed/detail/lattice.hpp>
#include <insonify/seabed/model.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

using insonify::detail::dispatch;

/// Positions of up to `chunk` samples of a row, padded to whole vectors with the last one.
struct stretch {
    static constexpr std::size_t padded = chunk;  // a multiple of every lane count

    double y, spacing;
    double grid_spacing;                       ///< see scanline
    std::size_t count;                         ///< at least 1
    alignas(32) std::array<double, padded> x;  ///< ascending

    stretch(const scanline& line, std::size_t samples)
        : y(line.y), spacing(line.spacing), grid_spacing(line.grid_spacing), count(samples) {
        // The positions of line.x(i); four independent sums hide the latency of the additions.
        auto number = static_cast<double>(line.first);
        for (std::size_t i = 0; i < whole(); i += 4, number += 4) {
            x[i] = line.origin + line.spacing * number;
            x[i + 1] = line.origin + line.spacing * (number + 1);
            x[i + 2] = line.origin + line.spacing * (number + 2);
            x[i + 3] = line.origin + line.spacing * (number + 3);
        }
        for (std::size_t i = count; i < whole(); ++i) x[i] = x[count - 1];
    }
    /// The count rounded up to whole vectors.
    std::size_t whole() const { return (count + 15) & ~std::size_t{15}; }
    double last() const { return x[count - 1]; }

    /// The samples that may lie in [low, high], rounded outwards to whole vectors.
    struct range {
        std::size_t begin, end;
    };
    range within(double low, double high) const {
        const double n = static_cast<double>(count), per_metre = 1 / (std::max)(spacing, 1e-9);
        const double first = (low - x[0]) * per_metre - 1, past = (high - x[0]) * per_metre + 2;
        if (first >= n || past <= 0) return {0, 0};
        const auto begin = first > 0 ? static_cast<std::size_t>(first) : 0;
        const auto end = past < n ? static_cast<std::size_t>(past) : count;
        return {begin & ~std::size_t{15}, (end + 15) & ~std::size_t{15}};
    }
};

/// A float for each position of a stretch.
struct alignas(32) stretch_values : std::array<float, stretch::padded> {};

/// Cuts a row into stretches, calls `fill(stretch, values)` for each, which writes or adds to whole vectors of values
/// that begin at 0, and copies them out.
template <class Fill>
void by_stretches(const scanline& line, std::span<float> heights, Fill&& fill) {
    for (std::size_t i = 0; i < heights.size(); i += chunk) {
        const stretch part(line.from(i), (std::min)(chunk, heights.size() - i));
        stretch_values values{};
        fill(part, values);
        std::copy_n(values.begin(), part.count, heights.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

/// Kernel that calls `model.add_lanes<N>(part, values)`: adds a model's relief along a stretch to its values.
template <class Model>
struct relief_kernel {
    static constexpr int avx512_lanes = 16;

    const Model& model;
    const stretch& part;
    float* values;

    template <int N>
    INSONIFY_INLINE void run() const {
        model.template add_lanes<N>(part, values);
    }
};

template <class Model>
void add_relief(const Model& model, const stretch& part, stretch_values& values, isa level) {
    dispatch(relief_kernel<Model>{model, part, values.data()}, level);
}

/// N positions on a lattice: fractions within their cells, in [0, 1], and indices of the cells, counted from `first`.
template <int N>
INSONIFY_INLINE void locate(lanes<float, N>& across, lanes<std::int32_t, N>& cell, const double* x, double frequency,
                            double offset, double first) {
    if constexpr (N == 1) {
        double floor;
        const double u = *x * frequency + offset;
        insonify::detail::floor_lanes<1>(floor, u);
        cell = static_cast<std::int32_t>(floor - first);
        across = static_cast<float>(u - floor);
    } else {
        constexpr int half = N / 2;
        lanes<float, half> part[2];
        lanes<std::int32_t, half> index[2];
        for (int k = 0; k < 2; ++k) {
            lanes<double, half> u, floor;
            insonify::detail::load(u, x + k * half);
            u = u * frequency + offset;
            insonify::detail::floor_lanes<half>(floor, u);
            insonify::detail::convert(index[k], lanes<double, half>(floor - first));
            insonify::detail::convert(part[k], lanes<double, half>(u - floor));
        }
        insonify::detail::join<N>(across, part[0], part[1]);
        insonify::detail::join<N>(cell, index[0], index[1]);
    }
}

/// `reduce(part, u)` turns u = x[i] frequency + offset, in doubles, into floats, for half of N positions at a time.
template <int N, class Reduce>
INSONIFY_INLINE void reduced(lanes<float, N>& into, const double* x, double frequency, double offset,
                             const Reduce& reduce) {
    if constexpr (N == 1) {
        reduce(into, *x * frequency + offset);
    } else {
        constexpr int half = N / 2;
        lanes<float, half> part[2];
        for (int k = 0; k < 2; ++k) {
            lanes<double, half> u;
            insonify::detail::load(u, x + k * half);
            u = u * frequency + offset;
            reduce(part[k], u);
        }
        insonify::detail::join<N>(into, part[0], part[1]);
    }
}

/// x[i] frequency + offset for N positions, rounded to float: the sum has to be small.
template <int N>
INSONIFY_INLINE void offsets(lanes<float, N>& into, const double* x, double frequency, double offset) {
    reduced<N>(into, x, frequency, offset,
               [](auto& part, const auto& u) INSONIFY_INLINE_LAMBDA { insonify::detail::convert(part, u); });
}

/// x[i] frequency + offset minus the nearest integer, for N positions.
template <int N>
INSONIFY_INLINE void turns(lanes<float, N>& into, const double* x, double frequency, double offset) {
    reduced<N>(into, x, frequency, offset, [](auto& part, const auto& u) INSONIFY_INLINE_LAMBDA {
        constexpr double whole = 0x1.8p52;  // added, it leaves the nearest integer in the last bits
        insonify::detail::convert(part, std::remove_cvref_t<decltype(u)>(u - ((u + whole) - whole)));
    });
}

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
