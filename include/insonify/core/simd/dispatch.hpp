// Run-time dispatch: a kernel is written once over a lane count and compiled for several instruction sets.
//
// A kernel is a struct with `template <int N> INSONIFY_INLINE void run() const`, where N is the number of 32-bit values
// that it processes at a time. Its arithmetic is the same in every lane at every N, and products are never fused with
// sums, so all levels give the same bytes; N = 1 is scalar code, compiled where INSONIFY_SIMD is 0. Kernels that gain
// more than a tenth from AVX-512 declare `static constexpr int avx512_lanes = 16`; the others have no copy for it,
// since each costs compile time.
#pragma once

#include <insonify/core/error.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Instruction sets that kernels are compiled for, slowest first.
enum class isa {
    scalar,    ///< one value at a time, in builds with INSONIFY_SIMD=0; other builds use `baseline` instead
    baseline,  ///< the 128-bit vectors that every processor of the target has (SSE2, NEON)
    avx2,      ///< 256-bit integer and float vectors
    avx512,    ///< 512-bit ones (F, BW, DQ and VL), for kernels that gain from them
};

inline namespace INSONIFY_ONCE {

/// The widest instruction set that the library's kernels were compiled for and this processor runs.
INSONIFY_FUNCTION isa best_isa();

#if INSONIFY_BODIES
INSONIFY_FUNCTION isa best_isa() {
#if INSONIFY_DISPATCH
    static const isa best = [] {
        if (!__builtin_cpu_supports("avx2")) return isa::baseline;
        const bool is_wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
        return is_wide ? isa::avx512 : isa::avx2;
    }();
    return best;
#elif INSONIFY_SIMD
    return isa::baseline;
#else
    return isa::scalar;
#endif
}
#endif

}  // namespace INSONIFY_ONCE

namespace detail::inline INSONIFY_FLAGS {

#if INSONIFY_DISPATCH
template <class Kernel>
INSONIFY_TARGET("avx2")
void run_avx2(const Kernel& kernel) {
    kernel.template run<8>();
}
// AVX-512F includes fused multiply-add, AVX2 does not.
template <class Kernel>
INSONIFY_TARGET("avx512f,avx512bw,avx512dq,avx512vl")
INSONIFY_NEVER_FUSED void run_avx512(const Kernel& kernel) {
    kernel.template run<Kernel::avx512_lanes>();
}
#endif

/// Runs the kernel at `level`, or at the widest level below it that this build and processor have.
template <class Kernel>
void dispatch(const Kernel& kernel, isa level) {
    if (level > best_isa()) level = best_isa();
#if INSONIFY_DISPATCH
    if constexpr (requires { Kernel::avx512_lanes; }) {
        if (level == isa::avx512) return run_avx512(kernel);
    }
    if (level >= isa::avx2) return run_avx2(kernel);
#endif
#if INSONIFY_SIMD
    kernel.template run<4>();
#else
    kernel.template run<1>();
#endif
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
