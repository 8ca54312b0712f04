#pragma once

#if !defined(INSONIFY_HAS_UMBRELLA)
#include <insonify/insonify.hpp>
#endif
