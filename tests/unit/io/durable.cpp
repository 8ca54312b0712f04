// What write_file() flushes to disk, and in which order.
#include <insonify/io/file.hpp>

#include "../../catch.hpp"

#if defined(__linux__) && !defined(INSONIFY_SANITIZED)  // sanitizers replace fsync, too
#include <cerrno>
#include <vector>

#include "../../scratch_folder.hpp"
#include <sys/stat.h>

namespace {

struct synced {
    ino_t node;
    bool target_exists;
    bool operator==(const synced&) const = default;
};
std::vector<synced> calls;  // of fsync
std::string target;
bool fails = false;

bool exists(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0;
}
ino_t node_of(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

}  // namespace

// Replaces the system's function.
extern "C" int fsync(int file) {
    struct stat status {};
    calls.push_back({::fstat(file, &status) == 0 ? status.st_ino : 0, exists(target)});
    if (!fails) return 0;
    errno = EIO;
    return -1;
}

TEST_CASE("write_file() flushes the file to disk before it has its name, then the folder") {
    const scratch_folder folder;
    target = folder / "name";
    calls.clear();
    insonify::write_file(target, "bytes");
    CHECK(calls == std::vector<synced>{{node_of(target), false}, {node_of(folder.path.string()), true}});
}

TEST_CASE("A file that cannot be flushed does not replace the old one") {
    const scratch_folder folder;
    target = folder / "name";
    insonify::write_file(target, "old");
    fails = true;
    CHECK_THROWS_WITH(insonify::write_file(target, "new"), ContainsSubstring("can't write: Input/output error"));
    fails = false;
    CHECK(insonify::read_file(target) == "old");
    CHECK(folder.names().size() == 1);
}
#else
TEST_CASE("write_file() flushes the file to disk before it has its name, then the folder") {
    SUCCEED("fsync is the system's own here");
}
#endif
