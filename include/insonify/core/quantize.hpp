// From [0, 1] to codes of 8 or 16 bits and back: the one rounding rule of filters and files.
#pragma once

#include <insonify/core/dispatch.hpp>
#include <insonify/core/lanes.hpp>

#include <concepts>
#include <cstdint>
#include <limits>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// What a gray file or screen stores for a pixel.
template <class T>
concept pixel_code = std::same_as<T, std::uint8_t> || std::same_as<T, std::uint16_t>;

/// The code nearest to `value`, 1 being the largest code; ties go up, values outside [0, 1] to the end they passed,
/// NaN to 0.
template <pixel_code Code>
constexpr Code quantize(float value) {
    constexpr double largest = (std::numeric_limits<Code>::max)();
    if (!(value > 0)) return 0;
    if (value >= 1) return static_cast<Code>(largest);
    return static_cast<Code>(static_cast<double>(value) * largest + 0.5);  // 24 + 16 bits: exact until the truncation
}

namespace detail {

/// quantize, several pixels at a time.
template <class Code>
struct quantize_kernel {
    const float* from;
    Code* to;
    std::size_t count;

    template <int Width>
    INSONIFY_INLINE void run() const {
        constexpr int N = Width > 1 ? Width / 2 : 1;  // the product takes a double
        constexpr double largest = (std::numeric_limits<Code>::max)();
        using doubles = lanes<double, N>;
        std::size_t i = 0;
        for (; i + N <= count; i += N) {
            lanes<float, N> value;
            load(value, from + i);
            doubles scaled;
            convert(scaled, value);
            scaled = scaled * largest + 0.5;
            scaled = scaled > 0.0 ? scaled : doubles{};  // NaN too
            scaled = scaled < largest ? scaled : doubles{} + largest;
            lanes<std::int32_t, N> code;
            convert(code, scaled);
            for (int k = 0; k < N; ++k) to[i + static_cast<std::size_t>(k)] = static_cast<Code>(lane(code, k));
        }
        for (; i < count; ++i) to[i] = quantize<Code>(from[i]);
    }
};

}  // namespace detail

/// Quantizes as many values as `to` takes; the same codes at every level.
/// @pre from.size() >= to.size()
template <pixel_code Code>
void quantize_row(std::span<const float> from, std::span<Code> to, isa level = best_isa()) {
    detail::dispatch(detail::quantize_kernel<Code>{from.data(), to.data(), to.size()}, level);
}

/// The float nearest to code / largest code; `quantize<Code>` takes it back to the same code.
template <pixel_code Code>
constexpr float dequantize(Code code) {
    return static_cast<float>(code) / static_cast<float>((std::numeric_limits<Code>::max)());
}

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
