// Wavefront OBJ import: triangles, normals and texture coordinates, from text that may be malformed or malicious.
//
// Source: Wavefront Technologies. Advanced Visualizer Manual, appendix B1: Object Files (.obj), 1993.
#pragma once

#include <insonify/core/detail/file.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/geometry/normals.hpp>
#include <insonify/geometry/triangulate.hpp>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A mesh with texture coordinates, for shaders to look up by `vertex::index`.
struct textured_mesh {
    mesh shape;
    std::vector<glm::vec2> texture_coordinates;  ///< one per position; (0, 0) is the lower left corner of the texture
};

namespace detail::inline INSONIFY_FLAGS {

/// Parses the text in one pass. Blanks separate words; a backslash at the end of a line continues it.
class obj_reader {
  public:
    obj_reader(std::string_view text, std::string_view name, const glm::dvec3& origin)
        : text_(text), name_(name), origin_(origin) {
        for (int i = 0; i < 3; ++i) require_range("origin", origin[i], -1e9, 1e9, "within 1e9 metres");
    }

    mesh read() {
        parse();
        return assemble(false).shape;
    }
    textured_mesh read_textured() {
        reads_texture_ = true;
        parse();
        textured_mesh out = assemble(true);
        // Texture seams are not creases: vertices that a seam splits keep one normal.
        const mesh undivided = assemble(false).shape;
        for (std::size_t t = 0; t < undivided.triangles.size(); ++t)
            for (int i = 0; i < 3; ++i)
                out.shape.normals[out.shape.triangles[t][i]] = undivided.normals[undivided.triangles[t][i]];
        return out;
    }

  private:
    void parse() {
        // A corner takes at least two characters and makes at most three entries: 32 bits count them.
        if (text_.size() > (std::size_t{1} << 31)) fail("the text is longer than 2 GiB");
        if (text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = 3;  // byte order mark
        while (at_ < text_.size()) {
            const std::string_view keyword = word();
            if (keyword == "v")
                positions_.push_back(vector(origin_));
            else if (keyword == "vn")
                normals_.push_back(vector(glm::dvec3(0)));
            else if (keyword == "vt" && reads_texture_)
                texture_coordinates_.push_back(texture_coordinate());
            else if (keyword == "f")
                face();
            finish_line();
        }
        if (corners_.empty()) refuse_without_face();
    }

    /// A corner of a face, as indices into the file's positions, normals and texture coordinates.
    struct corner {
        std::uint32_t position, normal, texture;
    };
    static constexpr std::uint32_t none = (std::numeric_limits<std::uint32_t>::max)();

    // Text.

    /// Characters of the line end at `at`: LF, CR or CR LF; 0 if there is none.
    std::size_t line_end(std::size_t at) const {
        if (at >= text_.size()) return 0;
        if (text_[at] == '\r') return at + 1 < text_.size() && text_[at + 1] == '\n' ? 2 : 1;
        return text_[at] == '\n' ? 1 : 0;
    }
    std::size_t continuation(std::size_t at) const {
        const std::size_t end = text_[at] == '\\' ? line_end(at + 1) : 0;
        return end > 0 ? end + 1 : 0;
    }
    static bool blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

    /// Skips one character, or a continuation.
    void advance() {
        const std::size_t continued = continuation(at_);
        line_ += continued > 0 ? 1 : 0;
        at_ += continued > 0 ? continued : 1;
    }

    /// The next word of the line; empty at its end, or where a comment starts.
    std::string_view word() {
        while (at_ < text_.size() && (blank(text_[at_]) || continuation(at_) > 0)) advance();
        const std::size_t first = at_;
        while (at_ < text_.size() && !blank(text_[at_]) && text_[at_] != '#' && line_end(at_) == 0 &&
               continuation(at_) == 0)
            ++at_;
        return text_.substr(first, at_ - first);
    }

    /// Skips statements that are not supported; a comment isn't continued.
    void finish_line() {
        while (at_ < text_.size() && line_end(at_) == 0)
            if (text_[at_] == '#')
                at_ = (std::min)(text_.find_first_of("\r\n", at_), text_.size());
            else
                advance();
        at_ += line_end(at_);
        ++line_;
    }

    [[noreturn]] void fail(const std::string& reason) const {
        raise_io(std::string(name_) + ":" + to_text(line_), reason);
    }
    /// The text is usually a path, or a file of another format.
    [[noreturn]] void refuse_without_face() const {
        if (is_file_name(text_)) raise_io(name_, quoted(text_) + " is a file name: load_obj reads files");
        if (text_.substr(0, 2) == "\xFF\xFE" || text_.substr(0, 2) == "\xFE\xFF")
            raise_io(name_, "the text is UTF-16: save it as UTF-8");
        raise_io(name_, "the text has no face, expected at least one line such as 'f 1 2 3'");
    }
    /// One line that ends in .obj.
    static bool is_file_name(std::string_view text) {
        const std::size_t end = text.find_last_not_of(" \t\r\n");
        text = text.substr(0, end == text.npos ? 0 : end + 1);
        if (text.size() < 5 || text.find_first_of("\r\n#") != text.npos) return false;
        const std::string_view ending = text.substr(text.size() - 4);
        return ending == ".obj" || ending == ".OBJ";
    }

    // Elements.

    float number(const char* if_missing, double origin = 0) {
        const std::string_view digits = word();
        if (digits.empty()) fail(if_missing);
        return parsed(digits, origin);
    }
    /// The number less an origin, rounded once.
    float parsed(std::string_view digits, double origin = 0) const {
        double value = 0;
        if (!parse_number(digits, value)) fail(quoted(digits) + " is not a number");
        constexpr auto limit = static_cast<double>((std::numeric_limits<float>::max)());
        if (!(value >= -limit && value <= limit))
            fail(quoted(digits) + " is not a finite number that a float can hold");
        return static_cast<float>(value - origin);
    }
    glm::vec3 vector(const glm::dvec3& origin) {
        glm::vec3 out;
        for (int i = 0; i < 3; ++i) out[i] = number("a vertex or normal has fewer than 3 numbers", origin[i]);
        return out;
    }
    /// One or two numbers; a third, of solid textures, is ignored.
    glm::vec2 texture_coordinate() {
        const float u = number("a texture coordinate has no number");
        const std::string_view second = word();
        return {u, second.empty() ? 0.0f : parsed(second)};
    }

    /// Converts an index of the file, 1 and up or -1 and down, to one from 0.
    std::uint32_t index(std::string_view digits, std::size_t given, const char* what) {
        std::int64_t value = 0;
        const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        const auto count = static_cast<std::int64_t>(given);
        const bool whole = status == std::errc{} && end == digits.data() + digits.size();
        if (!whole || value == 0 || value > count || value < -count) {
            if (count == 0) fail(std::string(what) + " index " + quoted(digits) + " comes before any " + what);
            fail(std::string(what) + " index " + quoted(digits) + " is none of 1 to " + to_text(count) + " or -1 to -" +
                 to_text(count) + ", the lines given so far");
        }
        return static_cast<std::uint32_t>(value > 0 ? value - 1 : count + value);
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    corner parse_corner(std::string_view text) {
        const std::size_t slash = text.find('/');
        const std::size_t second = slash == text.npos ? text.npos : text.find('/', slash + 1);
        corner out{index(text.substr(0, slash), positions_.size(), "position"), none, none};
        if (reads_texture_ && slash != text.npos && slash + 1 < (std::min)(second, text.size()))
            out.texture = index(text.substr(slash + 1, second - slash - 1), texture_coordinates_.size(), "texture");
        if (second != text.npos && second + 1 < text.size())
            out.normal = index(text.substr(second + 1), normals_.size(), "normal");
        return out;
    }

    void face() {
        polygon_.clear();
        outline_.clear();
        cuts_.clear();
        for (std::string_view text = word(); !text.empty(); text = word()) {
            polygon_.push_back(parse_corner(text));
            outline_.push_back(positions_[polygon_.back().position]);
        }
        if (polygon_.size() < 3) fail("a face has " + to_text(polygon_.size()) + " corners, expected at least 3");
        if (!append_triangles(outline_, cuts_))
            fail("a concave face has " + to_text(polygon_.size()) + " corners, expected at most " +
                 to_text(ear_clipping_limit) + ": cut it");
        for (const glm::uvec3& cut : cuts_)
            for (int i = 0; i < 3; ++i) corners_.push_back(polygon_[cut[i]]);
    }

    /// Each distinct corner becomes a vertex, in the order of the file's positions.
    /// @param has_texture  whether corners that differ in their texture coordinate alone are distinct
    textured_mesh assemble(bool has_texture) const {
        // Sort corners into one bucket per position, then each bucket by normal and texture.
        std::vector<std::uint32_t> bucket(positions_.size() + 1, 0);
        for (const corner& c : corners_) ++bucket[c.position];
        std::uint32_t end = 0;
        for (std::uint32_t& b : bucket) b = end += b;
        std::vector<std::uint32_t> order(corners_.size());
        for (std::size_t i = corners_.size(); i-- > 0;)
            order[--bucket[corners_[i].position]] = static_cast<std::uint32_t>(i);

        textured_mesh all;
        mesh& out = all.shape;
        bool complete = true;
        std::vector<std::uint32_t> vertex(corners_.size());
        for (std::size_t p = 0; p < positions_.size(); ++p) {
            const auto first = order.begin() + bucket[p], last = order.begin() + bucket[p + 1];
            const auto key = [&](std::uint32_t i) {
                return std::pair(corners_[i].normal, has_texture ? corners_[i].texture : none);
            };
            std::sort(first, last, [&](auto a, auto b) { return key(a) < key(b); });
            for (auto at = first; at != last; ++at) {
                const auto [normal, texture] = key(*at);
                if (at == first || key(*at) != key(*(at - 1))) {
                    const glm::dvec3 n = normal == none ? glm::dvec3(0) : glm::dvec3(normals_[normal]);
                    const double length = numeric::length(n);
                    complete = complete && length > 0;
                    out.positions.push_back(positions_[p]);
                    out.normals.push_back(length > 0 ? glm::vec3(n / length) : glm::vec3(0));
                    if (has_texture)
                        all.texture_coordinates.push_back(texture == none ? glm::vec2(0)
                                                                          : texture_coordinates_[texture]);
                }
                vertex[*at] = static_cast<std::uint32_t>(out.positions.size() - 1);
            }
        }
        out.triangles.reserve(vertex.size() / 3);
        for (std::size_t i = 0; i < vertex.size(); i += 3)
            out.triangles.emplace_back(vertex[i], vertex[i + 1], vertex[i + 2]);

        // Compute missing normals.
        if (!complete) {
            const std::vector<glm::vec3> smooth = smooth_normals(out);
            for (std::size_t i = 0; i < smooth.size(); ++i)
                if (out.normals[i] == glm::vec3(0)) out.normals[i] = smooth[i];
        }
        return all;
    }

    std::string_view text_;
    std::string_view name_;
    glm::dvec3 origin_;
    bool reads_texture_ = false;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
    std::vector<glm::vec3> positions_, normals_;
    std::vector<glm::vec2> texture_coordinates_;
    std::vector<corner> corners_;  // three per triangle
    std::vector<corner> polygon_;  // the face being read
    std::vector<glm::vec3> outline_;
    std::vector<glm::uvec3> cuts_;
};

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// The polygons of a Wavefront OBJ text as one mesh, in time nearly linear in its length.
///
/// Reads `v` (numbers after the third, weights or colours, are ignored), `vn` and `f`; all other lines are skipped.
/// Polygons become triangles by `triangulate`, in the order of the faces. A position is kept once for each normal it is
/// used with, and not at all if no face uses it. Corners without a normal get `smooth_normals`. The frame is the file's
/// own, commonly y up: turn such a model upright by `pose{.roll = 90_deg}`.
///
/// @param name    what error messages call the text
/// @param origin  metres, within 1e9 each: subtracted from every position before it is rounded to float. For meshes in
///                map coordinates: steps of a float are half a metre at 5000 km
/// @throws invalid_input if `origin` is out of range
/// @throws io_error with the name and line number for: a coordinate that is missing, no number, or out of range; an
///         index that is 0, no integer, or refers to a line not yet given; a face with fewer than 3 corners, or a
///         concave one with more than 4096; and with the name alone for a text without a face, such as the path of a
///         file, which `load_obj` takes, or one of more than 2 GiB
inline mesh read_obj(std::string_view text, std::string_view name = "OBJ text",
                     const glm::dvec3& origin = glm::dvec3(0)) {
    return detail::obj_reader(text, name, origin).read();
}

/// `read_obj` with texture coordinates (`vt`). A position is kept once for each pair of a normal and a texture
/// coordinate that it is used with, so that it has more vertices along the seams of the texture. Corners without a
/// texture coordinate get (0, 0).
/// @throws invalid_input or io_error as `read_obj` does, and for the same faults of texture coordinates and their
///         indices
inline textured_mesh read_textured_obj(std::string_view text, std::string_view name = "OBJ text",
                                       const glm::dvec3& origin = glm::dvec3(0)) {
    return detail::obj_reader(text, name, origin).read_textured();
}

/// `read_obj` of a file.
/// @throws io_error if the file can't be read, with the system's reason, and as `read_obj` does
inline mesh load_obj(const std::string& path, const glm::dvec3& origin = glm::dvec3(0)) {
    return read_obj(detail::file_bytes(path), path, origin);
}
/// `read_textured_obj` of a file.
/// @throws io_error if the file can't be read, with the system's reason, and as `read_textured_obj` does
inline textured_mesh load_textured_obj(const std::string& path, const glm::dvec3& origin = glm::dvec3(0)) {
    return read_textured_obj(detail::file_bytes(path), path, origin);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
