// Reads input files that a user names. Refuses folders, pipes, devices and files above a size limit.
#pragma once

#include <insonify/io/file.hpp>

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <string>

namespace examples {

/// Default limit of an input's size, bytes.
inline constexpr std::uint64_t usual_input_limit = std::uint64_t{1} << 30;

/// Whether a character is a control character other than a tab, carriage return or line feed.
inline bool is_control(char c) {
    return (c >= '\0' && c < ' ' && c != '\t' && c != '\r' && c != '\n') || c == '\x7F';
}

/// @param raise  how the user raises the limit, for the error message
/// @throws insonify::io_error, naming the file, for a pipe, device or folder, a file above the limit, or one that can't
/// be read
inline std::string read_input(const std::string& path, std::uint64_t limit = usual_input_limit,
                              const std::string& raise = "take a smaller file") {
    // Checked before the file is opened, since opening a pipe can block forever.
    std::error_code failed;
    const std::filesystem::file_status status = std::filesystem::status(path, failed);
    if (failed && status.type() != std::filesystem::file_type::not_found)
        throw insonify::io_error(path + ": can't read: " + failed.message());
    if (status.type() == std::filesystem::file_type::not_found) throw insonify::io_error(path + ": does not exist");
    if (status.type() != std::filesystem::file_type::regular)
        throw insonify::io_error(path + ": is a folder, pipe or device; name a plain file");

    errno = 0;
    const insonify::detail::file_handle file(path, "rb");
    if (file.get() == nullptr) insonify::detail::raise_io(path, "can't open for reading", errno);
    std::string bytes;
    for (std::size_t filled = 0;;) {
        bytes.resize(filled == 0 ? 65536 : 2 * filled);
        filled += std::fread(bytes.data() + filled, 1, bytes.size() - filled, file.get());
        if (std::ferror(file.get()) != 0) insonify::detail::raise_io(path, "can't read", errno);
        if (filled > limit)
            throw insonify::io_error(path + ": is larger than " + std::to_string(limit) + " bytes: " + raise);
        if (filled == bytes.size()) continue;
        bytes.resize(filled);
        return bytes;
    }
}

}  // namespace examples
