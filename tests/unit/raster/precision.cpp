// Depth and varyings against the planes through the snapped corners, computed to 113 bits.
#include <insonify/core/random.hpp>

#include <array>
#include <cstdint>
#include <cstdio>

#include "../../catch.hpp"
#include "../../larger.hpp"
#include "pixel_space.hpp"

namespace in = insonify;
using namespace testing_raster;

namespace {

constexpr int picture_side = 64;  // pixels a side

/// A triangle in clip space with a varying.
struct clip_triangle {
    std::array<glm::vec4, 3> clip;
    std::array<float, 3> varying;
};

/// Errors of depths and varyings against the oracle.
struct errors {
    std::uint64_t samples = 0;
    std::uint64_t wrong_depths = 0;  ///< not the nearest float
    double varying = 0;              ///< largest error, in units in the last place of the largest corner's value

    /// @param copies  of the triangle, the first of which is seen; several small ones take another code path than one
    void measure(const clip_triangle& t, int bits, in::depth_compare compare, std::size_t copies) {
        const in::mesh m{std::vector<glm::vec3>(3), {}, std::vector<glm::uvec3>(copies, {0, 1, 2})};
        const auto place = [&](const in::vertex& v) {
            return in::vertex_output<float>{t.clip[v.index], t.varying[v.index]};
        };
        glm::dvec2 corner[3];
        double z[3];
        wide_float inverse_w[3];
        float largest = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec4 clip(t.clip[i]);
            corner[i] = on_screen(clip, picture_side, picture_side);
            z[i] = clip.z / clip.w;
            inverse_w[i] = 1 / static_cast<wide_float>(clip.w);
            largest = (std::max)(largest, std::abs(t.varying[i]));
        }
        const oracle truth(corner, bits);
        const double last_place = static_cast<double>(std::nextafter(largest, 2 * largest) - largest);
        in::image<float> depth(picture_side, picture_side);
        in::draw(m, place,
                 [&](const in::fragment<float>& f) {
                     ++samples;
                     wrong_depths += f.depth != static_cast<float>(truth.depth(f.x, f.y, z));
                     const wide_float off =
                         static_cast<wide_float>(f.varyings) - truth.varying(f.x, f.y, t.varying, inverse_w);
                     varying = larger(varying, std::abs(static_cast<double>(off)) / last_place);
                 },
                 in::framebuffer<void>{depth},
                 {.compare = compare, .load = in::depth_load::clear, .subpixel_bits = bits});
    }
};

/// Classes of triangles in which other rasterizers get depth wrong.
enum class triangle_class : std::uint32_t { large, small_area, sliver, beyond_picture, needle, short_needle };

struct named_class {
    triangle_class kind;
    const char* name;
    int repeats;  ///< triangles that cover few pixels are drawn more often
};
constexpr named_class classes[] = {
    {triangle_class::large, "large", 1},     {triangle_class::small_area, "of a few pixels", 16},
    {triangle_class::sliver, "slivers", 16}, {triangle_class::beyond_picture, "beyond the picture", 1},
    {triangle_class::needle, "needles", 16}, {triangle_class::short_needle, "short needles", 16}};

/// Random triangles of a class.
struct random_triangle {
    in::random_sequence random;

    glm::dvec2 ndc(double spread) {
        const double x = random.uniform(-spread, spread);
        return {x, random.uniform(-spread, spread)};
    }
    /// A few thousandths of a pixel wide and `longest` pixels long, along a line through the centres of pixels.
    std::array<glm::dvec2, 3> needle_through_centres(double longest) {
        const auto whole = [&](int low, int high) {
            return static_cast<double>(low +
                                       static_cast<int>(random.below(static_cast<std::uint32_t>(high - low + 1))));
        };
        const glm::dvec2 centre(whole(0, picture_side - 1) + 0.5, whole(0, picture_side - 1) + 0.5),
            step(whole(-2, 2), whole(-2, 2));
        const double away = in::numeric::pow(longest, random.uniform(0.2, 1));
        const auto on_line = [&] { return centre + std::floor(random.uniform(-away, away)) * step; };
        const glm::dvec2 beside = centre + glm::dvec2(whole(-3, 3) / 256, whole(-3, 3) / 256);
        const auto to_ndc = [](glm::dvec2 p) {
            return glm::dvec2(p.x / picture_side * 2 - 1, 1 - p.y / picture_side * 2);
        };
        return {to_ndc(on_line()), to_ndc(on_line()), to_ndc(beside)};
    }
    /// @param w_ratio  of the largest to the smallest possible w
    clip_triangle operator()(triangle_class kind, double w_ratio) {
        const glm::dvec2 base = ndc(1), along = ndc(1);
        const std::array<glm::dvec2, 3> needle =
            needle_through_centres(kind == triangle_class::short_needle ? 12 : 1e5);
        clip_triangle t;
        for (std::size_t i = 0; i < 3; ++i) {
            glm::dvec2 p = ndc(1.2);
            switch (kind) {
                case triangle_class::large: break;
                case triangle_class::small_area: p = base + ndc(0.12); break;
                case triangle_class::sliver: p = base + random.uniform(-1.5, 1.5) * along + ndc(0.004); break;
                case triangle_class::beyond_picture: p = base + ndc(40); break;
                case triangle_class::needle:
                case triangle_class::short_needle: p = needle[i]; break;
            }
            const double w = in::numeric::pow(w_ratio, random.uniform(-0.5, 0.5));
            // Reversed depth of something at distance w; or any depth, where w is constant.
            const double z = w_ratio > 1 ? 1e-6 : random.uniform();
            t.clip[i] = glm::vec4(p.x * w, p.y * w, z, w);
            t.varying[i] = static_cast<float>(random.uniform(-1, 1));
        }
        return t;
    }
};

void check_precision(std::uint64_t seed, int count, bool print) {
    for (const double w_ratio : {1.0, 10.0, 1e5, 1e9})  // 1e9: from a millimetre to a thousand kilometres
        for (const auto& [kind, name, repeats] : classes) {
            random_triangle triangle{in::random_sequence(seed, static_cast<std::uint32_t>(kind))};
            errors found;
            for (int i = 0; i < count * repeats; ++i)
                found.measure(triangle(kind, w_ratio), i % 2 == 0 ? 8 : 16,
                              w_ratio > 1 ? in::depth_compare::greater : in::depth_compare::less, i % 3 == 0 ? 1 : 16);
            INFO("seed " << seed << ", triangles " << name << ", w ratio " << w_ratio);
            CHECK(found.samples > 500);
            CHECK(found.wrong_depths == 0);
            CHECK(found.varying <= 0.501);
            if (print)
                std::printf(
                    "w ratio %-7g triangles %-20s %10llu pixels, %llu depths not the nearest, varying %.4f ulp\n",
                    w_ratio, name, static_cast<unsigned long long>(found.samples),
                    static_cast<unsigned long long>(found.wrong_depths), found.varying);
        }
}

}  // namespace

TEST_CASE("Depth is the float nearest to the plane, varyings are within half a unit in the last place") {
    check_precision(1, 120, false);
}

TEST_CASE("Ten million depths are the nearest floats", "[.slow]") {
    check_precision(2, 3000, true);
}

TEST_CASE("Quick depth is off by at most 2^-22 of the largest depth and 2^-7 of the triangle's range of depths") {
    constexpr int side = 256;  // a power of two, as 2^-8 pixels are: vertices are exact
    in::random_sequence random(6);
    in::image<float> exact(side, side), quick(side, side);
    double worst = 0, worst_of_range = 0;  // in units of 2^-24, and beyond 2^-22 of the largest depth
    bool is_bounded = true;
    for (int n = 0; n < 12000; ++n) {
        const double length = random.uniform(16, 62), thickness = length / in::numeric::pow(4096, random.uniform()),
                     turn = random.uniform(0, 2 * in::numeric::pi), range = in::numeric::pow(10, random.uniform(-5, 0));
        const auto corner = [&](double along) {
            const double across = thickness * random.uniform(-1, 1), c = std::cos(turn), s = std::sin(turn);
            const auto snapped = [](double pixels) { return std::round(256 * pixels) / 256; };
            return glm::vec3(snapped(128 + along * c - across * s), snapped(128 + along * s + across * c),
                             1 - range * random.uniform());
        };
        const glm::vec3 a = corner(-length), b = corner(length), c = corner(length * random.uniform(-1, 1));
        const in::mesh m{{a, b, c}, {}, std::vector<glm::uvec3>(n % 2 == 0 ? 1 : 16, {0, 1, 2})};
        const pixel_space place{side, side};
        in::draw(m, place, in::depth_target{exact}, {.load = in::depth_load::clear});
        in::draw(m, place, in::depth_target{quick},
                 in::draw_options<in::depth_precision::quick>{.load = in::depth_load::clear});

        const auto [lowest, highest] = std::minmax({a.z, b.z, c.z});
        const auto [west, east] = std::minmax({a.x, b.x, c.x});
        const auto [north, south] = std::minmax({a.y, b.y, c.y});
        const double depths = static_cast<double>(highest - lowest), largest = static_cast<double>(highest);
        const double box = static_cast<double>(east - west) * static_cast<double>(south - north);
        const double twice = std::abs(static_cast<double>((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)));
        for (std::size_t i = 0; i < exact.size(); ++i) {
            if (exact.pixels()[i] > 1) continue;  // not covered
            const double off =
                std::abs(static_cast<double>(exact.pixels()[i]) - static_cast<double>(quick.pixels()[i]));
            worst = larger(worst, off * 0x1p24);
            worst_of_range = larger(worst_of_range, (off - 0x1p-22 * largest) / depths);
            is_bounded = is_bounded && off <= 0x1p-22 * largest + depths * (std::min)(0x1p-7, 0x1p-19 * box / twice);
        }
    }
    CAPTURE(worst, worst_of_range);
    CHECK(is_bounded);
    CHECK(worst > 100);            // more than a few units in the last place
    CHECK(worst_of_range < 3e-4);  // measured: 2^-12
}

TEST_CASE("The nearer of two surfaces is visible wherever their depths differ as floats") {
    in::random_sequence random(3);
    in::image<float> depth(picture_side, picture_side);
    int wrong = 0, contested = 0;
    for (int n = 0; n < 300; ++n) {
        // Two sheets over the whole picture that cross each other under a tiny angle.
        const double apart = in::numeric::pow(10, random.uniform(-9, -5));
        in::mesh m{{}, {}, {{0, 1, 2}, {3, 4, 5}}};
        const glm::dvec2 outline[3] = {{-80, -10}, {150, -20}, {20, 190}};
        glm::dvec2 corner[2][3];
        double z[2][3];
        for (int sheet = 0; sheet < 2; ++sheet)
            for (int i = 0; i < 3; ++i) {
                const glm::dvec2 p = outline[i] + glm::dvec2{random.uniform(-5, 5), random.uniform(-5, 5)};
                const double height = 0.4 + 1e-3 * p.x - 5e-4 * p.y + (sheet == 1 ? apart * random.uniform(-1, 1) : 0);
                m.positions.push_back(glm::vec3(p, height));
                const glm::vec4 clip = pixel_space{picture_side, picture_side}({m.positions.back(), {}, 0});
                corner[sheet][i] = on_screen(glm::dvec4(clip), picture_side, picture_side);
                z[sheet][i] = static_cast<double>(clip.z);
            }
        const oracle first(corner[0], 8), second(corner[1], 8);
        in::draw(m, pixel_space{picture_side, picture_side},
                 [&](const auto& f) {
                     const auto a = static_cast<float>(first.depth(f.x, f.y, z[0]));
                     const auto b = static_cast<float>(second.depth(f.x, f.y, z[1]));
                     wrong += f.triangle != (b < a ? 1u : 0u);
                     contested += std::abs(a - b) <= 4e-7f;
                 },
                 in::framebuffer<void>{depth}, {.load = in::depth_load::clear});
    }
    CHECK(wrong == 0);
    CHECK(contested > 1000);
}

TEST_CASE("Depths of level ground stay in order down to a grazing angle of 0.006 degrees") {
    // 1 m above level ground that reaches from 1 m to 10 km, where it is seen at 0.006 degrees; reversed depth.
    const auto along = [](const in::vertex& v) {
        return in::vertex_output<glm::vec2>{{v.position.x, v.position.z - 1, 0.01f, v.position.y},
                                            {v.position.x, v.position.y}};
    };
    const in::mesh m{{{-2e4f, 1, 0}, {2e4f, 1, 0}, {-2e4f, 1e4f, 0}, {2e4f, 1e4f, 0}}, {}, {{0, 1, 3}, {0, 3, 2}}};
    in::image<float> depth(3, 8192);
    int seen = 0;
    double worst = 0;
    in::draw(m, along,
             [&](const in::fragment<glm::vec2>& f) {
                 ++seen;
                 // z / w = 0.01 / y, and where a pixel's ray meets the ground: y = 1 / (its slope).
                 const double slope = (f.y + 0.5) / 4096 - 1;
                 worst = larger(worst, std::abs(static_cast<double>(f.depth) / (0.01 * slope) - 1));
                 worst = larger(worst, std::abs(static_cast<double>(f.varyings.y) * slope - 1));
             },
             in::framebuffer<void>{depth},
             {.compare = in::depth_compare::greater, .load = in::depth_load::clear, .subpixel_bits = 16});
    CHECK(seen == 3 * 4096);  // all rows below the horizon
    // The first row lies half a pixel below the horizon; snapping moves an edge by up to 2^-17 pixels.
    CHECK(worst < 1e-4);
    for (int y = 4098; y < 8192; ++y) CHECK(depth(1, y) > depth(1, y - 1));
}
