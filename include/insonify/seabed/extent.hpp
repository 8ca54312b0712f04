// How high and how low a seabed can be, known without sampling it.
#pragma once

#include <insonify/seabed/any.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

/// No height of a seabed lies outside; it need not reach the bounds. Metres above the datum.
struct extent {
    double lowest = -std::numeric_limits<double>::infinity(), highest = std::numeric_limits<double>::infinity();
};

namespace detail {

/// What a roughness adds, up or down.
inline double reach_of(const roughness& r) {
    // What is summed in single precision is within this of what it should be.
    return power_law_noise(r, 0, stream::sand).reach() * (1 + 1e-4);
}
/// Up and down alike, with room for rounding.
inline extent around(double lowest, double highest) {
    return {lowest * (1 + 1e-4), highest * (1 + 1e-4)};
}

}  // namespace detail

/// Of anything that isn't known from parameters alone, nothing is said.
template <recipe R>
extent extent_of(const R&) {
    return {};
}
inline extent extent_of(const flat& f) {
    const double r = detail::reach_of(f.surface);
    return detail::around(-r, r);
}
inline extent extent_of(const ripples& r) {
    const double all = detail::reach_of(r.surface) + 0.5 * static_cast<double>(r.height);
    return detail::around(-all, all);
}
inline extent extent_of(const mud& m) {
    const double r = detail::reach_of(m.surface);
    return detail::around(-r - static_cast<double>(m.pock_depth), r + static_cast<double>(m.mound_height));
}
/// Ridges lie one on the other, and on them a block of each size.
inline extent extent_of(const rock& k) {
    const double r = detail::reach_of(k.surface), relief = static_cast<double>(k.relief);
    const double ridges = 0.35 * (1 + 0.7 + 0.7 * 0.7), blocks = 0.8 * 2.5 * (1 + 0.5 + 0.25);
    return detail::around(-r, r + relief * (ridges + blocks));
}
template <class... Recipes>
extent extent_of(const std::variant<Recipes...>& v);
template <preparable First, preparable Second>
extent extent_of(const basic_blend<First, Second>& b) {
    const extent first = extent_of(b.first), second = extent_of(b.second);
    return {(std::min)(first.lowest, second.lowest), (std::max)(first.highest, second.highest)};
}
template <class... Recipes>
extent extent_of(const std::variant<Recipes...>& v) {
    return std::visit([](const auto& held) { return extent_of(held); }, v);
}

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
