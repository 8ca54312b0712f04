// Whole-file reads and atomic writes: a reader sees the old file or the new one, never a partial one.
#pragma once

#include <insonify/core/detail/file.hpp>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#if defined(_WIN32)
// std::rename of Windows does not replace files.
extern "C" __declspec(dllimport) int __stdcall MoveFileExA(const char* from, const char* to, unsigned long flags);
#endif

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

inline bool sync_to_disk(std::FILE* stream) {
    if (std::fflush(stream) != 0) return false;
#if defined(__unix__) || defined(__APPLE__)
    return ::fsync(::fileno(stream)) == 0;
#else
    return true;
#endif
}

/// Whether a path names a device, a pipe or a folder, which a new file must not replace.
inline bool is_special(const std::string& path) {
#if defined(__unix__) || defined(__APPLE__)
    struct stat found;
    return ::stat(path.c_str(), &found) == 0 && !S_ISREG(found.st_mode);
#else
    static_cast<void>(path);
    return false;
#endif
}

/// Position of the file's name in a path.
inline std::size_t name_begin(const std::string& path) {
#if defined(_WIN32)
    return path.find_last_of("/\\") + 1;  // 0 without a folder
#else
    return path.find_last_of('/') + 1;
#endif
}
/// Path of the folder that contains `path`.
inline std::string folder_of(const std::string& path) {
    const std::size_t begin = name_begin(path);
    return begin == 0 ? "." : path.substr(0, begin);
}

/// Syncs a folder's entries to disk. Failure is ignored: the file itself is on disk, and some network file systems
/// cannot sync folders.
inline void sync_folder(const std::string& folder) noexcept {
#if defined(__unix__) || defined(__APPLE__)
    const int handle = ::open(folder.c_str(), O_RDONLY | O_CLOEXEC);
    if (handle < 0) return;
    static_cast<void>(::fsync(handle));
    ::close(handle);
#else
    static_cast<void>(folder);
#endif
}

inline bool rename_over(const std::string& from, const std::string& to) {
#if defined(_WIN32)
    constexpr unsigned long replace_and_write_through = 1 | 8;
    if (MoveFileExA(from.c_str(), to.c_str(), replace_and_write_through) != 0) return true;
    errno = EACCES;  // nearly always: another process has it open
    return false;
#else
    return std::rename(from.c_str(), to.c_str()) == 0;
#endif
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// The bytes of a file.
/// @throws io_error if it can't be opened or read
inline std::string read_file(const std::string& path) {
    return detail::file_bytes(path);
}

/// A temporary file beside the one that it will replace. `commit` syncs it to disk and renames it; without a commit it
/// is removed and the old file stays. A symbolic link is replaced, not followed. The file is a new one: it has the
/// process's default mode and owner, and other hard links keep the old content.
///
/// The temporary name is the path with the first free suffix of .tmp0, .tmp1, ..., so that concurrent writers of one
/// path do not collide; the last to commit wins. Names of more than 240 bytes are cut, as many file systems hold 255.
class replacement_file {
  public:
    /// @throws io_error if no file can be created in the folder of `path`, or `path` is a device, a pipe, a folder
    /// or a link to one
    explicit replacement_file(std::string path) : path_(std::move(path)) {
        if (path_.find('\0') != std::string::npos)
            detail::raise_io(path_.c_str(), "can't open for writing: its name contains a null byte");
        if (path_.empty()) detail::raise_io(path_, "can't open for writing");
        if (detail::is_special(path_)) detail::raise_io(path_, "can't open for writing: not a regular file");
        const std::string shortened = path_.substr(0, detail::name_begin(path_) + 240);
        for (int number = 0; file_.get() == nullptr; ++number) {
            temporary_ = shortened + ".tmp" + detail::to_text(number);
            errno = 0;
            file_ = detail::file_handle(temporary_, "wbx");  // x: only if there is no such file
            if (file_.get() == nullptr && (errno != EEXIST || number == 9999))
                detail::raise_io(path_, "can't open for writing", errno);
        }
    }
    replacement_file(const replacement_file&) = delete;
    replacement_file& operator=(const replacement_file&) = delete;
    ~replacement_file() {
        if (temporary_.empty()) return;
        file_.close();
        std::remove(temporary_.c_str());
    }

    /// Appends. Does not throw, so that C libraries may call it; `commit` reports failures.
    void write(const void* data, std::size_t size) noexcept {
        errno = 0;
        if (error_ == 0 && std::fwrite(data, 1, size, file_.get()) != size) error_ = errno != 0 ? errno : EIO;
    }

    /// Call once, at the end.
    /// @throws io_error if a write failed, or the file can't be synced to disk or renamed
    void commit() {
        errno = 0;
        const bool written = error_ == 0 && detail::sync_to_disk(file_.get());
        if (!(file_.close() && written)) detail::raise_io(path_, "can't write", error_ != 0 ? error_ : errno);
        const std::string folder = detail::folder_of(path_);  // before the rename: nothing after it may throw
        if (!detail::rename_over(temporary_, path_)) detail::raise_io(path_, "can't replace", errno);
        temporary_.clear();
        detail::sync_folder(folder);
    }

  private:
    std::string path_;
    std::string temporary_;
    detail::file_handle file_;
    int error_ = 0;
};

/// Writes `bytes` to `path` atomically.
/// @throws io_error if it can't be written; an existing file then stays as it was
inline void write_file(const std::string& path, std::string_view bytes) {
    replacement_file file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify
