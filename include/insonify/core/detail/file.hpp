// Opens and reads whole files.
#pragma once

#include <insonify/core/error.hpp>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// @param error  errno, whose message is appended; 0: none
[[noreturn]] inline void raise_io(std::string_view path, std::string_view reason, int error = 0) {
    std::string text = (path.empty() ? "a file with an empty name" : std::string(path)) + ": " + std::string(reason);
    if (error != 0) text += ": " + std::error_code(error, std::generic_category()).message();
    throw_error(io_error(text));
}

/// Owns an open file.
class file_handle {
  public:
    file_handle() = default;
    file_handle(const std::string& path, const char* mode) : stream_(std::fopen(path.c_str(), mode)) {}
    file_handle(file_handle&& other) noexcept : stream_(std::exchange(other.stream_, nullptr)) {}
    file_handle& operator=(file_handle&& other) noexcept {
        std::swap(stream_, other.stream_);
        return *this;
    }
    ~file_handle() { close(); }

    std::FILE* get() const { return stream_; }
    bool close() {
        std::FILE* const open = std::exchange(stream_, nullptr);
        return open == nullptr || std::fclose(open) == 0;
    }

  private:
    std::FILE* stream_ = nullptr;
};

/// The bytes of a file.
/// @throws io_error if it can't be opened or read
inline std::string file_bytes(const std::string& path) {
    if (path.find('\0') != path.npos) raise_io(path.c_str(), "can't open for reading: its name contains a null byte");
    errno = 0;
    const file_handle file(path, "rb");
    if (file.get() == nullptr) raise_io(path, "can't open for reading", errno);
    // Read until the end: pipes report no size.
    std::string bytes;
    std::size_t filled = 0;
    do {
        bytes.resize(filled == 0 ? 65536 : 2 * filled);
        filled += std::fread(bytes.data() + filled, 1, bytes.size() - filled, file.get());
    } while (filled == bytes.size());
    if (std::ferror(file.get()) != 0) raise_io(path, "can't read", errno);
    bytes.resize(filled);
    return bytes;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify
