// Options of side-scan pictures.
#pragma once

#include <insonify/sonar/backscatter.hpp>
#include <insonify/sonar/frame.hpp>
#include <insonify/sonar/side_scan/sonar_equation.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Options of side-scan pictures. The types select what is computed: Labels are `labels` or `no_labels`, Equation lists
/// the parts of the sonar equation.
///
/// Labels are those of the surfaces themselves: pulse and horizontal beam blur the image alone, so the echo of a strong
/// target extends beyond its bounding box.
template <class Labels = labels, backscatter_law Law = lambert_backscatter, class Equation = sonar_equation<level_gain>>
struct record_options {
    Law law{};
    Equation equation{};
    /// Metres between the vertices at which the seabed is sampled, and an upper bound of the distance between rays on
    /// level ground, at least 2^-20 of the range; 0: the longer of a bin and `ping_spacing`, at most a fiftieth of the
    /// altitude and at least range / 2048. Measured at 5 m altitude with 2048 bins over 40 m, against cells of 5 mm:
    /// cells of 2, 4 and 8 cm take 2, 1 and 0.6 times the default's time; shadow labels differ in 0.9, 1.5 and 3.4 % of
    /// the bins on ripples and in 3.6, 5.3 and 11 % on rock, amplitudes by 7, 10 and 19 % (rms) on ripples.
    double cell = 0;

    /// The same options with another sonar equation, another law, or without labels, as in
    /// `record_options<>{}.with(sonar_equation{pulse{}, level_gain{}})`.
    template <class... Parts>
    INSONIFY_MEMBER record_options<Labels, Law, sonar_equation<Parts...>> with(
        const sonar_equation<Parts...>& other) const {
        return {law, other, cell};
    }
    template <backscatter_law Other>
    INSONIFY_MEMBER record_options<Labels, Other, Equation> with(const Other& other) const {
        return {other, equation, cell};
    }
    INSONIFY_MEMBER record_options<no_labels, Law, Equation> without_labels() const { return {law, equation, cell}; }
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
