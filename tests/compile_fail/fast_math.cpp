// -ffast-math permits compilers to change the rounding of results.
// expect: bit-identical on all platforms
#if defined(INSONIFY_COMPILE_FAIL)
#define __FAST_MATH__ 1
#endif
#include <insonify/insonify.hpp>
