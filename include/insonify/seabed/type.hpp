// Labels of the sea floor and their properties: name, brightness and speckle.
//
// A label is one byte. The library's labels are the rows of registry.hpp; `own_type(0)` and above are free for users'
// seabeds, which state the properties of their labels (see model.hpp).
#pragma once

#include <insonify/core/error.hpp>

#include <cstddef>
#include <cstdint>
#include <string_view>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Statistics of an intensity. By default Rayleigh amplitudes, exponential intensities. The scintillation index,
/// variance / mean^2 of the intensity, is
/// (1 + 1 / texture) (1 + (1 + 2 steady) / (looks (1 + steady)^2)) - 1.
struct speckle_law {
    int looks = 1;  ///< independent intensities that are averaged: 1 to 64
    float texture =
        0;  ///< shape of the gamma-distributed mean of the K-distribution: rock 0.5 to 2, sand 8 to 20; 0: none
    float steady = 0;  ///< power of a steady echo over that of the diffuse ones: Rician amplitudes
    friend bool operator==(const speckle_law&, const speckle_law&) = default;
};

namespace seabed {

/// Label of the bottom: four types of relief, the twelve of `sediment` (see sediment.hpp), and user-defined ones from
/// 16 on.
enum class type : std::uint8_t {
    sand,
    ripples,
    mud,
    rock,
    rough_rock,
    hard_rock,
    cobble,
    sandy_gravel,
    coarse_sand,
    medium_sand,
    fine_sand,
    very_fine_sand,
    coarse_silt,
    medium_silt,
    sandy_mud,
    silty_clay,
};
inline constexpr std::size_t type_count = 16;    ///< of the library: labels below it
inline constexpr std::size_t label_count = 256;  ///< of all; the last means no seabed in images of labels

inline namespace INSONIFY_FLAGS {

/// A label that the library does not use.
/// @param number  0 to 238
/// @throws invalid_input for a number out of its range
constexpr type own_type(int number) {
    const auto limit = static_cast<int>(label_count - 1 - type_count);
    if (number < 0 || number >= limit) insonify::detail::refuse("own_type number", number, "0 to 238");
    return static_cast<type>(static_cast<int>(type_count) + number);
}

/// Index of a label in tables with one entry per label.
constexpr std::size_t index_of(type t) {
    return static_cast<std::size_t>(t);
}

}  // namespace INSONIFY_FLAGS

/// The properties of a label.
struct type_properties {
    type label = type::sand;
    std::string_view name;       ///< for manifests and messages; a string literal, or text that outlives its users
    float reflectivity = 0.45f;  ///< as of a material: relative, that of sand is 0.45
    speckle_law speckle{};
    friend bool operator==(const type_properties&, const type_properties&) = default;
};

inline namespace INSONIFY_FLAGS {

/// A label, or the properties of one, as a seabed's `kind`.
constexpr type label_of(type t) {
    return t;
}
/// The label of a type with its properties.
constexpr type label_of(const type_properties& p) {
    return p.label;
}

}  // namespace INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
