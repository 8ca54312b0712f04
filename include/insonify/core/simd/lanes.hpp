// SIMD values: lanes<T, N> is a GNU vector of N values, or a plain value where N is 1.
//
// Kernels use `mask ? a : b` and + - * < & and read the same for one lane and for eight. Lanes cross function
// boundaries by reference or in always-inlined code only: passing a 32-byte vector by value has another ABI without
// AVX.
#pragma once

#include <insonify/config.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

template <class T, int N>
struct lanes_of {
#if INSONIFY_SIMD
    typedef T type __attribute__((vector_size(N * sizeof(T))));
#else
    static_assert(N == 1, "this build is scalar");
#endif
};
template <class T>
struct lanes_of<T, 1> {
    using type = T;
};

template <class T, int N>
using lanes = typename lanes_of<T, N>::type;

#if INSONIFY_SIMD
/// Lanes I of the concatenation of two vectors.
template <int... I, class Into, class Lanes>
INSONIFY_INLINE void pick(Into& into, const Lanes& first, const Lanes& second) {
#if __has_builtin(__builtin_shufflevector)
    into = __builtin_shufflevector(first, second, I...);
#else  // g++ 11
    constexpr int n = sizeof first / sizeof first[0];
    using index = std::conditional_t<sizeof first[0] == 4, std::int32_t, std::int64_t>;
    if constexpr (sizeof...(I) == n)
        into = __builtin_shuffle(first, second, lanes<index, n>{I...});
    else
        into = Into{(I < n ? first : second)[I % n]...};
#endif
}

/// Lane i is lane `from(i)` of the concatenation of two vectors.
template <int N, class From, class Into, class Lanes>
INSONIFY_INLINE void shuffle(Into& into, const Lanes& first, const Lanes& second, const From&) {
    [&]<int... I>(std::integer_sequence<int, I...>) INSONIFY_INLINE_LAMBDA {
        pick<From{}(I)...>(into, first, second);
    }
    (std::make_integer_sequence<int, N>{});
}

/// Splits N lanes into two halves.
template <int N, class Half, class Lanes>
INSONIFY_INLINE void split(Half& low, Half& high, const Lanes& of) {
    shuffle<N / 2>(low, of, of, [](int i) { return i; });
    shuffle<N / 2>(high, of, of, [](int i) { return N / 2 + i; });
}
#endif

/// Joins two halves to N lanes.
template <int N, class Lanes, class Half>
INSONIFY_INLINE void join(Lanes& into, const Half& low, const Half& high) {
#if INSONIFY_SIMD
    shuffle<N>(into, low, high, [](int i) { return i; });
#else
    static_cast<void>(high);
    into = low;
#endif
}

/// Prefetches the cache line of an address.
INSONIFY_INLINE void prefetch(const void* address) {
#if defined(__GNUC__)
    __builtin_prefetch(address);
#else
    (void)address;
#endif
}

/// Unaligned load and store.
template <class T, class Lanes>
INSONIFY_INLINE void load(Lanes& into, const T* from) {
    std::memcpy(&into, from, sizeof into);
}
template <class T, class Lanes>
INSONIFY_INLINE void store(T* into, const Lanes& from) {
    std::memcpy(into, &from, sizeof from);
}

/// One value in every lane, stored as a whole vector: loading it takes no broadcast instruction.
template <class T>
struct broadcast {
    alignas(64) T values[16];
    broadcast(T value = {}) {
        for (T& v : values) v = value;
    }
};
template <class T, class Lanes>
INSONIFY_INLINE void load(Lanes& into, const broadcast<T>& from) {
    std::memcpy(&into, from.values, sizeof into);
}

/// Converts each lane as static_cast does.
template <class To, class From>
INSONIFY_INLINE void convert(To& into, const From& from) {
#if INSONIFY_SIMD
    if constexpr (!std::is_arithmetic_v<To>)
        into = __builtin_convertvector(from, To);
    else
#endif
        into = static_cast<To>(from);
}

/// Whether any lane of a mask is set.
template <class Mask>
INSONIFY_INLINE bool any(const Mask& mask) {
#if INSONIFY_SIMD && defined(__SSE2__)
    if constexpr (sizeof mask == 16) {
        lanes<float, 4> bits;
        std::memcpy(&bits, &mask, sizeof bits);
        return __builtin_ia32_movmskps(bits) != 0;
    } else if constexpr (sizeof mask > 16) {
        lanes<std::int64_t, sizeof mask / 16> low, high;
        std::memcpy(&low, &mask, sizeof low);
        std::memcpy(&high, reinterpret_cast<const char*>(&mask) + sizeof low, sizeof high);
        low |= high;
        return any(low);
    } else
#endif
    {
        std::uint64_t words[(sizeof mask + 7) / 8] = {};
        std::memcpy(words, &mask, sizeof mask);
        std::uint64_t all = 0;
        for (const std::uint64_t word : words) all |= word;
        return all != 0;
    }
}

/// Bit k is set where lane k of a mask is; for 1, 4, 8 or 16 lanes of 32 bits.
template <int N>
INSONIFY_INLINE unsigned movemask(const lanes<std::int32_t, N>& mask) {
#if INSONIFY_SIMD && defined(__SSE2__)
    if constexpr (N == 4) {
        return static_cast<unsigned>(__builtin_ia32_movmskps(lanes<float, 4>(mask)));
    } else if constexpr (N > 4) {
        lanes<std::int32_t, N / 2> low, high;
        split<N>(low, high, mask);
        return movemask<N / 2>(low) | movemask<N / 2>(high) << N / 2;
    } else
#endif
    {
        std::int32_t values[static_cast<unsigned>(N)];
        std::memcpy(values, &mask, sizeof values);
        unsigned bits = 0;
        for (int k = 0; k < N; ++k) bits |= values[k] != 0 ? 1u << k : 0u;
        return bits;
    }
}

/// Reads or replaces one lane.
template <class Lanes>
INSONIFY_INLINE auto lane(const Lanes& lanes, int i) {
    if constexpr (std::is_arithmetic_v<Lanes>)
        return lanes;
    else
        return lanes[i];
}
template <class Lanes, class T>
INSONIFY_INLINE void set_lane(Lanes& lanes, int i, T value) {
    if constexpr (std::is_arithmetic_v<Lanes>)
        lanes = value;
    else
        lanes[i] = value;
}

/// Lane i is from(i).
template <int N, class Lanes, class From>
INSONIFY_INLINE void gather(Lanes& into, const From& from) {
    [&]<int... I>(std::integer_sequence<int, I...>) INSONIFY_INLINE_LAMBDA {
        into = Lanes{from(I)...};
    }
    (std::make_integer_sequence<int, N>{});
}

#if INSONIFY_SIMD
/// Applies `work(half, from)` to the lower and the upper half of N lanes.
template <int N, class Lanes, class Work>
INSONIFY_INLINE void in_halves(Lanes& into, const Lanes& of, const Work& work) {
    lanes<std::remove_cvref_t<decltype(of[0])>, N / 2> low, high;
    split<N>(low, high, of);
    work(low, low);
    work(high, high);
    join<N>(into, low, high);
}
#endif

/// Correctly rounded, as numeric::square_root.
template <int N>
INSONIFY_INLINE void square_root(lanes<float, N>& into, const lanes<float, N>& of) {
#if INSONIFY_SIMD && defined(__SSE2__)
    if constexpr (N == 4)
        into = __builtin_ia32_sqrtps(of);
    else if constexpr (N % 4 == 0)
        in_halves<N>(into, of, [](auto& half, const auto& from) { square_root<N / 2>(half, from); });
    else
#endif
        gather<N>(into, [&](int k) { return std::sqrt(lane(of, k)); });
}

/// Calls body(0), body(1), ... body(Count - 1), unrolled, which g++ does not do at -O2: arrays indexed by the count
/// then live in registers.
template <int Count, class Body>
INSONIFY_INLINE void unroll(const Body& body) {
    [&]<int... I>(std::integer_sequence<int, I...>) INSONIFY_INLINE_LAMBDA {
        (body(I), ...);
    }
    (std::make_integer_sequence<int, Count>{});
}

/// Exchanges a and b in the lanes of a mask.
template <class Mask, class Lanes>
INSONIFY_INLINE void exchange(const Mask& where, Lanes& a, Lanes& b) {
    const Lanes old = a;
    a = where ? b : a;
    b = where ? old : b;
}

/// The least and the largest of three values, lane by lane.
template <class Lanes>
INSONIFY_INLINE void range_of(Lanes& low, Lanes& high, const Lanes& a, const Lanes& b, const Lanes& c) {
    low = a < b ? a : b;
    low = low < c ? low : c;
    high = a > b ? a : b;
    high = high > c ? high : c;
}

/// 0, 1, ... N - 1.
template <class T, int N>
INSONIFY_INLINE void iota(lanes<T, N>& into) {
    T values[static_cast<unsigned>(N)];
    for (int i = 0; i < N; ++i) values[i] = static_cast<T>(i);
    load(into, values);
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
