// Filters between floats in [0, 1] and codes of 8 or 16 bits.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/core/quantize.hpp>

#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Quantizes gray or each channel of a colour.
template <pixel_code Code>
struct to_code {
    using is_filter = std::true_type;
    template <std::same_as<float> Channel>
    INSONIFY_MEMBER constexpr Code operator()(Channel value) const {
        return quantize<Code>(value);
    }
    template <std::same_as<float> Channel>
    INSONIFY_MEMBER constexpr rgb<Code> operator()(const rgb<Channel>& value) const {
        return {quantize<Code>(value.r), quantize<Code>(value.g), quantize<Code>(value.b)};
    }
    INSONIFY_TAGGED void row(const float* from, Code* to, int count, int, int) const { quantize_row(from, to, count); }
};

/// Dequantizes gray or each channel of a colour.
struct to_unit {
    using is_filter = std::true_type;
    template <pixel_code Code>
    INSONIFY_MEMBER constexpr float operator()(Code value) const {
        return dequantize(value);
    }
    template <pixel_code Code>
    INSONIFY_MEMBER constexpr rgb<float> operator()(const rgb<Code>& value) const {
        return {dequantize(value.r), dequantize(value.g), dequantize(value.b)};
    }
};

/// [0, 1] -> 0 ... 255, rounded to nearest; values outside are clamped, NaN becomes 0.
inline constexpr to_code<std::uint8_t> to_uint8{};
/// [0, 1] -> 0 ... 65535, in the same way.
inline constexpr to_code<std::uint16_t> to_uint16{};

/// 0 ... 255 or 65535 -> [0, 1]; `to_uint8` or `to_uint16` restores the same codes.
inline constexpr to_unit to_float{};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
