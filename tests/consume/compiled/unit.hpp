// Functions of the units with flags of their own.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/filter/convert.hpp>
#include <insonify/filter/pipe.hpp>
#include <insonify/seabed/area.hpp>
#include <insonify/sonar/bottom_tone.hpp>
#include <insonify/sonar/display.hpp>

namespace in = insonify;

/// A chain that one unit makes and another applies.
using quantization = decltype(in::to_uint8 | in::to_float);

#define UNITS(declare) declare(plain) declare(debug) declare(native) declare(alone) declare(alone_native)
#define DECLARE(unit)                                                                              \
    in::image<float> draw_##unit();                                                                \
    in::image<float> record_##unit();                                                              \
    in::image<float> filter_##unit(const in::image<float>& picture, const quantization& quantize); \
    bool reads_##unit(in::display_scale scale, const in::bottom_tone& tone, const in::seabed::patches& where);
UNITS(DECLARE)
