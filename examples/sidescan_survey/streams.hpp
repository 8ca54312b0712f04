// Appends rows to PGM and CSV files.
#pragma once

#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace survey {

namespace in = insonify;

/// A file that is appended to. Destruction closes it, too, but ignores errors such as a full disk.
class appended_file {
  public:
    /// @throws io_error if the file can't be written, as the other members
    explicit appended_file(const std::string& path) : path_(path), file_(path, std::ios::binary) { check(); }
    void append(std::string_view bytes) {
        file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        check();
    }
    void close() {
        file_.close();
        check();
    }

  private:
    void check() {
        if (!file_) throw in::io_error(path_ + ": can't be written");
    }
    std::string path_;
    std::ofstream file_;
};

/// A binary PGM whose rows are appended; the number of rows is known before.
class pgm_stream : public appended_file {
  public:
    pgm_stream(const std::string& path, int width, std::int64_t height, int largest) : appended_file(path) {
        append("P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n" + std::to_string(largest) + "\n");
    }
    void row(std::span<const std::uint8_t> pixels) {
        append({reinterpret_cast<const char*>(pixels.data()), pixels.size()});
    }
    /// 16 bits, big-endian as in PGM.
    void row(std::span<const std::uint16_t> pixels) {
        bytes_.clear();
        for (const std::uint16_t p : pixels) {
            bytes_.push_back(static_cast<std::uint8_t>(p >> 8));
            bytes_.push_back(static_cast<std::uint8_t>(p & 0xFF));
        }
        row(std::span<const std::uint8_t>(bytes_));
    }

  private:
    std::vector<std::uint8_t> bytes_;
};

/// A table whose lines are appended.
class csv_stream : public appended_file {
  public:
    csv_stream(const std::string& path, const std::string& header) : appended_file(path) { line(header); }
    void line(const std::string& text) { append(text + "\n"); }
};

/// Text of numbers, formatted by printf.
template <class... Values>
std::string format(const char* pattern, Values... values) {
    char text[512];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

/// Collects rows into pages of fixed height, written as gray and copper PNGs.
class pages {
  public:
    /// Removes the pages of an earlier survey, which may have had more.
    pages(const std::string& folder, int width, int height) : folder_(folder), page_(width, height) {
        std::vector<std::filesystem::path> earlier;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.is_regular_file() && is_page(entry.path().filename().string())) earlier.push_back(entry.path());
        for (const std::filesystem::path& page : earlier) std::filesystem::remove(page);
    }

    void row(std::span<const std::uint8_t> pixels) {
        std::copy(pixels.begin(), pixels.end(), page_.row(used_).begin());
        if (++used_ == page_.height()) finish();
    }
    /// Writes the rows so far.
    void finish() {
        if (used_ == 0) return;
        const in::image<std::uint8_t> part(page_.view().part(0, 0, page_.width(), used_));
        const std::string name = folder_ + format("/page_%04d", count_++);
        in::write_png(name + ".png", part);
        const auto gray = in::map_pixels(part, [](std::uint8_t p) { return static_cast<float>(p) / 255; });
        in::write_png(name + "_copper.png", gray | in::colormap::copper);
        used_ = 0;
    }

  private:
    /// page_0000.png, page_0000_copper.png and so on.
    static bool is_page(std::string_view name) {
        constexpr std::string_view begin = "page_";
        if (!name.starts_with(begin)) return false;
        name.remove_prefix(begin.size());
        const std::size_t digits = (std::min)(name.find_first_not_of("0123456789"), name.size());
        return digits >= 4 && (name.substr(digits) == ".png" || name.substr(digits) == "_copper.png");
    }

    std::string folder_;
    in::image<std::uint8_t> page_;
    int used_ = 0, count_ = 0;
};

}  // namespace survey
