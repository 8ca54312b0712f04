// Shaders over SIMD lanes, written as a user would.
#include <insonify/core/random.hpp>
#include <insonify/core/thread_pool.hpp>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "../../catch.hpp"
#include "../../larger.hpp"
#include "pixel_space.hpp"

namespace in = insonify;

namespace {

struct varyings {
    glm::vec3 position;
    float height;
};

/// A pinhole at (0, 0, 3) that looks down, with reversed depth.
const auto seen_from_above = [](const in::vertex& v) {
    const glm::vec3& p = v.position;
    return in::vertex_output<varyings>{{p.x, p.y, 0.01f, 3 - p.z}, {p, p.z}};
};

in::mesh rubble() {
    in::mesh m;
    in::random_sequence random(12);
    for (std::uint32_t i = 0; i < 400; ++i) {
        const glm::dvec3 at{random.uniform(-4, 4), random.uniform(-4, 4),
                            random.uniform(-2, 4)};  // some behind the eye
        for (int k = 0; k < 3; ++k)
            m.positions.emplace_back(at +
                                     glm::dvec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        m.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return m;
}

struct pictures {
    in::image<float> value{150, 110}, depth{150, 110}, seen_depth{150, 110};
    in::image<std::uint32_t> triangle{150, 110};
    in::image<std::int32_t> front{150, 110}, visible{150, 110};
};

/// A user's shader over lanes: stores a function of the varyings, and its other inputs.
struct lane_shader {
    pictures& into;

    void clear(const in::rect& tile) const {
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) into.value(x, y) += -100;
    }
    template <int N>
    void operator()(const in::fragment_lanes<N, varyings>& f) const {
        typename in::fragment_lanes<N, varyings>::floats x, height, depth;
        f.interpolate(x, 0);
        f.interpolate(height, 3);
        f.depth(depth);
        x = x * x + height;
        f.store(into.value, x);
        f.store(into.seen_depth, depth);
        f.store(into.front, f.front);
        f.store(into.visible, f.visible);
        std::uint32_t triangles[static_cast<unsigned>(N)];
        for (int k = 0; k < N; ++k) triangles[k] = f.triangles[k];
        in::pixel_lanes<std::uint32_t, N> ids;
        std::memcpy(&ids, triangles, sizeof ids);
        f.store(into.triangle, ids);
    }
};

template <in::depth_precision Depth>
pictures drawn(const in::mesh& m, in::isa level, int tile, auto&& ex) {
    pictures out;
    const in::draw_options<Depth> options{
        .compare = in::depth_compare::greater, .load = in::depth_load::clear, .tile = tile, .level = level};
    const auto stats = in::draw(m, seen_from_above, lane_shader{out}, in::framebuffer<void>{out.depth}, options, ex);
    CHECK(stats.pixels > 8000);
    CHECK(stats.clipped > 10);
    return out;
}

}  // namespace

TEST_CASE(
    "A shader over lanes gets the pixels, triangles, facing and depth of a fragment shader, and varyings to float "
    "precision") {
    const in::mesh m = rubble();
    pictures one;
    in::image<int> covered(150, 110);
    in::draw(m, seen_from_above,
             [&](const in::fragment<varyings>& f) {
                 const glm::vec3& p = f.varyings.position;
                 one.value(f.x, f.y) = p.x * p.x + f.varyings.height;
                 one.triangle(f.x, f.y) = f.triangle;
                 one.front(f.x, f.y) = f.front ? -1 : 0;
                 covered(f.x, f.y) = 1;
             },
             in::framebuffer<void>{one.depth}, {.compare = in::depth_compare::greater, .load = in::depth_load::clear});
    const pictures lanes = drawn<in::depth_precision::exact>(m, in::best_isa(), 32, in::serial_executor{});
    CHECK(lanes.depth == one.depth);
    CHECK(lanes.triangle == one.triangle);
    CHECK(lanes.front == one.front);
    double worst = 0;
    int shaded = 0;
    for (std::size_t i = 0; i < covered.size(); ++i) {
        if (covered.pixels()[i] == 0) {
            CHECK(lanes.value.pixels()[i] == -100);  // cleared once, not shaded
            continue;
        }
        ++shaded;
        CHECK(lanes.visible.pixels()[i] == -1);
        CHECK(lanes.seen_depth.pixels()[i] == lanes.depth.pixels()[i]);
        worst = larger(worst, std::abs(static_cast<double>(lanes.value.pixels()[i] - one.value.pixels()[i])));
    }
    CHECK(shaded > 8000);
    CHECK(worst < 1e-3);
}

namespace {
/// The largest difference between the varyings of a shader over lanes and those of a fragment shader, for one triangle
/// in pixel coordinates, whose corners' clip coordinates are multiplied by `scale`. Infinite where the former are NaN.
template <in::depth_precision Depth>
double worst_of_lanes(const glm::vec3 (&corners)[3], float scale, unsigned fewest_pixels = 100) {
    // As often as there are lanes, so that small triangles are assembled together.
    const in::mesh m{{std::begin(corners), std::end(corners)}, {}, std::vector<glm::uvec3>(16, {0, 1, 2})};
    const auto scaled = [&](const in::vertex& v) {
        return in::vertex_output<varyings>{
            testing_raster::pixel_space{256, 256}(v)*scale,
            {{v.index == 0 ? 1.0f : 0.0f, v.index == 1 ? 1.0f : 0.0f, v.index == 2 ? 1.0f : 0.0f}, 0}};
    };
    const in::draw_options<Depth> options{.load = in::depth_load::clear};
    in::image<float> depth(256, 256);
    in::image<glm::vec3> weights(256, 256);
    in::draw(
        m, scaled, [&](const auto& f) { weights(f.x, f.y) = f.varyings.position; }, in::framebuffer<void>{depth},
        options);
    double worst = 0;
    const auto compare = [&]<int N>(const in::fragment_lanes<N, varyings>& f) {
        for (int i = 0; i < 3; ++i) {
            typename in::fragment_lanes<N, varyings>::floats value;
            f.interpolate(value, i);
            for (int k = 0; k < N; ++k) {
                if (in::detail::lane(f.visible, k) == 0) continue;
                const double off = std::abs(static_cast<double>(in::detail::lane(value, k)) -
                                            static_cast<double>(weights(f.x + k, f.y)[i]));
                worst = larger(worst, off);
            }
        }
    };
    CHECK(in::draw(m, scaled, compare, in::framebuffer<void>{depth}, options).pixels >= fewest_pixels);
    return worst;
}
}  // namespace

TEST_CASE("Varyings over lanes do not depend on the scale of clip coordinates") {
    const glm::vec3 triangle[] = {{-90000, 300, 0}, {90000, 90000, 0.5}, {80000, -90000, 1}};
    for (const int exponent : {-99, -84, -61, -60, 0, 60, 61, 100}) {
        CHECK(worst_of_lanes<in::depth_precision::exact>(triangle, std::ldexp(1.0f, exponent)) < 1e-6);
        CHECK(worst_of_lanes<in::depth_precision::quick>(triangle, std::ldexp(1.0f, exponent)) < 1e-6);
    }
}

TEST_CASE("Varyings over lanes stay precise on slivers of any length") {
    for (const double length : {300.0, 3000.0, 30000.0, 900000.0})
        for (const double width : {300.0, 1.0}) {
            const glm::vec3 sliver[] = {{128 - 0.7 * length, 130 - 0.6 * length, 0},
                                        {128 + 0.7 * length + width, 130 + 0.6 * length, 0},
                                        {128 + 0.7 * length, 130 + 0.6 * length + width, 1}};
            CAPTURE(length, width);
            CHECK(worst_of_lanes<in::depth_precision::exact>(sliver, 1) < 5e-4);
            CHECK(worst_of_lanes<in::depth_precision::quick>(sliver, 1) < 5e-4);
        }
    const auto at = [](int x, int y) {  // sub-pixels from the centre of pixel (128, 128)
        return glm::vec3(128.5f + static_cast<float>(x) / 256, 128.5f + static_cast<float>(y) / 256, 0.5f);
    };
    // Needles 4 to 96 pixels long, with the least area that has a pixel's centre inside: four squared sub-pixels, twice
    // the area, of which the corners get one, two and one. Neighbouring Fibonacci numbers make the determinants.
    for (int a = 610, b = 377; a < 20000; std::tie(a, b) = std::pair(a + b, a)) {
        const int c = a - b, d = b - c, e = c - d;
        const glm::vec3 needle[] = {at(a, b), at(-c, -d), at(-d, -e)};
        CAPTURE(a);
        CHECK(worst_of_lanes<in::depth_precision::exact>(needle, 1, 1) < 1e-6);
        CHECK(worst_of_lanes<in::depth_precision::quick>(needle, 1, 1) < 1e-6);
    }
    // A steeper one.
    const glm::vec3 needle[] = {at(14971, -11267), at(-2801, 2108), at(-9369, 7051)};
    CHECK(worst_of_lanes<in::depth_precision::exact>(needle, 1, 1) < 1e-6);
}

TEST_CASE("A shader over lanes gives the same bytes for any instruction set, tile size and thread count") {
    const in::mesh m = rubble();
    const auto same = [](const pictures& a, const pictures& b) {
        return a.value == b.value && a.depth == b.depth && a.triangle == b.triangle && a.front == b.front;
    };
    in::thread_pool pool(3);
    const pictures exact = drawn<in::depth_precision::exact>(m, in::isa::scalar, 64, in::serial_executor{});
    CHECK(same(exact, drawn<in::depth_precision::exact>(m, in::best_isa(), 16, pool)));
    const pictures quick = drawn<in::depth_precision::quick>(m, in::isa::scalar, 64, in::serial_executor{});
    CHECK(same(quick, drawn<in::depth_precision::quick>(m, in::best_isa(), 16, pool)));
    CHECK(!(quick.depth == exact.depth));
}

namespace {
// As at the top of fragment_lanes.hpp.
struct surface {
    float height, brightness;
};
struct shade_surface {
    in::image<float>& picture;
    template <int N>
    INSONIFY_INLINE void operator()(const in::fragment_lanes<N, surface>& f) const {
        typename in::fragment_lanes<N, surface>::floats height, brightness;
        f.interpolate(height, 0);
        f.interpolate(brightness, 1);
        f.store(picture, height < 1.0f ? brightness : 0.5f * brightness);
        float heights[static_cast<unsigned>(N)];
        std::memcpy(heights, &height, sizeof height);
        for (int k = 0; k < N; ++k)
            if (heights[k] >= 3) ++picture(149, 109);  // never
    }
};
}  // namespace

TEST_CASE("The shader at the top of fragment_lanes.hpp shades like one for single pixels") {
    const auto place = [](const in::vertex& v) {
        const glm::vec3& p = v.position;
        return in::vertex_output<surface>{seen_from_above(v).clip, {p.z, 0.5f + 0.1f * p.x}};
    };
    const in::draw_options<> options{.compare = in::depth_compare::greater, .load = in::depth_load::clear};
    in::image<float> depth(150, 110), picture(150, 110), expected(150, 110);
    in::draw(rubble(), place, shade_surface{picture}, in::framebuffer<void>{depth}, options);
    in::draw(
        rubble(), place,
        [&](const in::fragment<surface>& f) {
            const auto& [height, brightness] = f.varyings;
            expected(f.x, f.y) = height < 1.0f ? brightness : 0.5f * brightness;
        },
        in::framebuffer<void>{depth}, options);
    int different = 0, shaded = 0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        shaded += expected.pixels()[i] > 0;
        different += std::abs(picture.pixels()[i] - expected.pixels()[i]) > 1e-4f;
    }
    CHECK(shaded > 8000);
    CHECK(different < 3);  // at heights of 1, to float precision
}

TEST_CASE("Varyings over lanes may be empty") {
    struct none {};
    const auto place = [](const in::vertex& v) { return in::vertex_output<none>{seen_from_above(v).clip, {}}; };
    in::image<float> depth(150, 110), seen(150, 110, in::empty_depth(in::depth_compare::greater));
    const auto store_depth = [&]<int N>(const in::fragment_lanes<N, none>& f) {
        typename in::fragment_lanes<N, none>::floats value;
        f.depth(value);
        f.store(seen, value);
    };
    in::draw(rubble(), place, store_depth, in::framebuffer<void>{depth},
             {.compare = in::depth_compare::greater, .load = in::depth_load::clear});
    CHECK(seen == depth);
}

namespace {
/// A user's vertex shader with a form over lanes.
struct both_ways {
    int& lanes;
    auto operator()(const in::vertex& v) const { return seen_from_above(v); }
    template <class Floats>
    void operator()(Floats (&clip)[4], Floats* out, const Floats (&position)[3], const Floats (&)[3]) const {
        ++lanes;
        clip[0] = position[0], clip[1] = position[1], clip[2] = Floats{} + 0.01f, clip[3] = 3 - position[2];
        out[0] = position[0], out[1] = position[1], out[2] = position[2], out[3] = position[2];
    }
};
}  // namespace

TEST_CASE("A vertex shader over lanes is used where there are lanes, for depth alone too") {
    const in::mesh m = rubble();
    int lanes = 0;
    in::image<float> depth(150, 110), expected(150, 110);
    const in::draw_options<> options{.compare = in::depth_compare::greater, .load = in::depth_load::clear};
    in::draw(m, both_ways{lanes}, in::depth_target{depth}, options);
    in::draw(m, seen_from_above, in::depth_target{expected}, options);
    CHECK(depth == expected);
    if (in::best_isa() >= in::isa::avx2) CHECK(lanes == 300);
}

namespace {
/// Passes normals on, one vertex at a time or over lanes.
struct one_normal {
    auto operator()(const in::vertex& v) const {
        return in::vertex_output<glm::vec4>{seen_from_above(v).clip, {v.normal, 0}};
    }
};
struct normals_over_lanes : one_normal {
    using one_normal::operator();
    template <class Floats>
    void operator()(Floats (&clip)[4], Floats* out, const Floats (&position)[3], const Floats (&normal)[3]) const {
        clip[0] = position[0], clip[1] = position[1], clip[2] = Floats{} + 0.01f, clip[3] = 3 - position[2];
        out[0] = normal[0], out[1] = normal[1], out[2] = normal[2], out[3] = Floats{};
    }
};
}  // namespace

TEST_CASE("A vertex shader over lanes gets the normals of its vertices") {
    in::mesh m = rubble();
    in::random_sequence random(3);
    for (std::size_t i = 0; i < m.positions.size(); ++i)
        m.normals.push_back(glm::vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    const auto drawn = [&](const auto& place) {
        in::image<float> depth(150, 110), value(150, 110);
        const auto keep_sum = [&]<int N>(const in::fragment_lanes<N, glm::vec4>& f) {
            typename in::fragment_lanes<N, glm::vec4>::floats x, y, z;
            f.interpolate(x, 0);
            f.interpolate(y, 1);
            f.interpolate(z, 2);
            f.store(value, x + 2 * y + 3 * z);
        };
        in::draw(m, place, keep_sum, in::framebuffer<void>{depth},
                 {.compare = in::depth_compare::greater, .load = in::depth_load::clear});
        return value;
    };
    CHECK(drawn(normals_over_lanes{}) == drawn(one_normal{}));
}

namespace {
/// Displaces vertices along their normals, one vertex at a time or over lanes.
struct displaced {
    auto operator()(const in::vertex& v) const { return seen_from_above({v.position + v.normal, v.normal, v.index}); }
};
struct displaced_over_lanes : displaced {
    using displaced::operator();
    template <class Floats>
    void operator()(Floats (&clip)[4], Floats* out, const Floats (&position)[3], const Floats (&normal)[3]) const {
        for (int i = 0; i < 3; ++i) out[i] = position[i] + normal[i];
        clip[0] = out[0], clip[1] = out[1], clip[2] = Floats{} + 0.01f, clip[3] = 3 - out[2];
        out[3] = out[2];
    }
};
/// Stores a value in images of other types.
struct stores_other_types {
    in::image<std::uint8_t>& bytes;
    in::image<double>& doubles;
    template <int N>
    void operator()(const in::fragment_lanes<N, varyings>& f) const {
        typename in::fragment_lanes<N, varyings>::floats value{};
        value = value + 7.25f;
        f.store(bytes, value);
        f.store(doubles, value);
    }
};
}  // namespace

TEST_CASE("A vertex shader over lanes gets normals for depth alone and for single pixels, too") {
    in::mesh m = rubble();
    in::random_sequence random(3);
    for (std::size_t i = 0; i < m.positions.size(); ++i)
        m.normals.push_back(0.2f * glm::vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    const in::draw_options<> options{.compare = in::depth_compare::greater, .load = in::depth_load::clear};
    const auto depth_by = [&](const auto& shader) {
        in::image<float> depth(150, 110);
        in::draw(m, shader, in::depth_target{depth}, options);
        return depth;
    };
    CHECK(depth_by(displaced_over_lanes{}) == depth_by(displaced{}));
    const auto pixels_by = [&](const auto& shader) {
        in::image<float> depth(150, 110), value(150, 110);
        const auto height = [](const in::fragment<varyings>& f) { return f.varyings.height; };
        in::draw(m, shader, height, in::framebuffer<float>{value, depth, true, 0}, options);
        return value;
    };
    CHECK(pixels_by(displaced_over_lanes{}) == pixels_by(displaced{}));
}

TEST_CASE("Values over lanes are converted to the type of the image that they are stored in") {
    in::image<std::uint8_t> bytes(150, 110);
    in::image<double> doubles(150, 110);
    in::image<float> depth(150, 110);
    in::draw(rubble(), seen_from_above, stores_other_types{bytes, doubles}, in::framebuffer<void>{depth},
             {.compare = in::depth_compare::greater, .load = in::depth_load::clear});
    CHECK(std::count(bytes.pixels().begin(), bytes.pixels().end(), 7) > 8000);
    for (std::size_t i = 0; i < bytes.size(); ++i) CHECK(doubles.pixels()[i] == (bytes.pixels()[i] == 7 ? 7.25 : 0));
}

TEST_CASE("A picture of more than 2^16 tiles a side is refused") {
    in::image<float> depth((8 << 16) + 1, 1);
    CHECK_THROWS_AS(in::draw(rubble(), seen_from_above, in::depth_target{depth}, {.tile = 8}), in::invalid_input);
    CHECK_NOTHROW(in::draw(rubble(), seen_from_above, in::depth_target{depth}, {.tile = 16}));
}
