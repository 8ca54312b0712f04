#pragma once

#if !defined(INSONIFY_HAS_BODIES)
#define INSONIFY_WANTS_BODIES
#include <insonify/insonify.hpp>
#endif
