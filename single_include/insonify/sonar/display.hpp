#pragma once

#if !defined(INSONIFY_ONE_FILE)
#include <insonify/insonify.hpp>
#endif
