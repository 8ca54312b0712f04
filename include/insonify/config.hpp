// Policy macros. A program may define any of the following before its first include of the library. Units may define
// them differently, but units with the same compiler flags must agree on INSONIFY_ASSERT and INSONIFY_THROW
// (docs/compile_cost.md).
//
//     INSONIFY_SIMD           1 (default where the compiler has vector extensions) or 0: everything scalar, same bytes
//     INSONIFY_WHOLE_KERNELS  1 (default with optimization) or 0: see below
//     INSONIFY_ASSERT(x)      internal invariants; default: assert(x)
//     INSONIFY_THROW(e)       how an error leaves the library when exceptions are off; must not return. Without it the
//                             message goes to stderr and the program is terminated
//     INSONIFY_COMPILED       compiled form (see compiled.hpp): this unit only declares the heavy functions
//     INSONIFY_IMPLEMENTATION compiled form: this unit defines them
//
// Three inline namespaces keep apart what the linker must not merge:
//   INSONIFY_ABI    the version. Public types are there, so that they pass between units whatever their flags.
//   INSONIFY_FLAGS  nested in it, named after the flags that change generated code. Holds functions, and classes that
//                   compute: no call links to a copy that another unit compiled with other checks or optimization, or
//                   for processors of another tier of instruction sets (below). Units within a tier share one copy.
//   INSONIFY_ONCE   functions that the compiled form compiles once: there a fixed name, else INSONIFY_FLAGS.
#pragma once

#include <insonify/version.hpp>

#if defined(_MSVC_LANG) ? _MSVC_LANG < 202002L : __cplusplus < 202002L
#error "insonify needs C++20: compile with -std=c++20 (or /std:c++20) or newer."
#endif

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "insonify's results are bit-identical on all platforms, which -ffast-math breaks: compile without it."
#endif

#if defined(GLM_FORCE_CTOR_INIT) || defined(GLM_FORCE_CXX98)
#error "insonify copies GLM's vectors as bytes: compile without GLM_FORCE_CTOR_INIT and GLM_FORCE_CXX98."
#endif

#if defined(__FLT_EVAL_METHOD__) && (__FLT_EVAL_METHOD__ == 2 || __FLT_EVAL_METHOD__ < 0)
#error "insonify's results are bit-identical on all platforms, which x87 arithmetic breaks: use -msse2 -mfpmath=sse."
#endif

// nvcc and others with EDG's front end have vector extensions, but not for vectors whose length depends on a template.
#if !defined(INSONIFY_SIMD)
#if defined(__GNUC__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ && !defined(__NVCC__) && !defined(__EDG__)
#define INSONIFY_SIMD 1
#else
#define INSONIFY_SIMD 0
#endif
#endif

#if !defined(INSONIFY_ASSERT)
#include <cassert>
#define INSONIFY_ASSERT(condition) assert(condition)
#endif

// Fused multiply-add rounds once where a product and a sum round twice, so contraction changes results. These two
// macros enclose every header with floating-point arithmetic and disable contraction whatever the flags, except that
// clang ignores the pragma under an explicit -ffp-contract=fast (not under fast-honor-pragmas). They also suppress
// g++'s note on the ABI of wide vectors, which are passed only within always-inlined code, and g++ 11's false warnings
// about vectors that are filled lane by lane.
#if defined(__clang__) && !defined(__x86_64__) && !defined(__i386__)
// clang has float_control on x86 alone: elsewhere contraction stays off to the end of the unit, also in the user's own
// code after the include.
#define INSONIFY_ARITHMETIC_BEGIN _Pragma("clang fp contract(off)")
#define INSONIFY_ARITHMETIC_END
#elif defined(__clang__)
#define INSONIFY_ARITHMETIC_BEGIN _Pragma("float_control(push)") _Pragma("clang fp contract(off)")
#define INSONIFY_ARITHMETIC_END _Pragma("float_control(pop)")
#elif defined(__GNUC__)
#define INSONIFY_ARITHMETIC_BEGIN                                                                         \
    INSONIFY_CONTRACTION_OFF _Pragma("GCC diagnostic push") _Pragma("GCC diagnostic ignored \"-Wpsabi\"") \
        INSONIFY_FILLED_BY_LANE
#define INSONIFY_ARITHMETIC_END _Pragma("GCC diagnostic pop") INSONIFY_CONTRACTION_BACK
#if __GNUC__ < 12
#define INSONIFY_FILLED_BY_LANE _Pragma("GCC diagnostic ignored \"-Wmaybe-uninitialized\"")
#else
#define INSONIFY_FILLED_BY_LANE
#endif
#if defined(__FP_FAST_FMA)
#define INSONIFY_CONTRACTION_OFF _Pragma("GCC push_options") _Pragma("GCC optimize(\"fp-contract=off\")")
#define INSONIFY_CONTRACTION_BACK _Pragma("GCC pop_options")
#else
#define INSONIFY_CONTRACTION_OFF
#define INSONIFY_CONTRACTION_BACK
#endif
#else
#define INSONIFY_ARITHMETIC_BEGIN
#define INSONIFY_ARITHMETIC_END
#endif

// The compiled form: heavy functions are declared everywhere and defined in one unit. Header-only, they are inline.
#if defined(INSONIFY_IMPLEMENTATION)
#if !defined(INSONIFY_COMPILED)
#define INSONIFY_COMPILED
#endif
#if defined(__GNUC__) && !defined(__OPTIMIZE__)
#warning "INSONIFY_IMPLEMENTATION without optimization: rendering will be slow. Compile this unit with -O2."
#endif
#define INSONIFY_BODIES 1
#define INSONIFY_FUNCTION
#elif defined(INSONIFY_COMPILED)
#define INSONIFY_BODIES 0
#define INSONIFY_FUNCTION
#else
#define INSONIFY_BODIES 1
#define INSONIFY_FUNCTION inline
#endif

// Run-time dispatch to wider instruction sets: x86-64 with GNU attributes, and only where kernels are optimized. Other
// builds compile one path, with bit-identical results.
#if INSONIFY_SIMD && defined(__x86_64__) && defined(__GNUC__) && defined(__OPTIMIZE__)
#define INSONIFY_DISPATCH 1
#else
#define INSONIFY_DISPATCH 0
#endif

// INSONIFY_WHOLE_KERNELS: with 1, all calls of a kernel are inlined into one function. With 0, programs compile a
// little faster and run several times longer, with bit-identical results. The default is 0 without optimization and
// under sanitizers, whose instrumentation would take minutes to compile.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define INSONIFY_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define INSONIFY_SANITIZED 1
#endif
#endif
#if !defined(INSONIFY_WHOLE_KERNELS)
#if defined(__GNUC__) && defined(__OPTIMIZE__) && !defined(INSONIFY_SANITIZED)
#define INSONIFY_WHOLE_KERNELS 1
#else
#define INSONIFY_WHOLE_KERNELS 0
#endif
#endif

#if INSONIFY_WHOLE_KERNELS
#define INSONIFY_TARGET(isa) __attribute__((target(isa), flatten, noinline))
#define INSONIFY_INLINE inline __attribute__((always_inline))
#define INSONIFY_INLINE_LAMBDA __attribute__((always_inline))
#else
#define INSONIFY_TARGET(isa) __attribute__((target(isa), noinline))
#define INSONIFY_INLINE inline
#define INSONIFY_INLINE_LAMBDA
#endif
#if defined(__GNUC__)
#define INSONIFY_RARE __attribute__((noinline))
#else
#define INSONIFY_RARE
#endif

// For functions whose target attribute adds fused multiply-add, where g++ would contract products and sums. For clang,
// INSONIFY_ARITHMETIC_BEGIN is enough.
#if defined(__GNUC__) && !defined(__clang__)
#define INSONIFY_NEVER_FUSED __attribute__((optimize("fp-contract=off")))
#else
#define INSONIFY_NEVER_FUSED
#endif

#define INSONIFY_JOIN_RAW(a, b) a##b
#define INSONIFY_JOIN(a, b) INSONIFY_JOIN_RAW(a, b)

// Tiers of the instruction sets that the flags of a unit allow without a run-time check. _sse42 and _avx2 are x86-64-v2
// and v3, or more of the same tier.
#if !INSONIFY_SIMD
#define INSONIFY_TAG_SIMD built_scalar
#else
#define INSONIFY_TAG_SIMD built
#endif
#if defined(__AVX512F__)
#define INSONIFY_TAG_TARGET _avx512
#elif defined(__AVX2__) && defined(__FMA__) && defined(__BMI2__)
#define INSONIFY_TAG_TARGET _avx2
#elif defined(__AVX2__) || defined(__FMA__) || defined(__BMI__) || defined(__BMI2__)
#define INSONIFY_TAG_TARGET _avx_bmi
#elif defined(__AVX__)
#define INSONIFY_TAG_TARGET _avx
#elif defined(__SSE4_2__) && defined(__POPCNT__)
#define INSONIFY_TAG_TARGET _sse42
#elif defined(__SSE3__) || defined(__SSSE3__) || defined(__SSE4_1__) || defined(__POPCNT__)
#define INSONIFY_TAG_TARGET _sse3
#elif defined(__ARM_FEATURE_SVE)
#define INSONIFY_TAG_TARGET _sve
#else
#define INSONIFY_TAG_TARGET
#endif

#if defined(__OPTIMIZE__) || !defined(__GNUC__)
#define INSONIFY_TAG_SPEED
#else
#define INSONIFY_TAG_SPEED _debug
#endif

#if defined(INSONIFY_SANITIZED)
#define INSONIFY_TAG_SANITIZED _sanitized
#else
#define INSONIFY_TAG_SANITIZED
#endif

#if defined(NDEBUG)
#define INSONIFY_TAG_ASSERT
#else
#define INSONIFY_TAG_ASSERT _checked
#endif

#if defined(__cpp_exceptions)
#define INSONIFY_TAG_EXCEPTIONS
#else
#define INSONIFY_TAG_EXCEPTIONS _noexcept
#endif

#define INSONIFY_ABI_OF(major, minor, patch) v##major##_##minor##_##patch
#define INSONIFY_ABI_NAME(major, minor, patch) INSONIFY_ABI_OF(major, minor, patch)
#define INSONIFY_ABI INSONIFY_ABI_NAME(INSONIFY_VERSION_MAJOR, INSONIFY_VERSION_MINOR, INSONIFY_VERSION_PATCH)
#define INSONIFY_FLAGS                                                                                      \
    INSONIFY_JOIN(INSONIFY_JOIN(INSONIFY_JOIN(INSONIFY_TAG_SIMD, INSONIFY_TAG_TARGET), INSONIFY_TAG_SPEED), \
                  INSONIFY_JOIN(INSONIFY_JOIN(INSONIFY_TAG_SANITIZED, INSONIFY_TAG_ASSERT), INSONIFY_TAG_EXCEPTIONS))
#if defined(INSONIFY_COMPILED)
#define INSONIFY_ONCE compiled
#else
#define INSONIFY_ONCE INSONIFY_FLAGS
#endif

// Members of public types. One-line members are always inlined, even without optimization; longer ones carry the flags
// of their unit, or the tag of the compiled form, in their mangled names.
#if defined(__GNUC__)
#define INSONIFY_MEMBER inline __attribute__((always_inline))
#define INSONIFY_TAGGED __attribute__((abi_tag(INSONIFY_TEXT(INSONIFY_FLAGS))))
#define INSONIFY_TAGGED_ONCE __attribute__((abi_tag(INSONIFY_TEXT(INSONIFY_ONCE))))
#else
#define INSONIFY_MEMBER
#define INSONIFY_TAGGED
#define INSONIFY_TAGGED_ONCE
#endif
#define INSONIFY_TEXT_RAW(x) #x
#define INSONIFY_TEXT(x) INSONIFY_TEXT_RAW(x)

namespace insonify {
inline namespace INSONIFY_ABI {}
}  // namespace insonify
