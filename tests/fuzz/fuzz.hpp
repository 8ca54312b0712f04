// Shared by the fuzz targets: reads numbers from bytes, and aborts where an invariant does not hold.
#pragma once

#include <insonify/core/image.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>

namespace fuzzing {

/// Takes numbers off the front. Past the end all are zero, so every prefix of an input is an input.
class byte_reader {
  public:
    byte_reader(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

    template <class T>
    T take() {
        T value{};
        const std::size_t size = (std::min)(sizeof value, rest_.size());
        std::copy_n(rest_.begin(), size, reinterpret_cast<std::uint8_t*>(&value));
        rest_ = rest_.subspan(size);
        return value;
    }
    /// 0 to count - 1, for count up to 256.
    int below(int count) { return take<std::uint8_t>() % count; }

  private:
    std::span<const std::uint8_t> rest_;
};

/// Aborts, which fuzzers report as a finding.
[[noreturn]] inline void fail(const char* invariant) {
    std::fprintf(stderr, "Broken invariant: %s\n", invariant);
    std::abort();
}
inline void demand(bool holds, const char* invariant) {
    if (!holds) fail(invariant);
}

/// NaN equals itself here, and zero isn't minus zero.
template <class T>
bool same_bytes(const insonify::image<T>& a, const insonify::image<T>& b) {
    return a.width() == b.width() && a.height() == b.height() &&
           (a.empty() || std::memcmp(a.pixels().data(), b.pixels().data(), a.size() * sizeof(T)) == 0);
}

}  // namespace fuzzing

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
