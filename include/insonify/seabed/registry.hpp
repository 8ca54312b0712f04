// Registry of the labels of the sea floor and their properties.
//
// A label is one byte, stored in data sets. To add a type of relief, write its model in a file of its own and a row at
// the end of INSONIFY_RELIEF_TYPES; to add a sediment, write a row at the end of INSONIFY_SEDIMENTS. The enumerations,
// names in manifests, defaults of scenes and defaults of speckle are made from the rows. Labels number the rows in
// order, so a new type of relief renumbers the sediments: manifests name the labels of their data set. `user_type(0)`
// and above are free for users' seabeds, which state their properties (see model.hpp).
#pragma once

#include <insonify/core/error.hpp>
#include <insonify/core/numeric.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

// Types of relief, with the gray values of the published recipe's pictures (docs/recipe.md). They are not sediments.
//      label, name, reflectivity, speckle: looks, texture, steady
#define INSONIFY_RELIEF_TYPES(ROW)           \
    ROW(sand, "sand", 0.45f, {1, 15, 0})     \
    ROW(ripples, "ripples", 0.5f, {1, 0, 0}) \
    ROW(mud, "mud", 0.4f, {1, 0, 1})         \
    ROW(rock, "rock", 0.6f, {1, 1.5f, 0})

// Sediments. Roughness: APL-UW High-Frequency Ocean Environmental Acoustic Models Handbook, TR 9407, 1994 (eqs. 2-10,
// table 2). Levels meet that report's backscattering strengths at 100 kHz and 20 degrees; that of medium silt is
// interpolated. Textures: few scatterers to a cell of stones, many to one of sand (D. A. Abraham, A. P. Lyons. Novel
// Physical Interpretations of K-Distributed Reverberation. IEEE Journal of Oceanic Engineering 27, 2002); muds are
// Rician (J. I. Dunlop. Statistical Modelling of Sidescan Sonar Images. OCEANS 1997).
//      label, name, grain size phi, roughness w2 in cm^4, Lambert level in dB, speckle: texture, steady, relief
#define INSONIFY_SEDIMENTS(ROW)                                                                                    \
    ROW(rough_rock, "rough rock", -9.0f, 0.20693f, 3.1f, 0.8f, 0, {.kind = sediment_form::blocks, .relief = 1})    \
    ROW(hard_rock, "hard rock", -7.0f, 0.01862f, -2.7f, 1.2f, 0,                                                   \
        {sediment_form::blocks, 0.5f, 6, 1.4f, 0.3f, 2, 0.35f})                                                    \
    ROW(cobble, "cobble", -3.0f, 0.0156f, -6.9f, 2, 0, {sediment_form::blocks, 0.15f, 5, 0.5f, 0.12f, 2.6f, 0.6f}) \
    ROW(sandy_gravel, "sandy gravel", -1.0f, 0.012937f, -10.0f, 3, 0, {})                                          \
    ROW(coarse_sand, "coarse sand", 0.5f, 0.006957f, -12.5f, 6, 0, {})                                             \
    ROW(medium_sand, "medium sand", 1.5f, 0.004446f, -14.9f, 10, 0, {})                                            \
    ROW(fine_sand, "fine sand", 2.5f, 0.002715f, -17.9f, 15, 0, {})                                                \
    ROW(very_fine_sand, "very fine sand", 3.5f, 0.001544f, -17.7f, 20, 0, {})                                      \
    ROW(coarse_silt, "coarse silt", 4.5f, 0.000781f, -18.5f, 0, 0.2f, {})                                          \
    ROW(medium_silt, "medium silt", 5.5f, 0.000517f, -21.2f, 0, 0.5f, {sediment_form::soft})                       \
    ROW(sandy_mud, "sandy mud", 6.0f, 0.000517f, -22.5f, 0, 1, {sediment_form::soft})                              \
    ROW(silty_clay, "silty clay", 8.0f, 0.000517f, -22.6f, 0, 1, {sediment_form::soft})

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Statistics of an intensity. By default Rayleigh amplitudes, exponential intensities. The scintillation index,
/// variance / mean^2 of the intensity, is
/// (1 + 1 / texture) (1 + (1 + 2 steady) / (looks (1 + steady)^2)) - 1, without the first factor where texture is 0.
struct speckle_law {
    int looks = 1;      ///< independent intensities that are averaged: 1 to 64
    float texture = 0;  ///< shape of the K-distribution: rock 0.5 to 2, sand 8 to 20; 0: no texture
    float steady = 0;   ///< power of a steady echo over that of the diffuse ones, 0 to 1e6: Rician amplitudes
    friend bool operator==(const speckle_law&, const speckle_law&) = default;
};

namespace seabed {

#define INSONIFY_LABEL(label, ...) label,

/// Label of the bottom: a type of relief, a sediment, or a user's (see `user_type`).
enum class type : std::uint8_t { INSONIFY_RELIEF_TYPES(INSONIFY_LABEL) INSONIFY_SEDIMENTS(INSONIFY_LABEL) };

#undef INSONIFY_LABEL

inline constexpr std::size_t first_user_label = 64;  ///< lower labels are reserved for the library
inline constexpr std::size_t label_count = 256;      ///< in images of labels the last means no seabed

inline namespace INSONIFY_FLAGS {

/// A label for a user's seabed, which the library never uses.
/// @param number  0 to 190
/// @throws invalid_input for a number out of its range
constexpr type user_type(int number) {
    const auto limit = static_cast<int>(label_count - 1 - first_user_label);
    if (number < 0 || number >= limit) insonify::detail::refuse("user_type number", number, "0 to 190");
    return static_cast<type>(static_cast<int>(first_user_label) + number);
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
    float reflectivity = 0.45f;  ///< relative, as a material's; that of sand is 0.45
    speckle_law speckle{};
    friend bool operator==(const type_properties&, const type_properties&) = default;
};

inline namespace INSONIFY_FLAGS {

/// The label of a seabed's `kind`, which is a label or the properties of one.
constexpr type label_of(type t) {
    return t;
}
/// The same for properties.
constexpr type label_of(const type_properties& p) {
    return p.label;
}

}  // namespace INSONIFY_FLAGS

/// The relief of a sediment besides its roughness: `level` as of `flat`, `soft` as of `mud`, or the blocks of `rock`,
/// whose parameters follow.
struct sediment_form {
    enum kind { level, soft, blocks } kind = level;
    float relief = 0.5f, outcrop = 6.0f, block = 1.4f, smallest = 0.3f, sizes = 2.2f, fracture = 0.5f;
};

/// The acoustic and geometric parameters of a sediment.
struct sediment_parameters {
    type label;
    std::string_view name;
    float phi;                ///< mean grain size, -log2 of millimetres
    float spectral_strength;  ///< w2 of the roughness spectrum W(K) = w2 (K cm)^-3.25, cm^4
    float level;              ///< of Lambert's law, decibels: S_b = level + 20 log10(sin grazing)
    float texture;            ///< shape of the K-distribution, 0 for none
    float steady;             ///< power of a steady echo over that of the diffuse ones
    sediment_form form{};

    /// Root mean square height of what is shorter than a metre, metres. Its square is 2 pi w2 K^-1.25 / 1.25, cm^2, at
    /// K = 2 pi / 100 cm.
    INSONIFY_MEMBER float rms() const { return 0.12641f * numeric::square_root(spectral_strength); }
    /// The backscattering strength at normal incidence by Lambert's law, as a factor.
    INSONIFY_MEMBER constexpr float strength_at_nadir() const {
        return static_cast<float>(numeric::pow(10, static_cast<double>(level) / 10));
    }
};

#define INSONIFY_PROPERTIES(label, ...) {type::label, __VA_ARGS__},
#define INSONIFY_SEDIMENT(label, ...) label = static_cast<int>(type::label),

/// Sediments by name; each has the value of its label.
enum class sediment : std::uint8_t { INSONIFY_SEDIMENTS(INSONIFY_SEDIMENT) };

/// The rows of types of relief.
inline constexpr type_properties relief_types[] = {INSONIFY_RELIEF_TYPES(INSONIFY_PROPERTIES)};
/// The rows of sediments.
inline constexpr sediment_parameters sediments[] = {INSONIFY_SEDIMENTS(INSONIFY_PROPERTIES)};

#undef INSONIFY_SEDIMENT
#undef INSONIFY_PROPERTIES
#undef INSONIFY_SEDIMENTS
#undef INSONIFY_RELIEF_TYPES

inline namespace INSONIFY_FLAGS {

/// The label of a sediment.
constexpr type type_of(sediment s) {
    return static_cast<type>(s);
}

/// The row of a sediment.
/// @throws invalid_input for a value that is not an enumerator
constexpr const sediment_parameters& parameters_of(sediment s) {
    const std::size_t row = static_cast<std::size_t>(s) - std::size(relief_types);
    if (row >= std::size(sediments))
        insonify::detail::refuse("sediment", static_cast<int>(s), "an enumerator of seabed::sediment");
    return sediments[row];
}

}  // namespace INSONIFY_FLAGS

/// Labels of the library.
inline constexpr std::size_t type_count = std::size(relief_types) + std::size(sediments);
static_assert(type_count <= first_user_label);

namespace detail::inline INSONIFY_FLAGS {

constexpr std::array<type_properties, type_count> registered_types() {
    std::array<type_properties, type_count> rows{};
    std::size_t count = 0;
    for (const type_properties& t : relief_types) rows[count++] = t;
    // Sediments relative to sand, which is as bright as medium sand.
    const float sand = relief_types[0].reflectivity / parameters_of(sediment::medium_sand).strength_at_nadir();
    for (const sediment_parameters& s : sediments)
        rows[count++] = {s.label, s.name, sand * s.strength_at_nadir(), {1, s.texture, s.steady}};
    return rows;
}

}  // namespace detail::inline INSONIFY_FLAGS

/// The properties of each label of the library, by index.
inline constexpr std::array<type_properties, type_count> built_in_types = detail::registered_types();

inline namespace INSONIFY_FLAGS {

/// The properties of a label of the library; of any other label those of sand, without a name.
constexpr type_properties properties_of(type t) {
    if (index_of(t) < type_count) return built_in_types[index_of(t)];
    return {t, "", built_in_types[0].reflectivity, built_in_types[0].speckle};
}

}  // namespace INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
