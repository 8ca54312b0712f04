// Under some of GLM's macros, vectors can't be copied as bytes.
// expect: compile without GLM_FORCE_CTOR_INIT
#if defined(INSONIFY_COMPILE_FAIL)
#define GLM_FORCE_CTOR_INIT
#endif
#include <insonify/insonify.hpp>
