// Types that may be interpolated between vertices: floats, and aggregates of them.
#include <insonify/core/image.hpp>
#include <insonify/raster/draw.hpp>

#include <array>
#include <complex>
#include <optional>
#include <span>
#include <variant>

#include <glm/mat3x3.hpp>

#include "../../catch.hpp"

namespace in = insonify;

namespace {

struct pair {
    float u, v;
};
struct mixed {
    glm::vec3 normal;
    pair texture;
    float weights[3];
    glm::mat3 frame;
};
struct nothing {};
struct counters {
    int a, b;
};
struct half {
    float weight;
    int count;
};
struct hidden {
    pair texture;
    half other;
};
struct tail {
    glm::vec2 texture;
    std::uint32_t ids[2];
};
/// As fixed vectors of linear algebra libraries are.
class own_storage {
  public:
    using value_type = float;
    own_storage() {}
    float* data() { return values_; }
    const float* data() const { return values_; }

  private:
    float values_[3] = {};
};
struct textured {
    glm::vec2 at;
    in::image_view<const float> texture;
};
struct rgba {
    std::uint8_t r, g, b, a;
};
struct optional_member {
    std::optional<float> a;
};
struct nested_optional {
    float a;
    optional_member b;
    float c;
};
struct variant_member {
    float a;
    std::variant<float, int> b;
};
struct union_member {
    union {
        float a;
        int b;
    } either;
    float c;
};
struct own_vector {
    own_vector() = default;
    own_vector(float a, float b) : x(a), y(b) {}
    float x, y;
};

static_assert(in::interpolatable<float> && in::interpolatable<pair> && in::interpolatable<mixed>);
static_assert(in::interpolatable<nothing> && in::interpolatable<in::no_varyings>);
static_assert(in::interpolatable<glm::vec4> && !in::interpolatable<glm::ivec2> && !in::interpolatable<glm::dvec2>);
static_assert(!in::interpolatable<int> && !in::interpolatable<double> && !in::interpolatable<const float*>);
static_assert(!in::interpolatable<counters> && !in::interpolatable<half> && !in::interpolatable<hidden>);
static_assert(in::interpolatable<own_storage>);
static_assert(in::interpolatable<std::array<float, 3>> && in::interpolatable<std::complex<float>>);
static_assert(!in::interpolatable<std::span<float>> && !in::interpolatable<std::span<const float>> &&
              !in::interpolatable<in::image_view<float>>);
static_assert(!in::interpolatable<std::optional<float>> && !in::interpolatable<textured>);
static_assert(!in::interpolatable<optional_member> && !in::interpolatable<nested_optional> &&
              !in::interpolatable<variant_member> && !in::interpolatable<union_member>);
static_assert(!in::interpolatable<tail> && !in::interpolatable<rgba> && !in::interpolatable<own_vector>);

}  // namespace

TEST_CASE("A vertex shader may return a type of its own that has a clip position and varyings") {
    struct placed {
        glm::vec4 clip;
        float varyings;
    };
    const auto place = [](const in::vertex& v) { return placed{{v.position, 1}, v.position.x}; };
    const in::mesh m{{{-1, -1, 0.5f}, {3, -1, 0.5f}, {-1, 3, 0.5f}}, {}, {{0, 1, 2}}};
    in::image<float> color(8, 8), depth(8, 8);
    in::draw(m, place, [](const in::fragment<float>& f) { return f.varyings; }, in::framebuffer<float>{color, depth},
             {.load = in::depth_load::clear});
    for (int x = 0; x < 8; ++x) CHECK(color(x, 3) == Approx((x + 0.5) / 4 - 1));
}

TEST_CASE("A draw that clears depth writes the background color where requested, and otherwise keeps the color") {
    const in::mesh m{.positions = {{-1, -1, 0.5f}, {0, -1, 0.5f}, {-1, 0, 0.5f}}, .triangles = {{0, 1, 2}}};
    const auto place = [](const in::vertex& v) { return glm::vec4(v.position, 1); };
    const auto one = [](const auto&) { return 1; };
    for (const bool has_background : {true, false})
        for (const auto load : {in::depth_load::clear, in::depth_load::keep}) {
            in::image<int> color(100, 90, 7);
            in::image<float> depth(100, 90, in::empty_depth(in::depth_compare::less));
            in::framebuffer<int> target{color, depth};
            if (has_background) target.clears_color = true, target.background = 3;
            in::draw(m, place, one, target, {.load = load});
            CHECK(color(2, 87) == 1);
            CHECK(color(99, 0) == (has_background && load == in::depth_load::clear ? 3 : 7));
        }
}
