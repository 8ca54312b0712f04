// Whether a type consists of floats alone: what can be interpolated between the vertices of a triangle.
//
// An aggregate is looked into: it is initialized from values that convert to float, to vectors of float and to
// aggregates of those, and from values that convert to any other scalar or class, too. If as many of the first kind fit
// as of the second, all members are made of floats.
#pragma once

#include <insonify/config.hpp>

#include <cstddef>
#include <type_traits>
#include <utility>

namespace insonify {
inline namespace INSONIFY_ABI {

/// For classes that are no aggregates: specialize it as true for your own vector of floats.
template <class V>
inline constexpr bool is_vector_of_floats = requires {
    requires std::is_same_v<typename V::value_type, float>;
};
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

template <class Value, std::size_t>
using repeated = Value;
template <class V, class Value, std::size_t... I>
constexpr bool takes(std::index_sequence<I...>) {
    return requires {
        V{repeated<Value, I>{}...};
    };
}
/// The largest number of values that initialize an aggregate.
template <class V, class Value, std::size_t Count>
constexpr std::size_t most_members() {
    if constexpr (Count == 0)
        return 0;
    else if constexpr (takes<V, Value>(std::make_index_sequence<Count>{}))
        return Count;
    else
        return most_members<V, Value, Count - 1>();
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
        return most_members<V, converts_to_floats, floats>() == most_members<V, converts_to_members, floats>();
    }
}

}  // namespace detail::inline INSONIFY_FLAGS

/// Made of floats alone: float, glm::vec2..4, arrays and aggregates of those.
template <class V>
concept interpolatable = std::is_trivially_copyable_v<V> && detail::consists_of_floats<V>();

}  // namespace INSONIFY_ABI
}  // namespace insonify
