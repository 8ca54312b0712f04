#pragma once

#if !defined(INSONIFY_HAS_ALL)
#define INSONIFY_WANTS_BODIES
#define INSONIFY_WANTS_ALL
#include <insonify/insonify.hpp>
#endif
