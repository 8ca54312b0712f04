// Checks the fields of an aggregate: every value out of range is refused by a message that names the field.
#pragma once

#include <insonify/core/error.hpp>

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "catch.hpp"

namespace refusals {

inline constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

// Values out of range.
inline const std::vector<double> not_finite{nan_value, infinity, -infinity};
inline const std::vector<double> not_above_0{nan_value, infinity, -infinity, -1, 0};
inline const std::vector<double> below_0{nan_value, infinity, -infinity, -1};
/// Outside of [low, high].
inline std::vector<double> outside(double low, double high) {
    const double step = 0.01 * (high - low) + 1e-3;
    return {nan_value, infinity, -infinity, low - step, high + step};
}
/// The same for whole numbers.
inline std::vector<double> outside_whole(double low, double high) {
    return {low - 1, high + 1, -1e9};
}

/// Angles that are not finite, or of too many turns.
inline const std::vector<double> not_an_angle = outside(-1e6, 1e6);

/// A field: its name in messages, how it is set, and values that are refused.
template <class T>
struct field {
    const char* name;
    void (*set)(T&, double);
    std::vector<double> values;
};

/// `FIELD(altitude, not_above_0)`: a row of the table for a member, or a member of a member.
#define FIELD(member, ...)                                                                                             \
    {                                                                                                                  \
#member,                                                                                                       \
            [](auto& o, double v) { o.member = static_cast<std::remove_cvref_t<decltype(o.member)>>(v); }, __VA_ARGS__ \
    }

/// The message with which `use` refuses; empty if it does not.
template <class Use>
std::string refusal(const Use& use) {
    try {
        use();
    } catch (const insonify::invalid_input& e) {
        return e.what();
    }
    return {};
}

/// Whether a message contains a name, or that of one of its elements, and not only a longer one.
inline bool names(const std::string& message, const std::string& name) {
    const std::size_t end = message.find(name) + name.size();
    return message.find(name) != std::string::npos &&
           (end == message.size() || std::string(" .[").find(message[end]) != std::string::npos);
}

/// Checks that `use` accepts `good`, and refuses each listed value of each field with a message that names the field.
/// @param owner  prefix of the field in messages: "overhead." before "altitude"
template <class T, class Use>
void check_fields(const std::string& owner, const T& good, const Use& use, std::initializer_list<field<T>> fields) {
    INFO(owner);
    CHECK(refusal([&] { use(good); }) == "");
    for (const field<T>& f : fields)
        for (const double value : f.values) {
            T bad = good;
            f.set(bad, value);
            INFO(f.name << " = " << value);
            const std::string message = refusal([&] { use(bad); });
            CAPTURE(message);
            CHECK(names(message, owner + f.name));
        }
}

/// Converts to any type, to count the members of aggregates.
struct anything {
    template <class T>
    operator T() const;
};

/// Number of members of an aggregate. Tests assert it, so that a member missing from a table breaks the build.
template <class T, class... Given>
constexpr std::size_t members() {
    if constexpr (requires { T{Given{}..., anything{}}; })
        return members<T, Given..., anything>();
    else
        return sizeof...(Given);
}

}  // namespace refusals
