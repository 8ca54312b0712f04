// File locks that keep two generators from making the same images. On file systems without locks both make them, with
// the same bytes.
#pragma once

#include <insonify/io/file.hpp>

#include <cerrno>
#include <filesystem>
#include <string>

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <unistd.h>
#endif

namespace generator {

/// One lock file per folder: shard k locks byte k, operations on the whole folder lock all bytes. These are POSIX
/// record locks, which work over NFS and are released when the process ends for any reason.
class folder_lock {
  public:
    /// @param shard  or -1 for the whole folder
    /// @throws io_error if another process holds it, or the lock file can't be opened
    folder_lock(const std::filesystem::path& folder, std::int64_t shard) {
#if defined(__unix__) || defined(__APPLE__)
        const std::string path = (folder / ".lock").string();
        handle_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
        if (handle_ < 0) insonify::detail::raise_io(path, "can't open the lock", errno);
        struct flock bytes {};
        bytes.l_type = F_WRLCK;
        bytes.l_whence = SEEK_SET;
        bytes.l_start = shard < 0 ? 0 : shard;
        bytes.l_len = shard < 0 ? 0 : 1;
        if (::fcntl(handle_, F_SETLK, &bytes) == 0) return;
        const int reason = errno;
        if (reason != EACCES && reason != EAGAIN) {  // no locks here
            without_ = std::error_code(reason, std::generic_category()).message();
            return;
        }
        ::close(handle_);
        throw insonify::io_error(folder.string() + ": another generator is running in this folder" +
                                 (shard < 0 ? "" : ", on shard " + std::to_string(shard)) +
                                 "; wait for it to end, or name another folder");
#else
        static_cast<void>(folder), static_cast<void>(shard);
        without_ = "not on this system";
#endif
    }
    ~folder_lock() {
#if defined(__unix__) || defined(__APPLE__)
        if (handle_ >= 0) ::close(handle_);
#endif
    }
    folder_lock(const folder_lock&) = delete;
    folder_lock& operator=(const folder_lock&) = delete;

    /// Reason for the lack of a lock; empty if there is one.
    const std::string& without() const {
        return without_;
    }

  private:
    int handle_ = -1;
    std::string without_;
};

}  // namespace generator
