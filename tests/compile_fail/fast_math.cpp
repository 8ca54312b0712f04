// -ffast-math lets compilers round as they like.
// expect: promises the same bytes everywhere
#if defined(INSONIFY_COMPILE_FAIL)
#define __FAST_MATH__ 1
#endif
#include <insonify/insonify.hpp>

int main() {}
