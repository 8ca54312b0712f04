// Sediments by name or grain size: one word sets relief, brightness and speckle together (rows in registry.hpp).
//
// A sediment is also a label: models with that label get the table's brightness and speckle by default. All values are
// relative. Levels and roughness are those of APL-UW TR 9407 (see registry.hpp) for 10 to 100 kHz, extrapolated to a
// side-scan sonar's 300 to 900 kHz. The report states an uncertainty of 3 dB for well-known sands and silts, 10 dB for
// rock. Speckle shapes are illustrative.
#pragma once

#include <insonify/seabed/any.hpp>
#include <insonify/seabed/flat.hpp>
#include <insonify/seabed/mud.hpp>
#include <insonify/seabed/ripples.hpp>
#include <insonify/seabed/rock.hpp>

#include <algorithm>
#include <string_view>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

inline namespace INSONIFY_FLAGS {

/// A sediment by its name in the table.
/// @throws invalid_input for a name that isn't there
inline sediment sediment_of(std::string_view name) {
    for (const sediment_parameters& s : sediments)
        if (s.name == name) return static_cast<sediment>(s.label);
    insonify::detail::throw_error(
        invalid_input("sediment \"" + std::string(name) + "\" is unknown, expected a name of seabed::sediments"));
}

/// The sediment of the nearest mean grain size.
/// @param phi  -log2 of the grains' diameter in millimetres
/// @throws invalid_input for a grain size that isn't finite
inline sediment sediment_of_phi(float phi) {
    detail::require(numeric::is_finite(phi), "phi", phi, "a finite grain size");
    const sediment_parameters* best = sediments;
    for (const sediment_parameters& s : sediments)
        if (numeric::abs(s.phi - phi) < numeric::abs(best->phi - phi)) best = &s;
    return static_cast<sediment>(best->label);
}

/// The power-law roughness of a sediment, in octaves of cells from `longest` down.
///
/// They have the sediment's spectrum at wavelengths below the longest cell, 0.86 of it at those up to twice as long,
/// and together the variance of the spectrum's waves below 2.16 times the cell: measured by periodograms.
/// @param longest  metres, as of roughness; to continue the relief of a survey, the survey's spacing
inline roughness roughness_of(sediment s, float longest = 4) {
    const double growth = numeric::pow(2.16 * static_cast<double>(longest), 0.625);  // see sediment_parameters::rms
    return {.rms = static_cast<float>(growth) * parameters_of(s).rms(),
            .longest = longest,
            .shortest = (std::min)(0.06f, longest)};
}

/// The seabed that a sediment makes, with its label: outcrops and boulders of rock, cobbles, level sand, soft mud. A
/// template, so that programs that don't call it don't compile these models.
template <std::same_as<sediment> Sediment>
any bottom_of(Sediment s, std::uint64_t seed = 1) {
    const roughness surface = roughness_of(s);
    const sediment_form& form = parameters_of(s).form;
    const type kind = type_of(s);
    if (form.kind == sediment_form::soft) return mud{.surface = surface, .seed = seed, .kind = kind};
    if (form.kind == sediment_form::level) return flat{.surface = surface, .seed = seed, .kind = kind};
    return rock{.relief = form.relief,
                .outcrop = form.outcrop,
                .block = form.block,
                .smallest = form.smallest,
                .sizes = form.sizes,
                .fracture = form.fracture,
                .surface = surface,
                .seed = seed,
                .kind = kind};
}

/// Ripples labelled as a sediment, whose brightness and speckle they have; relief and roughness are those of `shape`.
inline ripples rippled(sediment s, ripples shape = {}) {
    shape.kind = type_of(s);
    return shape;
}

}  // namespace INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
