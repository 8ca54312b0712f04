// Links translation units with different flags into one program: separate symbols, the same bytes.
#include <set>
#include <vector>

#include "../catch.hpp"
#include "probe.hpp"

TEST_CASE("Translation units with different flags link into one program, share no symbol and draw the same bytes") {
    std::vector<probe_result> results{probe_scalar(), probe_simd(), probe_checked(), probe_bare()};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) results.push_back(probe_avx2());
#endif
    std::set<std::string> tags;
    for (const probe_result& result : results) {
        CHECK(result.bytes == results[0].bytes);
        tags.insert(result.abi);
    }
    CHECK(tags.size() == results.size());

    // The cube covers a part of the picture.
    CHECK(results[0].uncovered > 97 * 61 / 2);
    CHECK(results[0].uncovered < 97 * 61);
}
