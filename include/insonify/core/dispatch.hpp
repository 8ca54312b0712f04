// One kernel, several instruction sets: written once over a lane count, chosen when the program runs.
//
// A kernel is a function object with `template <int N> INSONIFY_INLINE void run() const`, where N is how many 32-bit
// values go through it at a time. Its arithmetic is the same in every lane at every N, and no target fuses products
// with sums (AVX-512 could), so all levels give the same bytes; N = 1 is plain scalar code.
#pragma once

#include <insonify/core/error.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// Instruction sets that kernels are compiled for, slowest first.
enum class isa {
    scalar,    ///< one value at a time
    baseline,  ///< the 128-bit vectors that every processor of the target has (SSE2, NEON)
    avx2,      ///< 256-bit integer and float vectors
};

/// The widest instruction set that this compiler built and this processor runs.
inline isa best_isa() {
#if INSONIFY_DISPATCH
    static const isa best = __builtin_cpu_supports("avx2") ? isa::avx2 : isa::baseline;
    return best;
#elif INSONIFY_SIMD
    return isa::baseline;
#else
    return isa::scalar;
#endif
}

namespace detail {

#if INSONIFY_DISPATCH
template <class Kernel>
INSONIFY_TARGET("avx2")
void run_avx2(const Kernel& kernel) {
    kernel.template run<8>();
}
#endif

/// Runs the kernel at `level`, or at the widest level below it that this build and processor have.
template <class Kernel>
void dispatch(const Kernel& kernel, isa level) {
    if (level > best_isa()) level = best_isa();
#if INSONIFY_DISPATCH
    if (level == isa::avx2) return run_avx2(kernel);
#endif
#if INSONIFY_SIMD
    if (level == isa::baseline) return kernel.template run<4>();
#endif
    kernel.template run<1>();
}

}  // namespace detail
}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
