// From [0, 1] to codes of 8 or 16 bits and back: the one rounding rule of filters and files.
#pragma once

#include <insonify/config.hpp>

#include <concepts>
#include <cstdint>
#include <limits>

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

/// The float nearest to code / largest code; `quantize<Code>` takes it back to the same code.
template <pixel_code Code>
constexpr float dequantize(Code code) {
    return static_cast<float>(code) / static_cast<float>((std::numeric_limits<Code>::max)());
}

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
