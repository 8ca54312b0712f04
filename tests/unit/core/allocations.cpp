// Out of memory in images and thread pools: std::bad_alloc reaches the caller, and the pool stays usable.
#include <insonify/core/image.hpp>
#include <insonify/core/thread_pool.hpp>

#include <vector>

#include "../../failing_new.hpp"

namespace in = insonify;

TEST_CASE(
    "A pool starts with as many threads as memory allows, and a failed allocation in its work reaches the caller") {
    CHECK(failing_new::fail_each_allocation([] {
              in::thread_pool pool(4);
              std::vector<std::vector<int>> made(16);
              bool has_failed = false;
              try {
                  pool.bulk(made.size(), [&](std::size_t i) { made[i].assign(100, static_cast<int>(i)); });
              } catch (const std::bad_alloc&) {
                  has_failed = true;
              }
              failing_new::fails_at = 0;
              if (has_failed) pool.bulk(made.size(), [&](std::size_t i) { made[i].assign(100, static_cast<int>(i)); });
              int sum = 0;
              for (const std::vector<int>& row : made)
                  for (const int value : row) sum += value;
              return sum;
          }) > 16);
}

TEST_CASE("A failed assignment leaves an image unchanged") {
    const in::image<float> large(40, 30, 2.0f);
    CHECK(failing_new::fail_each_allocation([&] {
              in::image<float> held(3, 3, 1.0f);
              try {
                  held = large;
                  return held == large;
              } catch (const std::bad_alloc&) {
                  return held == in::image<float>(3, 3, 1.0f);
              }
          }) > 1);
}
