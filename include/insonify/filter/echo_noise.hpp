// Speckle filters: Rayleigh, averages of looks, K and Rician, on amplitudes or intensities.
//
// The mean is kept as long as bright pixels do not saturate at 1: keep the image's mean well below 1/2. Clipping,
// codes, colours and NaN are treated as in filter/noise.hpp. `with_speckle` (sonar/speckle.hpp) applies the same laws
// to sonar recordings, which have no largest value.
//
// Based on: E. Jakeman, P. N. Pusey. A Model for Non-Rayleigh Sea Echo. IEEE Transactions on Antennas and Propagation
// 24, 1976 (the K-distribution).
#pragma once

#include <insonify/filter/detail/echo_law.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// Checks the shape of a gamma distribution.
inline void require_gamma_shape(const char* name, const parameter& shape) {
    shape.check(
        name, [](float v) { return v >= 0.01f && v <= 1e6f; }, "0.01 to 1e6");
}

/// Checks that a value is an enumerator of `echo`.
inline void require_echo(const char* name, echo of) {
    require(of == echo::amplitude || of == echo::intensity, name, static_cast<int>(of), "amplitude or intensity");
}

}  // namespace detail::inline INSONIFY_FLAGS

/// Fully developed speckle: exponential intensities, Rayleigh amplitudes, of which std / mean is 0.5227.
struct rayleigh {
    echo of = echo::amplitude;
    correlation_length correlation{};
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for an `of` that is no enumerator, or a correlation length outside 0 to 16
    INSONIFY_MEMBER auto pass() const {
        detail::require_echo("rayleigh.of", of);
        detail::require_correlation("rayleigh.correlation", correlation);
        return detail::echo_pass<detail::echo_draw::by_looks>(detail::noise_stream::rayleigh, seed, frame, {"rayleigh"},
                                                              of, correlation);
    }
};

/// Speckle averaged over independent looks: gamma-distributed intensities, variance / mean^2 = 1 / looks.
struct gamma_speckle {
    parameter looks = 4;  ///< 0.01 to 1e6, not only whole numbers; 1 is Rayleigh
    echo of = echo::amplitude;
    correlation_length correlation{};  ///< if not 0, `looks` must be one whole number, 1 to 64, for all pixels
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for looks outside 0.01 to 1e6, an `of` that is no enumerator, a correlation length outside
    ///         0 to 16, or correlation with looks other than one whole number from 1 to 64; on application, for a map
    ///         of another size than the image
    INSONIFY_TAGGED auto pass() const {
        detail::require_gamma_shape("gamma_speckle.looks", looks);
        detail::require_echo("gamma_speckle.of", of);
        detail::require_correlation("gamma_speckle.correlation", correlation);
        return detail::echo_pass<detail::echo_draw::gamma>(detail::noise_stream::gamma_speckle, seed, frame,
                                                           {"gamma_speckle.looks", looks}, of, correlation);
    }
};

/// The K-distribution: speckle whose mean intensity is itself gamma-distributed from pixel to pixel. For one look,
/// variance / mean^2 of the intensity is 1 + 2 / shape. Illustrative shapes: rock 0.5 to 2, gravel 2 to 4, sand 8 to
/// 20.
struct k_speckle {
    parameter shape = 4;  ///< of the gamma-distributed texture, 0.01 to 1e6
    float looks = 1;      ///< 0.01 to 1e6
    echo of = echo::amplitude;
    /// If not 0, `looks` must be a whole number, 1 to 64. With a map of shapes, only the speckle is correlated; the
    /// texture stays white.
    correlation_length correlation{};
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for a shape or looks outside 0.01 to 1e6, an `of` that is no enumerator, a correlation
    ///         length outside 0 to 16, or correlation with looks other than a whole number from 1 to 64; on
    ///         application, for a map of another size than the image
    INSONIFY_TAGGED auto pass() const {
        detail::require_gamma_shape("k_speckle.shape", shape);
        detail::require_gamma_shape("k_speckle.looks", looks);
        detail::require_echo("k_speckle.of", of);
        detail::require_correlation("k_speckle.correlation", correlation);
        return detail::echo_pass<detail::echo_draw::by_looks>(detail::noise_stream::k_speckle, seed, frame,
                                                              {"k_speckle.shape", looks, shape}, of, correlation);
    }
};

/// Rician speckle: a coherent echo, as from mud or a few strong facets, plus diffuse ones. Variance / mean^2 of the
/// intensity is (1 + 2 K) / (1 + K)^2 with the Rice factor K = `steady`.
struct rician {
    parameter steady = 1;  ///< Rice factor, coherent over diffuse power: 0 to 1e6; 0 is Rayleigh
    echo of = echo::amplitude;
    /// With a map of `steady`, the length of the diffuse intensity; that of the sum is up to 1.4 times as long.
    correlation_length correlation{};
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for a steady part outside 0 to 1e6, an `of` that is no enumerator, or a correlation length
    ///         outside 0 to 16; on application, for a map of another size than the image
    INSONIFY_TAGGED auto pass() const {
        steady.check(
            "rician.steady", [](float v) { return v >= 0 && v <= 1e6f; }, "0 to 1e6");
        detail::require_echo("rician.of", of);
        detail::require_correlation("rician.correlation", correlation);
        return detail::echo_pass<detail::echo_draw::rice>(detail::noise_stream::rician, seed, frame,
                                                          {"rician.steady", 1, 0, steady}, of, correlation);
    }
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
