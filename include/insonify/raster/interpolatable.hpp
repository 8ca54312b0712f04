// Whether a type consists of floats alone, so that it can be interpolated between the vertices of a triangle.
//
// Aggregates are examined by how many values initialize them: first with values that convert to float, to vectors of
// float and to aggregates of those, then with values that convert to every other scalar and class as well. If the two
// counts are equal, and no value that converts to other types alone takes the place of one (as it does of a
// std::optional), all members are made of floats.
#pragma once

#include <insonify/config.hpp>

#include <cstddef>
#include <type_traits>
#include <utility>

namespace insonify {
inline namespace INSONIFY_ABI {

/// Whether a class that is not an aggregate is a vector of floats: `value_type` is float, it stores its floats (a
/// view's `data()` has the same type whether the view is const or not), and it cannot be empty (std::optional has `*`).
/// Specialize as true for others.
template <class V>
inline constexpr bool is_vector_of_floats = requires(V& variable, const V& constant) {
    requires std::is_same_v<typename V::value_type, float>;
    requires !requires {
        requires std::is_same_v<decltype(variable.data()), decltype(constant.data())>;
    };
    requires !requires {
        *constant;
    };
};
/// A float counts as a vector of one.
template <>
inline constexpr bool is_vector_of_floats<float> = true;

namespace detail::inline INSONIFY_FLAGS {

template <class V>
constexpr bool consists_of_floats();

struct converts_to_floats {
    template <class T>
        requires(consists_of_floats<T>())
    operator T() const;
};
struct converts_to_members {
    template <class T>
        requires(consists_of_floats<T>() || !std::is_aggregate_v<T>)
    operator T() const;
};
struct converts_to_others {
    template <class T>
        requires(!consists_of_floats<T>() && (!std::is_aggregate_v<T> || std::is_union_v<T>))
    operator T() const;
};

template <class Value, std::size_t>
using repeated = Value;
template <class V, class Value, std::size_t... I>
constexpr bool is_initialized_by(std::index_sequence<I...>) {
    return requires {
        V{repeated<Value, I>{}...};
    };
}
/// The largest number of values that initialize an aggregate, at most Count.
template <class V, class Value, std::size_t Count>
constexpr std::size_t member_count() {
    if constexpr (Count == 0)
        return 0;
    else if constexpr (is_initialized_by<V, Value>(std::make_index_sequence<Count>{}))
        return Count;
    else
        return member_count<V, Value, Count - 1>();
}
template <class V, std::size_t... I>
constexpr bool is_initialized_by_another_after(std::index_sequence<I...>) {
    return requires {
        V{repeated<converts_to_floats, I>{}..., converts_to_others{}};
    };
}
/// Whether a value that converts to other types alone initializes a member after some of the first I.
template <class V, std::size_t... I>
constexpr bool has_another_member(std::index_sequence<I...>) {
    return (is_initialized_by_another_after<V>(std::make_index_sequence<I>{}) || ...);
}

template <class V>
constexpr bool consists_of_floats() {
    if constexpr (!std::is_class_v<V> || is_vector_of_floats<V>) {
        return is_vector_of_floats<V>;
    } else if constexpr (std::is_empty_v<V>) {
        return true;
    } else if constexpr (!std::is_aggregate_v<V> || sizeof(V) % sizeof(float) != 0) {
        return false;
    } else {
        constexpr std::size_t floats = sizeof(V) / sizeof(float);
        constexpr std::size_t count = member_count<V, converts_to_floats, floats>();
        return count == member_count<V, converts_to_members, floats>() &&
               !has_another_member<V>(std::make_index_sequence<count + 1>{});
    }
}

}  // namespace detail::inline INSONIFY_FLAGS

/// Made of floats alone: float, glm::vec2..4, and arrays and aggregates of those.
template <class V>
concept interpolatable = std::is_trivially_copyable_v<V> && detail::consists_of_floats<V>();

}  // namespace INSONIFY_ABI
}  // namespace insonify
