#pragma once

#if !defined(INSONIFY_HAS_COMPILED)
#include <insonify/insonify.hpp>
#endif
