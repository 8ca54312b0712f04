// Checks that stb_image does not make of PNG and JPEG files, for files from users.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace examples {

inline constexpr std::string_view png_signature = "\x89PNG\r\n\x1A\n", jpeg_signature = "\xFF\xD8\xFF";

/// Whether each chunk of a PNG lies within its bytes. stb_image allocates the length that a chunk claims before it
/// reads the chunk.
inline bool has_whole_chunks(std::string_view png) {
    const auto byte = [&](std::size_t at) { return static_cast<std::uint64_t>(static_cast<unsigned char>(png[at])); };
    for (std::uint64_t at = 8; at + 8 <= png.size();) {
        const std::uint64_t length = byte(at) << 24 | byte(at + 1) << 16 | byte(at + 2) << 8 | byte(at + 3);
        if (png.substr(at + 4, 4) == "IEND") break;
        at += 12 + length;
        if (at > png.size()) return false;
    }
    return true;
}

/// Whether each Huffman table of a JPEG has at most 256 symbols (ITU-T T.81, B.2.4.2) and fills its segment.
/// stb_image 2.27 writes the lengths of as many symbols as a table claims, 4080 at most, to an array of 257.
///
/// Finds the markers that stb_image finds: bytes between segments are passed over, as are stuffed zeros and restart
/// markers in the data of a scan.
inline bool has_sound_huffman_tables(std::string_view jpeg) {
    const auto byte = [&](std::size_t at) -> std::size_t { return static_cast<unsigned char>(jpeg[at]); };
    for (std::size_t at = 2; at + 1 < jpeg.size();) {
        if (byte(at++) != 0xFF) continue;
        while (at < jpeg.size() && byte(at) == 0xFF) ++at;  // fill bytes
        if (at == jpeg.size()) break;
        const std::size_t marker = byte(at++);
        if (marker == 0xD9) break;                                                       // end of image
        if (marker == 0 || marker == 1 || (marker >= 0xD0 && marker <= 0xD8)) continue;  // without a segment
        if (at + 2 > jpeg.size()) break;
        const std::size_t length = byte(at) << 8 | byte(at + 1), end = at + length;
        if (length < 2 || end > jpeg.size()) return marker != 0xC4;
        at += 2;
        while (marker == 0xC4 && at < end) {
            if (at + 17 > end) return false;
            std::size_t symbols = 0;
            for (int bits = 1; bits <= 16; ++bits) symbols += byte(at + static_cast<std::size_t>(bits));
            at += 17 + symbols;
            if (symbols > 256 || at > end) return false;
        }
        at = end;
    }
    return true;
}

}  // namespace examples
