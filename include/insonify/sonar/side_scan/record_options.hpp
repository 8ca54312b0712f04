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
    /// altitude and at least range / 2048. docs/tradeoff.md has times and errors: at 5 m altitude with 2048 bins over
    /// 40 m, cells of 2 and 8 cm take 1.3 and 0.7 times as long as the default of 4 cm; shadow labels differ from those
    /// of 5 mm in 0.8, 1.6 and 3.5 % of the bins on ripples with cells of 2, 4 and 8 cm, in 2.2, 3.4 and 9 % on rock.
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
