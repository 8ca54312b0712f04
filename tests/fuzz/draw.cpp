// Fuzzes the rasterizer: its guarantees hold for any input, and coverage equals the 128-bit oracle's.
//
// Half of the drawings are placed in pixels, with w a power of two, so that snapped positions are known exactly and
// coverage is compared with the oracle. The other half have any clip coordinates; only the guarantees are checked.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "../unit/raster/pixel_space.hpp"
#include "fuzz.hpp"

namespace in = insonify;
using fuzzing::byte_reader;

namespace {

struct drawing {
    int width, height;
    in::draw_options<> options;
    float background;  ///< depth before the draw
    bool in_pixels;
    std::vector<glm::vec4> clip;
    in::mesh mesh;

    glm::vec4 operator()(const in::vertex& v) const { return clip[v.index]; }
};

// Reading

/// One axis of a vertex in pixels, at one of several scales.
float read_pixels(byte_reader& bytes, int extent, int subpixel_bits) {
    const int scale = bytes.below(8);
    const auto share = [&] { return static_cast<double>(bytes.take<std::int32_t>()) * 0x1p-31; };
    switch (scale) {
        case 0: return std::ldexp(static_cast<float>(bytes.take<std::int16_t>()), -subpixel_bits);
        case 1: return static_cast<float>(bytes.take<std::int8_t>()) / 2;  // centres and corners of pixels
        case 2: return static_cast<float>(extent * (0.5 + share()));
        case 3: return static_cast<float>(1e4 * share());
        case 4: return static_cast<float>(1e7 * share());
        case 5: return static_cast<float>(3e9 * share());
        case 6: return static_cast<float>((extent + std::ldexp(bytes.take<std::int8_t>(), bytes.below(27))) / 2);
        default: return bytes.take<float>();
    }
}

/// One clip coordinate: a plain number, a limit of the format or of the library, or any bits.
float read_clip(byte_reader& bytes) {
    using limits = std::numeric_limits<float>;
    constexpr float special[] = {0.0f,     -0.0f,           1.0f,   -1.0f,
                                 1e-30f,   1e-38f,          1e38f,  limits::denorm_min(),
                                 0x1p-20f, (limits::max)(), -1e30f, -(limits::max)(),
                                 0x1p40f,  -0x1p40f,        1e10f,  limits::infinity()};
    switch (bytes.below(3)) {
        case 0: return static_cast<float>(bytes.take<std::int8_t>()) / 16;
        case 1: return special[bytes.below(16)];
        default: return bytes.take<float>();
    }
}

glm::vec4 read_vertex(byte_reader& bytes, const drawing& d) {
    if (!d.in_pixels) {
        const float x = read_clip(bytes), y = read_clip(bytes), z = read_clip(bytes);
        return {x, y, z, read_clip(bytes)};
    }
    const float x = read_pixels(bytes, d.width, d.options.subpixel_bits);
    const float y = read_pixels(bytes, d.height, d.options.subpixel_bits);
    const int z = bytes.below(256);
    const float depth = z < 255 ? static_cast<float>(z) / 254 : bytes.take<float>();
    const float w = std::ldexp(1.0f, bytes.below(17) - 8);
    return testing_raster::pixel_space{d.width, d.height}({{x, y, depth}, {}, 0}) * w;
}

drawing read(byte_reader& bytes) {
    drawing d{};
    d.width = 1 + bytes.below(48);
    d.height = 1 + bytes.below(48);
    d.options.subpixel_bits = 4 + bytes.below(13);
    d.options.tile = 8 << bytes.below(6);
    d.options.cull = static_cast<in::cull_mode>(bytes.below(3));
    d.options.compare = static_cast<in::depth_compare>(bytes.below(2));
    d.options.load = static_cast<in::depth_load>(bytes.below(2));
    d.options.level = static_cast<in::isa>(bytes.below(4));
    d.background = bytes.below(2) == 0 ? in::empty_depth(d.options.compare) : 0.5f;
    d.in_pixels = bytes.below(2) == 0;

    const int triangles = bytes.below(8), vertices = bytes.below(12);
    const int indices = vertices + (bytes.below(16) == 15 ? 1 : 0);  // an index without a vertex must be refused
    for (int i = 0; i < triangles && indices > 0; ++i) {
        const int a = bytes.below(indices), b = bytes.below(indices), c = bytes.below(indices);
        d.mesh.triangles.emplace_back(a, b, c);
    }
    for (int i = 0; i < vertices; ++i) d.clip.push_back(read_vertex(bytes, d));
    d.mesh.positions.resize(d.clip.size());
    return d;
}

// Checking

[[noreturn]] void fail(const drawing& d, const char* invariant) {
    const in::draw_options<>& o = d.options;
    std::fprintf(stderr, "%d x %d pixels, %d sub-pixel bits, tile %d, cull %d, compare %d, load %d, level %d\n",
                 d.width, d.height, o.subpixel_bits, o.tile, static_cast<int>(o.cull), static_cast<int>(o.compare),
                 static_cast<int>(o.load), static_cast<int>(o.level));
    for (const glm::uvec3& t : d.mesh.triangles) std::fprintf(stderr, "triangle %u %u %u\n", t.x, t.y, t.z);
    for (const glm::dvec4 p : d.clip) std::fprintf(stderr, "vertex %.9g %.9g %.9g %.9g\n", p.x, p.y, p.z, p.w);
    fuzzing::fail(invariant);
}
void demand(const drawing& d, bool holds, const char* invariant) {
    if (!holds) fail(d, invariant);
}

bool is_finite(const glm::vec4& p) {
    return in::numeric::is_finite(p.x) && in::numeric::is_finite(p.y) && in::numeric::is_finite(p.z) &&
           in::numeric::is_finite(p.w);
}
bool in_depth_range(const glm::vec4& p) {
    return is_finite(p) && p.w >= 1e-30f && p.w <= 1e38f && 0 <= p.z && p.z <= p.w;
}

/// Bounds of the depth of a triangle's pixels: those of its corners, if none of them is clipped.
struct depth_range {
    float lowest = 0, highest = 1;

    depth_range(const drawing& d, const glm::uvec3& t) {
        const glm::vec4 &a = d.clip[t.x], &b = d.clip[t.y], &c = d.clip[t.z];
        if (!(in_depth_range(a) && in_depth_range(b) && in_depth_range(c))) return;
        lowest = (std::min)({a.z / a.w, b.z / b.w, c.z / c.w});
        highest = (std::max)({a.z / a.w, b.z / b.w, c.z / c.w});
        if (d.in_pixels) return;
        // Quotients may have been rounded once more.
        lowest = (std::max)(0.0f, std::nextafter(lowest, -1.0f));
        highest = (std::min)(1.0f, std::nextafter(highest, 2.0f));
    }
    bool holds(float depth) const { return lowest <= depth && depth <= highest; }
};

struct picture {
    in::image<glm::vec3> color;
    in::image<float> depth;
    in::image<int> shaded;
    in::draw_stats stats;
};

/// Runs its calls in reverse order.
struct backward_executor {
    void bulk(std::size_t count, auto&& fn) const {
        while (count > 0) fn(--count);
    }
};

picture drawn(const drawing& d, const in::draw_options<>& options, auto&& executor) {
    picture p{{d.width, d.height}, {d.width, d.height, d.background}, {d.width, d.height}, {}};
    const auto shader = [&](const auto& f) {
        demand(d, 0 <= f.x && f.x < d.width && 0 <= f.y && f.y < d.height, "shaded pixels are in the picture");
        demand(d, ++p.shaded(f.x, f.y) == 1, "a pixel is shaded once");
        const auto& all = d.mesh.triangles;
        demand(d, f.triangle < all.size(), "a pixel shows a triangle of the mesh");
        const auto first = std::find(all.begin(), all.end(), all[f.triangle]) - all.begin();
        demand(d, f.triangle == static_cast<std::size_t>(first), "a tie in depth stays with the first");
        const float sum = f.weights.x + f.weights.y + f.weights.z;
        demand(d, std::abs(sum - 1) < 1e-4f, "weights are finite and their sum is 1");  // NaN is not below
        demand(d, depth_range(d, all[f.triangle]).holds(f.depth), "depth is between those of the corners");
        return f.weights + static_cast<float>(f.triangle) + f.depth + (f.front ? 0.5f : 0.0f);
    };
    p.stats = in::draw(d.mesh, d, shader, in::framebuffer<glm::vec3>{p.color, p.depth}, options, executor);
    return p;
}

void check_depth(const drawing& d, const picture& p) {
    const bool cleared = d.options.load == in::depth_load::clear;
    const float before = cleared ? in::empty_depth(d.options.compare) : d.background;
    for (std::size_t i = 0; i < p.depth.size(); ++i) {
        const float now = p.depth.pixels()[i];
        if (p.shaded.pixels()[i] == 0)
            demand(d, now == before, "a pixel that isn't shaded keeps its depth");
        else
            demand(d, d.options.compare == in::depth_compare::less ? now < before : now > before,
                   "the visible surface is in front");
    }
}

void check_stats(const drawing& d, const in::draw_stats& s) {
    demand(d, s.triangles == d.mesh.triangles.size(), "all triangles are counted");
    demand(d, s.triangles == s.drawn + s.culled + s.missed + s.degenerate + s.not_finite, "each is counted once");
    std::uint64_t broken = 0;
    for (const glm::uvec3& t : d.mesh.triangles)
        broken += is_finite(d.clip[t.x]) && is_finite(d.clip[t.y]) && is_finite(d.clip[t.z]) ? 0u : 1u;
    demand(d, s.not_finite == broken, "triangles that are not finite are counted as such");
}

/// Tile size, instruction set and executor change no bit.
void check_same_bytes(const drawing& d, const picture& p) {
    in::draw_options<> options = d.options;
    options.level = in::isa::scalar;
    options.tile = options.tile == 16 ? 32 : 16;
    const picture other = drawn(d, options, backward_executor{});
    demand(d, fuzzing::same_bytes(p.depth, other.depth), "tiles, instruction set and executor do not change the depth");
    demand(d, fuzzing::same_bytes(p.color, other.color),
           "tiles, instruction set and executor do not change the colors");
    demand(d, p.stats == other.stats, "tiles, instruction set and executor do not change the statistics");

    in::image<float> depth(d.width, d.height, d.background);
    in::draw(d.mesh, d, in::depth_target{depth}, options);
    demand(d, fuzzing::same_bytes(p.depth, depth), "a depth-only draw gives the depth of a shaded draw");
}

/// The position of a vertex in pixels; none where coverage is not guaranteed to be exact.
std::optional<glm::dvec2> exact_position(const drawing& d, const glm::vec4& p) {
    if (!in_depth_range(p)) return std::nullopt;
    const glm::dvec4 q(p);  // w is a power of two and the picture small: nothing is rounded below
    const glm::dvec2 half(d.width / 2.0, d.height / 2.0), pixels{q.x / q.w * half.x, -q.y / q.w * half.y};
    if (!(std::abs(pixels.x) <= 4e9 && std::abs(pixels.y) <= 4e9)) return std::nullopt;
    return pixels + half;
}

void check_coverage(const drawing& d) {
    using testing_raster::hits;
    for (const glm::uvec3& t : d.mesh.triangles) {
        glm::dvec2 corner[3];
        bool exact = true;
        for (int i = 0; i < 3; ++i) {
            const auto position = exact_position(d, d.clip[t[i]]);
            exact = exact && position;
            corner[i] = position.value_or(glm::dvec2(0));
        }
        if (!exact) continue;

        const in::mesh alone{d.mesh.positions, {}, {t}}, turned{d.mesh.positions, {}, {{t.x, t.z, t.y}}};
        in::draw_options<> one_side = d.options, all = d.options;
        one_side.cull = in::cull_mode::back;
        one_side.tile = 8;  // faster; changes no pixel
        all.cull = in::cull_mode::none;
        const auto whole = hits(alone, d.width, d.height, d, all);
        const auto front = hits(alone, d.width, d.height, d, one_side);
        const auto back = hits(turned, d.width, d.height, d, one_side);
        for (int y = 0; y < d.height; ++y)
            for (int x = 0; x < d.width; ++x) {
                const int expected = testing_raster::oracle_covers(corner, x, y, d.options.subpixel_bits) ? 1 : 0;
                if (whole(x, y) != expected || front(x, y) + back(x, y) != expected) {
                    std::fprintf(stderr,
                                 "pixel (%d, %d) of triangle %u %u %u: oracle %d, drawn %d, front %d, back %d\n", x, y,
                                 t.x, t.y, t.z, expected, whole(x, y), front(x, y), back(x, y));
                    fail(d, "coverage is the oracle's");
                }
            }
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    byte_reader bytes(data, size);
    const drawing d = read(bytes);
    bool fits = true;
    for (const glm::uvec3& t : d.mesh.triangles) fits = fits && (std::max)({t.x, t.y, t.z}) < d.clip.size();
    try {
        const picture p = drawn(d, d.options, in::serial_executor{});
        demand(d, fits, "an index without a position is refused");
        check_stats(d, p.stats);
        check_depth(d, p);
        check_same_bytes(d, p);
        if (d.in_pixels) check_coverage(d);
    } catch (const in::invalid_input&) {
        demand(d, !fits, "a mesh that fits is drawn");
    }
    return 0;
}
