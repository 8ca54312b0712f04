// Thread pools where the system refuses to start more threads.
#include <insonify/core/thread_pool.hpp>

#include <atomic>
#include <vector>

#include "../../catch.hpp"

#if defined(__linux__) && !defined(INSONIFY_SANITIZED)  // sanitizers replace pthread_create, too
#include <cerrno>

#include <dlfcn.h>
#include <pthread.h>

namespace {
std::atomic<int> threads_left{1 << 20};
}

// Replaces the system's function: fails as under `ulimit -u` or a container's limit on processes.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*),
                              void* argument) noexcept {
    using function = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    static const auto real = reinterpret_cast<function>(::dlsym(RTLD_NEXT, "pthread_create"));
    return threads_left-- > 0 ? real(thread, attributes, run, argument) : EAGAIN;
}

namespace in = insonify;

TEST_CASE("A pool works with the threads that the system starts") {
    const int limit = GENERATE(0, 1, 5);
    threads_left = limit;
    in::thread_pool pool(64);
    threads_left = 1 << 20;
    CHECK(pool.threads() == limit + 1);
    std::vector<std::atomic<int>> made(1000);
    pool.bulk(made.size(), [&](std::size_t i) { ++made[i]; });
    CHECK(std::vector<int>(made.begin(), made.end()) == std::vector<int>(1000, 1));
}
#else
TEST_CASE("A pool works with the threads that the system starts") {
    SUCCEED("pthread_create is the system's own here");
}
#endif
