// Quantization of [0, 1] to codes of 8 or 16 bits and back, by the one rounding rule of filters and files.
#pragma once

#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/lanes.hpp>

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Integer pixel types of gray files and displays.
template <class T>
concept pixel_code = std::same_as<T, std::uint8_t> || std::same_as<T, std::uint16_t>;

/// Pixel types with histograms: floats in [0, 1] and codes.
template <class T>
concept countable_pixel = std::same_as<T, float> || pixel_code<T>;

inline namespace INSONIFY_FLAGS {

/// Rounds `value` to the nearest code, where 1 is the largest code. Ties round up, values outside [0, 1] are clamped,
/// NaN gives 0.
template <pixel_code Code>
constexpr Code quantize(float value) {
    constexpr double largest = (std::numeric_limits<Code>::max)();
    if (!(value > 0)) return 0;
    if (value >= 1) return static_cast<Code>(largest);
    return static_cast<Code>(static_cast<double>(value) * largest + 0.5);  // 24 + 16 bits: exact next to ties
}

}  // namespace INSONIFY_FLAGS

namespace detail::inline INSONIFY_FLAGS {

/// Stores N consecutive codes. @pre each lane is in the range of Code
template <int N, class Code>
INSONIFY_INLINE void store_codes(Code* to, const lanes<std::int32_t, N>& code) {
#if INSONIFY_SIMD && defined(__SSE2__)
    if constexpr (N > 8) {
        lanes<std::int32_t, N / 2> half[2];
        std::memcpy(half, &code, sizeof code);
        store_codes<N / 2>(to, half[0]);
        store_codes<N / 2>(to + N / 2, half[1]);
    } else if constexpr (N % 4 == 0) {
        // packssdw saturates to signed 16 bits: codes of 16 bits are offset by -2^15, and back after it.
        constexpr int offset = sizeof(Code) == 2 ? 0x8000 : 0;
        const lanes<std::int32_t, N> shifted = code - offset;
        lanes<std::int32_t, 4> half[2];
        std::memcpy(half, &shifted, sizeof shifted);
        if constexpr (N == 4) half[1] = half[0];
        const lanes<std::int16_t, 8> words = __builtin_ia32_packssdw128(half[0], half[1]);
        if constexpr (sizeof(Code) == 2) {
            const lanes<std::uint16_t, 8> codes = lanes<std::uint16_t, 8>(words) ^ std::uint16_t{0x8000};
            std::memcpy(to, &codes, N * sizeof(Code));
        } else {
            const auto codes = __builtin_ia32_packuswb128(words, words);
            std::memcpy(to, &codes, N * sizeof(Code));
        }
    } else
#endif
        for (int k = 0; k < N; ++k) to[k] = static_cast<Code>(lane(code, k));
}

/// `quantize` over SIMD lanes.
template <class Code>
struct quantize_kernel {
    static constexpr int avx512_lanes = 16;

    const float* from;
    Code* to;
    std::size_t count;

    template <int N>
    INSONIFY_INLINE void run() const {
        using floats = lanes<float, N>;
        using ints = lanes<std::int32_t, N>;
        constexpr float largest = (std::numeric_limits<Code>::max)();
        std::size_t i = 0;
        for (; i + N <= count; i += N) {
            floats value;
            load(value, from + i);
            value = value > 0.0f ? value : floats{};  // NaN too
            value = value < 1.0f ? value : floats{} + 1.0f;
            ints code;
            convert(code, floats(value * largest + 0.5f));
            // The product may round up to a tie. value (largest + 1) - value is the same product, and its difference
            // to the tie is exact.
            floats tie;
            convert(tie, code);
            const floats above = value * (largest + 1.0f) - (tie - 0.5f);
            code = code - (above < value ? ints{} + 1 : ints{});
            store_codes<N>(to + i, code);
        }
        for (; i < count; ++i) to[i] = quantize<Code>(from[i]);
    }
};

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Quantizes to.size() values. The codes are the same at every level.
/// @pre from.size() >= to.size()
template <pixel_code Code>
void quantize_row(std::span<const float> from, std::span<Code> to, isa level = best_isa()) {
    detail::dispatch(detail::quantize_kernel<Code>{from.data(), to.data(), to.size()}, level);
}

/// Quantizes `count` values.
template <pixel_code Code>
void quantize_row(const float* from, Code* to, int count) {
    const auto size = static_cast<std::size_t>(count);
    quantize_row(std::span<const float>(from, size), std::span<Code>(to, size));
}

/// The float nearest to code / largest code; `quantize<Code>` takes it back to the same code.
template <pixel_code Code>
constexpr float dequantize(Code code) {
    return static_cast<float>(code) / static_cast<float>((std::numeric_limits<Code>::max)());
}

/// Dequantizes to.size() codes.
/// @pre from.size() >= to.size()
template <pixel_code Code>
void dequantize_row(std::span<const Code> from, std::span<float> to) {
    if constexpr (sizeof(Code) == 1) {
        static constexpr auto value = [] {
            std::array<float, 256> values{};
            for (std::size_t code = 0; code < values.size(); ++code) values[code] = dequantize(static_cast<Code>(code));
            return values;
        }();
        for (std::size_t i = 0; i < to.size(); ++i) to[i] = value[from[i]];
    } else {
        for (std::size_t i = 0; i < to.size(); ++i) to[i] = dequantize(from[i]);
    }
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
