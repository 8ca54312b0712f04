// Memory that runs out under images and thread pools: std::bad_alloc comes out, and a pool goes on.
#include <insonify/core/image.hpp>
#include <insonify/core/thread_pool.hpp>

#include <vector>

#include "../../failing_new.hpp"

namespace in = insonify;

TEST_CASE("A pool starts with the threads that memory allows, and passes a failed allocation of its work on") {
    CHECK(failing_new::in_turn([] {
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

TEST_CASE("An image that cannot be copied leaves the one it was to replace") {
    const in::image<float> large(40, 30, 2.0f);
    CHECK(failing_new::in_turn([&] {
              in::image<float> held(3, 3, 1.0f);
              try {
                  held = large;
                  return held == large;
              } catch (const std::bad_alloc&) {
                  return held == in::image<float>(3, 3, 1.0f);
              }
          }) > 1);
}
