#include "staging.hpp"

#include <insonify/io/file.hpp>

#include <cerrno>
#include <chrono>

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <unistd.h>
#endif

namespace generator {

namespace fs = std::filesystem;
using insonify::detail::raise_io;

namespace {

/// A name unique among all processes that share the folder, across machines.
std::string process_name() {
    std::string name;
#if defined(__unix__) || defined(__APPLE__)
    char host[256] = {};
    if (::gethostname(host, sizeof host - 1) == 0) name = host;
    for (char& c : name)
        if (c == '/') c = '_';
    name += "-" + std::to_string(::getpid());
#endif
    return name + "-" + std::to_string(std::chrono::steady_clock::now().time_since_epoch().count());
}

}  // namespace

void sync_folder(const fs::path& folder) {
#if defined(__unix__) || defined(__APPLE__)
    const int handle = ::open(folder.c_str(), O_RDONLY | O_CLOEXEC);
    if (handle < 0) raise_io(folder.string(), "can't open", errno);
    const int failed = ::fsync(handle) == 0 ? 0 : errno;
    ::close(handle);
    // File systems that cannot sync folders report EINVAL or EBADF.
    if (failed == EIO || failed == ENOSPC || failed == EDQUOT) raise_io(folder.string(), "can't sync", failed);
#else
    static_cast<void>(folder);
#endif
}

staged_file::staged_file(std::string temporary, std::string path)
    : temporary_(std::move(temporary)), path_(std::move(path)) {
    errno = 0;
    stream_ = std::fopen(temporary_.c_str(), "w+bx");
    if (stream_ == nullptr && errno != ENOENT) raise_io(path_, "can't open for writing", errno);
}
staged_file::staged_file(staged_file&& other) noexcept
    : temporary_(std::exchange(other.temporary_, {})),
      path_(std::move(other.path_)),
      stream_(std::exchange(other.stream_, nullptr)) {}

staged_file::~staged_file() {
    if (stream_ != nullptr) std::fclose(stream_);
    if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void staged_file::write(std::string_view bytes) {
    errno = 0;
    if (stream_ != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size())
        raise_io(path_, "can't write", errno != 0 ? errno : EIO);
}

void staged_file::read_back(const std::function<void(std::string_view)>& visit) {
    if (stream_ == nullptr) throw lost_file(path_);
    errno = 0;
    if (std::fseek(stream_, 0, SEEK_SET) != 0) raise_io(path_, "can't write", errno);
    std::vector<char> bytes(1 << 20);
    while (const std::size_t size = std::fread(bytes.data(), 1, bytes.size(), stream_)) visit({bytes.data(), size});
    if (std::ferror(stream_) != 0) raise_io(path_, "can't read back", errno);
}

void staged_file::finish() {
    if (stream_ == nullptr) return;
    errno = 0;
    const bool synced = insonify::detail::sync_to_disk(stream_);
    const int failed = errno;
    if (std::fclose(std::exchange(stream_, nullptr)) != 0 || !synced)
        raise_io(path_, "can't write", failed != 0 ? failed : errno);
}

bool staged_file::place() {
    errno = 0;
    if (insonify::detail::rename_over(temporary_, path_)) {
        temporary_.clear();
        return true;
    }
    if (errno != ENOENT) raise_io(path_, "can't replace", errno);
    return false;
}

staged_file::outcome staged_file::place_if_absent() {
#if defined(__unix__) || defined(__APPLE__)
    errno = 0;
    if (::link(temporary_.c_str(), path_.c_str()) == 0) return outcome::placed;
    if (errno == EEXIST) return outcome::exists;
#endif
    // The file system has no hard links, or the temporary file is gone.
    if (fs::exists(path_)) return outcome::exists;
    return place() ? outcome::placed : outcome::lost;
}

staging::staging(const fs::path& root, const std::string& unit)
    : root_(root), folder_(root / ".partial" / unit), process_(process_name()) {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    fs::create_directories(folder_, ignored);  // a failure is reported by the first file
}

staging::~staging() {
    std::error_code ignored;  // fails while another process has files there
    fs::remove(folder_, ignored);
    fs::remove(folder_.parent_path(), ignored);
}

void staging::make_folder(const fs::path& folder) {
    {
        const std::lock_guard lock(mutex_);
        if (folders_.contains(folder)) return;
    }
    std::error_code failed;
    const bool made = fs::create_directories(folder, failed);
    if (failed) throw insonify::io_error(folder.string() + ": can't make this folder: " + failed.message());
    if (made)
        for (fs::path above = folder; above != root_ && above.has_relative_path(); above = above.parent_path())
            sync_folder(above.parent_path());
    const std::lock_guard lock(mutex_);
    folders_.insert(folder);
}

std::string staging::temporary_name() {
    return (folder_ / (process_ + "-" + std::to_string(count_++))).string();
}

bool staging::put_group(const std::vector<file>& group) {
    std::set<fs::path> touched;
    std::vector<staged_file> staged;
    staged.reserve(group.size());
    for (const file& f : group) {
        const fs::path path = root_ / f.path;
        make_folder(path.parent_path());
        touched.insert(path.parent_path());
        staged.emplace_back(temporary_name(), path.string());
        staged.back().write(f.bytes);
    }
    for (staged_file& f : staged) f.finish();
    for (staged_file& f : staged)
        if (!f.place()) return false;
    for (const fs::path& folder : touched) sync_folder(folder);
    return true;
}

void staging::put(const std::vector<std::vector<file>>& groups) {
    for (const std::vector<file>& group : groups)
        retry_lost([&] {
            if (!put_group(group)) throw lost_file((root_ / group.front().path).string());
        });
}

void staging::retry_lost(const std::function<void()>& write) {
    for (int attempt = 1;; ++attempt) try {
            return write();
        } catch (const lost_file&) {
            if (attempt == 100) throw;
            restore();
        }
}

void staging::restore() {
    const std::lock_guard lock(mutex_);
    folders_.clear();
    std::error_code failed;
    fs::create_directories(folder_, failed);
    if (failed && failed != std::errc::no_such_file_or_directory)
        throw insonify::io_error(folder_.string() + ": can't make this folder: " + failed.message());
}

bool staging::write_if_absent(const file& f) {
    const std::string path = (root_ / f.path).string();
    bool first = false;
    retry_lost([&] {
        staged_file staged(temporary_name(), path);
        staged.write(f.bytes);
        staged.finish();
        const staged_file::outcome found = staged.place_if_absent();
        if (found == staged_file::outcome::lost) throw lost_file(path);
        first = found == staged_file::outcome::placed;
    });
    sync_folder(root_);
    return first;
}

staged_file staging::open(const std::string& path) {
    make_folder((root_ / path).parent_path());
    return {temporary_name(), (root_ / path).string()};
}

void staging::put(staged_file& f, const std::string& path) {
    f.finish();
    if (!f.place()) throw lost_file((root_ / path).string());
    sync_folder((root_ / path).parent_path());
}

}  // namespace generator
