// What bottoms are made of, by name or grain size: one word sets relief, brightness and speckle together.
//
// `sediment::medium_sand` is a type of seabed too: a recipe of that type gets the table's brightness from the scene and
// its speckle from `seabed_speckle` unless those are told otherwise.
//
// All values are relative. Levels and roughness are for 10 to 100 kHz; a side-scan sonar's 300 to 900 kHz extrapolates
// them. The report gives 3 dB for well known sands and silts, 10 dB for rock. Shapes of speckle are illustrative.
#pragma once

#include <insonify/seabed/cover.hpp>

#include <string_view>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

/// The bottoms of the table below, from the coarsest to the finest.
enum class sediment : std::uint8_t {
    rough_rock,
    rock,
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

/// What is known of a sediment.
struct sediment_facts {
    std::string_view name;
    float phi;       ///< mean grain size, -log2 of millimetres
    float strength;  ///< w2 of the roughness spectrum W(K) = w2 (K cm)^-3.25, cm^4
    float level;     ///< of Lambert's law, decibels: S_b = level + 20 log10(sin grazing)
    float texture;   ///< shape of the K-distribution, 0 for none
    float steady;    ///< power of a steady echo among the others, over theirs

    /// Root mean square height of what is shorter than a metre, metres: 2 pi w2 K^-1.25 / 1.25 at K = 2 pi / 100 cm.
    float rms() const { return 0.12641f * numeric::square_root(strength); }
};

/// Roughness: APL-UW High-Frequency Ocean Environmental Acoustic Models Handbook, TR 9407, 1994 (eqs. 2-10, table 2).
/// Levels meet that report's backscattering strengths at 100 kHz and 20 degrees; that of medium silt lies between its
/// neighbours'. Textures: few scatterers to a cell of stones, many to one of sand (D. A. Abraham, A. P. Lyons. Novel
/// Physical Interpretations of K-Distributed Reverberation. IEEE Journal of Oceanic Engineering 27, 2002); muds are
/// Rician (J. I. Dunlop. Statistical Modelling of Sidescan Sonar Images. OCEANS 1997).
inline constexpr sediment_facts sediments[] = {
    {"rough rock", -9.0f, 0.20693f, 3.1f, 0.8f, 0},    {"rock", -7.0f, 0.01862f, -2.7f, 1.2f, 0},
    {"cobble", -3.0f, 0.0156f, -6.9f, 2, 0},           {"sandy gravel", -1.0f, 0.012937f, -10.0f, 3, 0},
    {"coarse sand", 0.5f, 0.006957f, -12.5f, 6, 0},    {"medium sand", 1.5f, 0.004446f, -14.9f, 10, 0},
    {"fine sand", 2.5f, 0.002715f, -17.9f, 15, 0},     {"very fine sand", 3.5f, 0.001544f, -17.7f, 20, 0},
    {"coarse silt", 4.5f, 0.000781f, -18.5f, 0, 0.2f}, {"medium silt", 5.5f, 0.000517f, -21.2f, 0, 0.5f},
    {"sandy mud", 6.0f, 0.000517f, -22.5f, 0, 1},      {"silty clay", 8.0f, 0.000517f, -22.6f, 0, 1},
};
inline constexpr std::size_t sediment_count = sizeof sediments / sizeof sediments[0];

constexpr const sediment_facts& facts_of(sediment s) {
    return sediments[static_cast<std::size_t>(s)];
}

/// The label of a sediment, which is a type of its own.
constexpr type type_of(sediment s) {
    return static_cast<type>(static_cast<std::size_t>(type::rough_rock) + static_cast<std::size_t>(s));
}

/// A sediment by its name in the table.
/// @throws invalid_input for a name that isn't there
inline sediment sediment_of(std::string_view name) {
    for (std::size_t i = 0; i < sediment_count; ++i)
        if (sediments[i].name == name) return static_cast<sediment>(i);
    insonify::detail::raise(
        invalid_input("sediment \"" + std::string(name) + "\" is unknown, expected a name of seabed::sediments"));
}

/// The sediment of the nearest mean grain size.
/// @param phi  -log2 of the grains' diameter in millimetres
/// @throws invalid_input for a grain size that isn't finite
inline sediment sediment_of_phi(float phi) {
    detail::require(numeric::is_finite(phi), "phi", phi, "a finite grain size");
    std::size_t best = 0;
    const auto distance = [&](std::size_t i) { return numeric::magnitude(sediments[i].phi - phi); };
    for (std::size_t i = 1; i < sediment_count; ++i)
        if (distance(i) < distance(best)) best = i;
    return static_cast<sediment>(best);
}

/// The power-law roughness of a sediment: relief that is four times as long as a metre is 4^0.625 times as high.
inline roughness roughness_of(sediment s) {
    return {.rms = 2.3784f * facts_of(s).rms(), .longest = 4, .shortest = 0.06f};
}

/// The seabed that a sediment makes, with its label: outcrops and boulders of rock, cobbles, level sand, soft mud.
inline simple bottom_of(sediment s, std::uint64_t seed = 1) {
    const roughness surface = roughness_of(s);
    const type kind = type_of(s);
    if (s == sediment::rough_rock) return rock{.relief = 1, .surface = surface, .seed = seed, .kind = kind};
    if (s == sediment::rock)
        return rock{.relief = 0.5f, .sizes = 2, .fracture = 0.35f, .surface = surface, .seed = seed, .kind = kind};
    if (s == sediment::cobble)
        return rock{.relief = 0.15f,
                    .outcrop = 5,
                    .block = 0.5f,
                    .smallest = 0.12f,
                    .sizes = 2.6f,
                    .fracture = 0.6f,
                    .surface = surface,
                    .seed = seed,
                    .kind = kind};
    if (s >= sediment::medium_silt) return mud{.surface = surface, .seed = seed, .kind = kind};
    return flat{.surface = surface, .seed = seed, .kind = kind};
}

/// Ripples in a sediment.
inline ripples rippled(sediment s, ripples shape = {}) {
    shape.kind = type_of(s);
    return shape;
}

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
