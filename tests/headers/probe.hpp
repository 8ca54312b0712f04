// Results of one translation unit in the flags test.
#pragma once

#include <cstdint>
#include <string>

struct probe_result {
    std::string abi;          // the tag that keeps its symbols apart
    std::uint64_t bytes;      // a checksum of the picture
    std::uint64_t uncovered;  // pixels without a triangle
};

probe_result probe_scalar();
probe_result probe_simd();
probe_result probe_checked();
probe_result probe_bare();
#if defined(__x86_64__)
probe_result probe_avx2();
#endif
