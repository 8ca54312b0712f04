// The registry of the library's labels: one row for each, with its name, relief, brightness and speckle.
//
// To add a type of relief, write its model in a file of its own and add a row to `relief_types`. To add a sediment, add
// a row to `sediments`. Defaults of scenes and of speckle, and names in manifests, are read from here. The label of a
// row is its index, which a static_assert checks: labels are stored in data sets and never change.
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/seabed/type.hpp>

#include <array>
#include <iterator>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Types named after their relief, with the gray values of the paper's pictures.
inline constexpr type_properties relief_types[] = {
    {type::sand, "sand", 0.45f, {1, 15, 0}},
    {type::ripples, "ripples", 0.5f, {1, 0, 0}},
    {type::mud, "mud", 0.4f, {1, 0, 1}},
    {type::rock, "rock", 0.6f, {1, 1.5f, 0}},
};

/// The relief of a sediment besides its roughness: `level` as of `flat`, `soft` as of `mud`, or the blocks of `rock`,
/// whose parameters follow.
struct sediment_form {
    enum kind { level, soft, blocks } kind = level;
    float relief = 0.5f, outcrop = 6.0f, block = 1.4f, smallest = 0.3f, sizes = 2.2f, fracture = 0.5f;
};

/// What is known of a sediment.
struct sediment_facts {
    type label;
    std::string_view name;
    float phi;       ///< mean grain size, -log2 of millimetres
    float strength;  ///< w2 of the roughness spectrum W(K) = w2 (K cm)^-3.25, cm^4
    float level;     ///< of Lambert's law, decibels: S_b = level + 20 log10(sin grazing)
    float texture;   ///< shape of the K-distribution, 0 for none
    float steady;    ///< power of a steady echo among the others, over theirs
    sediment_form form{};

    /// Root mean square height of what is shorter than a metre, metres: 2 pi w2 K^-1.25 / 1.25 at K = 2 pi / 100 cm.
    INSONIFY_MEMBER float rms() const { return 0.12641f * numeric::square_root(strength); }
    /// The backscattering strength at normal incidence by Lambert's law, as a factor.
    INSONIFY_MEMBER constexpr float strength_at_nadir() const {
        return static_cast<float>(numeric::pow(10, static_cast<double>(level) / 10));
    }
};

/// Sediments from the coarsest to the finest. Roughness: APL-UW High-Frequency Ocean Environmental Acoustic Models
/// Handbook, TR 9407, 1994 (eqs. 2-10, table 2). Levels meet that report's backscattering strengths at 100 kHz and 20
/// degrees; that of medium silt lies between its neighbours'. Textures: few scatterers to a cell of stones, many to one
/// of sand (D. A. Abraham, A. P. Lyons. Novel Physical Interpretations of K-Distributed Reverberation. IEEE Journal of
/// Oceanic Engineering 27, 2002); muds are Rician (J. I. Dunlop. Statistical Modelling of Sidescan Sonar Images. OCEANS
/// 1997).
inline constexpr sediment_facts sediments[] = {
    {type::rough_rock, "rough rock", -9.0f, 0.20693f, 3.1f, 0.8f, 0, {.kind = sediment_form::blocks, .relief = 1}},
    {type::hard_rock,
     "hard rock",
     -7.0f,
     0.01862f,
     -2.7f,
     1.2f,
     0,
     {.kind = sediment_form::blocks, .relief = 0.5f, .sizes = 2, .fracture = 0.35f}},
    {type::cobble, "cobble", -3.0f, 0.0156f, -6.9f, 2, 0, {sediment_form::blocks, 0.15f, 5, 0.5f, 0.12f, 2.6f, 0.6f}},
    {type::sandy_gravel, "sandy gravel", -1.0f, 0.012937f, -10.0f, 3, 0},
    {type::coarse_sand, "coarse sand", 0.5f, 0.006957f, -12.5f, 6, 0},
    {type::medium_sand, "medium sand", 1.5f, 0.004446f, -14.9f, 10, 0},
    {type::fine_sand, "fine sand", 2.5f, 0.002715f, -17.9f, 15, 0},
    {type::very_fine_sand, "very fine sand", 3.5f, 0.001544f, -17.7f, 20, 0},
    {type::coarse_silt, "coarse silt", 4.5f, 0.000781f, -18.5f, 0, 0.2f},
    {type::medium_silt, "medium silt", 5.5f, 0.000517f, -21.2f, 0, 0.5f, {sediment_form::soft}},
    {type::sandy_mud, "sandy mud", 6.0f, 0.000517f, -22.5f, 0, 1, {sediment_form::soft}},
    {type::silty_clay, "silty clay", 8.0f, 0.000517f, -22.6f, 0, 1, {sediment_form::soft}},
};
/// How many sediments have a name.
inline constexpr std::size_t sediment_count = std::size(sediments);

namespace detail::inline INSONIFY_FLAGS {

constexpr std::array<type_properties, type_count> registered_types() {
    std::array<type_properties, type_count> rows{};
    std::size_t count = 0;
    for (const type_properties& t : relief_types) rows[count++] = t;
    // Sediments relative to sand, which is as bright as medium sand.
    const float sand = relief_types[0].reflectivity /
                       sediments[index_of(type::medium_sand) - std::size(relief_types)].strength_at_nadir();
    for (const sediment_facts& s : sediments)
        rows[count++] = {s.label, s.name, sand * s.strength_at_nadir(), {1, s.texture, s.steady}};
    return rows;
}

}  // namespace detail::inline INSONIFY_FLAGS

/// Every label of the library.
inline constexpr std::array<type_properties, type_count> built_in_types = detail::registered_types();
static_assert(std::size(relief_types) + sediment_count == type_count);
static_assert(
    [] {
        for (std::size_t i = 0; i < built_in_types.size(); ++i)
            if (index_of(built_in_types[i].label) != i) return false;
        return true;
    }(),
    "the label of a row is its index");

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
