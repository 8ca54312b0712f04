// Parses the header and the samples of a netpbm file.
#pragma once

#include <insonify/core/detail/file.hpp>
#include <insonify/core/detail/portable.hpp>

#include <charconv>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Reads a header, then samples, from untrusted bytes.
class netpbm_reader {
  public:
    netpbm_reader(std::string_view bytes, std::string_view name) : rest_(bytes), name_(name) {
        if (rest_.size() < 3 || rest_[0] != 'P') fail("not a netpbm file");
        kind_ = rest_[1];
        if (std::string_view("2356Ff").find(kind_) == std::string_view::npos)
            fail("netpbm format P" + std::string(1, kind_) + " is not one of P2 P3 P5 P6 PF Pf");
        if (!is_space(rest_[2]) && rest_[2] != '#') fail("not a netpbm file");
        rest_.remove_prefix(2);
        width_ = integer("width", 1, 1 << 30);
        height_ = integer("height", 1, 1 << 30);
        if (is_float()) {
            const std::string_view text = token("scale");
            double scale = 0;
            if (!parse_number(text, scale) || !(scale < 0 || scale > 0))
                fail("scale is " + quoted(text) + ", expected a number other than 0");
            little_endian_ = scale < 0;
        } else {
            maxval_ = integer("maxval", 1, 65535);
        }
        if (!is_plain()) {
            if (rest_.empty() || !is_space(rest_.front())) fail("no white space after the header");
            rest_.remove_prefix(1);
        }
        check_size();
    }

    int width() const { return width_; }
    int height() const { return height_; }
    int maxval() const { return maxval_; }
    int channels() const { return kind_ == '3' || kind_ == '6' || kind_ == 'F' ? 3 : 1; }
    bool is_float() const { return kind_ == 'F' || kind_ == 'f'; }

    int next_code() {
        if (is_plain()) return integer("sample", 0, maxval_);
        int code = byte(0);
        if (maxval_ > 255) code = code * 256 + byte(1);
        rest_.remove_prefix(sample_size());
        if (code > maxval_) fail("sample is " + to_text(code) + ", expected 0 to " + to_text(maxval_));
        return code;
    }
    float next_float() {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < 4; ++i)
            bits = bits << 8 | static_cast<std::uint32_t>(byte(little_endian_ ? 3 - i : i));
        rest_.remove_prefix(4);
        return numeric::bit_cast<float>(bits);
    }

    [[noreturn]] void fail(const std::string& reason) const { raise_io(name_, reason); }

  private:
    static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    bool is_plain() const { return kind_ == '2' || kind_ == '3'; }
    std::size_t sample_size() const { return is_float() ? 4 : maxval_ > 255 ? 2 : 1; }
    int byte(std::size_t i) const { return static_cast<unsigned char>(rest_[i]); }

    /// The next word; comments run from # to the end of the line.
    std::string_view token(const char* what) {
        bool comment = false;
        std::size_t first = 0;
        for (; first < rest_.size(); ++first) {
            const char c = rest_[first];
            if (comment)
                comment = c != '\n' && c != '\r';
            else if (c == '#')
                comment = true;
            else if (!is_space(c))
                break;
        }
        std::size_t last = first;
        while (last < rest_.size() && !is_space(rest_[last]) && rest_[last] != '#') ++last;
        if (first == last) fail("the file ends before the " + std::string(what));
        const std::string_view word = rest_.substr(first, last - first);
        rest_.remove_prefix(last);
        return word;
    }
    int integer(const char* what, int lowest, int largest) {
        const std::string_view text = token(what);
        int value = 0;
        const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (status != std::errc() || end != text.data() + text.size() || value < lowest || value > largest) {
            fail(std::string(what) + " is " + quoted(text) + ", expected " + to_text(lowest) + " to " +
                 to_text(largest));
        }
        return value;
    }
    /// Refuses headers whose image would not fit the file, before allocating it.
    void check_size() const {
        const std::uint64_t samples = static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_) *
                                      static_cast<std::uint64_t>(channels());
        // A plain sample takes at least a space and a digit.
        const bool fits = is_plain() ? samples <= rest_.size() / 2 : samples <= rest_.size() / sample_size();
        if (!fits)
            fail("a raster of " + to_text(width_) + " x " + to_text(height_) + " pixels is longer than the file");
    }

    std::string_view rest_;
    std::string_view name_;
    char kind_ = 0;
    int width_ = 0;
    int height_ = 0;
    int maxval_ = 0;
    bool little_endian_ = false;
};

template <class Sample>
Sample next_sample(netpbm_reader& reader) {
    if constexpr (std::same_as<Sample, float>) {
        if (reader.is_float()) return reader.next_float();
        return static_cast<float>(reader.next_code()) / static_cast<float>(reader.maxval());
    } else {
        return static_cast<Sample>(reader.next_code());
    }
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
