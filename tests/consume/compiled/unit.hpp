// Functions of the units with flags of their own.
#pragma once

#include <insonify/core/image.hpp>

namespace in = insonify;

#define UNITS(declare) declare(plain) declare(debug) declare(native) declare(alone) declare(alone_native)
#define DECLARE(unit)                 \
    in::image<float> draw_##unit();   \
    in::image<float> record_##unit(); \
    in::image<float> filter_##unit(const in::image<float>& picture);
UNITS(DECLARE)
