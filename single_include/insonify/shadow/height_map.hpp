#pragma once

#if !defined(INSONIFY_HAS_EXTRAS)
#define INSONIFY_EXTRAS
#include <insonify/insonify.hpp>
#endif
