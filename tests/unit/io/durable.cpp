// What write_file() flushes to disk, and in which order.
#include <insonify/io/file.hpp>

#include "../../catch.hpp"

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SANITIZED 1  // sanitizers replace fsync, too
#endif
#endif

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(SANITIZED)
#include <filesystem>
#include <vector>

#include <sys/stat.h>

namespace {
std::vector<bool> synced_folders;  // of each call of fsync: whether it was for a folder
}

// Replaces the system's function.
extern "C" int fsync(int file) {
    struct stat status {};
    synced_folders.push_back(::fstat(file, &status) == 0 && S_ISDIR(status.st_mode));
    return 0;
}

TEST_CASE("write_file() flushes the file to disk, then its folder") {
    const auto path = std::filesystem::temp_directory_path() / "insonify_durable";
    synced_folders.clear();
    insonify::write_file(path.string(), "bytes");
    std::filesystem::remove(path);
    CHECK(synced_folders == std::vector<bool>{false, true});
}
#else
TEST_CASE("write_file() flushes the file to disk, then its folder") {
    SUCCEED("fsync is the system's own here");
}
#endif
