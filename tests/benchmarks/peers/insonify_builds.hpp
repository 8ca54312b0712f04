// Other builds of the library: for this machine's processor alone, and without vector instructions. Both are compared
// with the default build.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

namespace peers {

/// Draws a frame into a picture's bytes.
using draws = std::function<void(std::span<std::uint8_t>)>;

/// -O3 for this machine's instructions.
/// @param size     of workload::sizes, by name
/// @param setting  of workload::settings, by name
draws insonify_native(char size, const char* setting, int threads);

/// INSONIFY_SIMD=0, all else as users build it.
draws insonify_scalar(char size, const char* setting, int threads);

}  // namespace peers
