// Virtual interface of sonar equations, so that tracing is compiled once for all lists of parts. It is called per ray
// of a fan, per bin and altitude, or per bin and ping offset within the beam, never per echo.
#pragma once

#include <insonify/sonar/side_scan/sonar_equation.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail {

struct equation_interface {
    virtual ~equation_interface() = default;
    virtual bool has_ranges() const = 0;                                  ///< whether any part depends on range
    virtual bool has_gain() const = 0;                                    ///< whether there is noise or a gain
    virtual double over_direction(double across, double down) const = 0;  ///< factor on power along a unit vector
    virtual double over_range(double range, double spacing) const = 0;    ///< factor on power; metres, metres per ping
    virtual double pulse_length() const = 0;                              ///< metres; 0 without a pulse
    virtual double beam_reach(double range) const = 0;                    ///< metres; 0 without a horizontal beam
    virtual double beam_pattern(double along, double range) const = 0;
    virtual double noise() const = 0;
    virtual double gain(const flat_echo& e) const = 0;
};

}  // namespace detail

namespace detail::inline INSONIFY_FLAGS {

/// Refers to an equation and to the seabed's law, which outlive it.
template <class Equation, class Law>
struct equation_of final : equation_interface {
    const Equation& equation;
    const Law& law;

    equation_of(const Equation& e, const Law& l) : equation(e), law(l) {
        equation.for_each([](const auto& part) { validate_if_possible(part); });
    }
    bool has_ranges() const override { return Equation::has_ranges; }
    bool has_gain() const override { return Equation::has_noise || Equation::has_gain; }
    double over_direction(double across, double down) const override { return equation.over_direction(across, down); }
    double over_range(double range, double spacing) const override { return equation.over_range(range, spacing); }
    double pulse_length() const override {
        double length = 0;
        equation.for_each([&](const auto& part) {
            if constexpr (pulse_part<decltype(part)>) length = part.range_length();
        });
        return length;
    }
    double beam_reach(double range) const override {
        double reach = 0;
        with_beam([&](const auto& beam) { reach = beam.reach(range); });
        return reach;
    }
    double beam_pattern(double along, double range) const override {
        double factor = 1;
        with_beam([&](const auto& beam) { factor = beam.pattern(along, range); });
        return factor;
    }
    double noise() const override { return equation.noise(); }
    double gain(const flat_echo& e) const override { return equation.gain(e, law); }

  private:
    template <class Fn>
    void with_beam(const Fn& fn) const {
        equation.for_each([&](const auto& part) {
            if constexpr (footprint_part<decltype(part)>) fn(part);
        });
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
