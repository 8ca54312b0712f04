// Hashes of what the library computes, one line each: golden.txt holds them, and every build of this program must print
// the same. Within a build, a scene has one hash for every number of threads, tile size and instruction set; the
// program says which differ and fails.
#include <insonify/all.hpp>
#if !defined(__EMSCRIPTEN__)
#include <insonify/core/thread_pool.hpp>
#endif

#include <bit>
#include <cstdio>
#include <limits>

namespace in = insonify;
using namespace in::literals;

namespace {

#if defined(__EMSCRIPTEN__)  // built without threads
struct thread_pool : in::serial_executor {
    explicit thread_pool(int) {}
};
#else
using in::thread_pool;
#endif

/// FNV-1a, 64 bits, of any number of values.
struct hash {
    std::uint64_t value = 0xcbf29ce484222325u;

    /// Every number by its lowest byte first, whatever the machine's order, without the padding of aligned vectors.
    template <class T>
    void bytes(const T* data, std::size_t count) {
        if constexpr (requires { T::length(); }) {
            for (std::size_t i = 0; i < count; ++i)
                for (int k = 0; k < T::length(); ++k) bytes(&data[i][k], 1);
            return;
        }
        constexpr std::size_t number = alignof(T);
        for (std::size_t i = 0; i < count * sizeof(T); ++i) {
            const std::size_t reversed = i - i % number + (number - 1 - i % number);
            const std::size_t at = std::endian::native == std::endian::big ? reversed : i;
            value ^= reinterpret_cast<const unsigned char*>(data)[at];
            value *= 0x100000001b3u;
        }
    }
    template <class T>
    void add(const in::image<T>& image) {
        bytes(image.pixels().data(), image.size());
    }
    void add(const in::mesh& m) {
        bytes(m.positions.data(), m.positions.size());
        bytes(m.normals.data(), m.normals.size());
        bytes(m.triangles.data(), m.triangles.size());
    }
};

bool all_equal = true;

void print(const char* name, const hash& h) {
    std::printf("%-24s %016llx\n", name, static_cast<unsigned long long>(h.value));
}

in::scene scene_over(in::seabed::any seabed) {
    in::scene scene;
    scene.seabed = std::move(seabed);
    scene.add(in::cylinder{.radius = 0.25f, .length = 2.0f}, {.position = {-2, 0.3, 0.3}, .yaw = 60_deg}, "cylinder");
    scene.add(in::cone{.radius = 0.4f, .height = 0.5f}, {.position = {1, 2, 0}, .pitch = 8_deg}, "cone");
    scene.add(in::sphere{.radius = 0.5f}, {.position = {3, -2, 0.2}, .burial = 0.1f}, "sphere");
    scene.add(in::cube{}, {.position = {-4, -3, 0.5}, .yaw = 0.3f, .roll = 0.1f}, "cube");
    return scene;
}

template <class Shadow, class E>
hash hash_of(const in::scene& scene, const in::overhead& rig, int tile, in::isa level, E& executor) {
    in::render_options<Shadow> options;
    options.tile = tile;
    options.level = level;
    const auto frame = in::render(scene, rig, options, executor);
    hash h;
    h.add(frame.image);
    h.add(frame.labels.instance);
    h.add(frame.labels.shadow);
    h.add(frame.labels.seabed);
    return h;
}

/// One scene for all tile sizes, instruction sets and thread counts.
template <class Shadow>
void render(const char* name, const in::seabed::any& seabed) {
    const in::overhead rig{.position = {3.7, -1.2}, .altitude = 5, .yaw = 0.4f, .size = {200, 150}, .grazing = 7_deg};
    const in::scene scene = scene_over(seabed);
    in::serial_executor serial;
    const hash expected = hash_of<Shadow>(scene, rig, 64, in::isa::scalar, serial);
    print(name, expected);
    const auto compare = [&](int threads, int tile, in::isa level, auto& executor) {
        if (hash_of<Shadow>(scene, rig, tile, level, executor).value == expected.value) return;
        std::fprintf(stderr, "%s differs with %d threads, tiles of %d, instruction set %d\n", name, threads, tile,
                     static_cast<int>(level));
        all_equal = false;
    };
    for (const in::isa level : {in::isa::scalar, in::isa::baseline, in::isa::avx2, in::isa::avx512})
        for (const int tile : {8, 16, 64, 256}) compare(0, tile, level, serial);
    for (const int threads : {1, 2, 3, 8, 16}) {
        thread_pool pool(threads);
        compare(threads, 32, in::best_isa(), pool);
    }
}

void geometry() {
    hash h;
    for (const in::mesh& m : {to_mesh(in::cube{}), to_mesh(in::cylinder{}), to_mesh(in::capsule{}), to_mesh(in::cone{}),
                              to_mesh(in::sphere{}), to_mesh(in::hemisphere{})})
        h.add(in::transformed(m,
                              in::to_world({.position = {1e3, 2, 3}, .yaw = 1, .pitch = 2, .roll = 3, .scale = 0.7f})));
    print("primitives", h);
}

/// The lattice that is found in the triangles of a relief, with GLM's padded vectors, too.
void lattice() {
    in::mesh relief;
    constexpr std::uint32_t columns = 9, rows = 7;
    for (std::uint32_t y = 0; y < rows; ++y)
        for (std::uint32_t x = 0; x < columns; ++x)
            relief.positions.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(x * y % 5));
    for (std::uint32_t y = 0; y + 1 < rows; ++y)
        for (std::uint32_t i = y * columns; i + 1 < (y + 1) * columns; ++i) {
            relief.triangles.emplace_back(i, i + 1, i + columns + 1);
            relief.triangles.emplace_back(i, i + columns + 1, i + columns);
        }
    const in::regular_grid found = in::regular_grid_of(relief).value_or(in::regular_grid{});
    const int size[2] = {found.columns, found.rows};
    hash h;
    h.bytes(size, 2);
    print("lattice of a relief", h);
}

void filters() {
    in::image<float> ramp(257, 131);
    for (int y = 0; y < ramp.height(); ++y)
        for (int x = 0; x < ramp.width(); ++x) ramp(x, y) = static_cast<float>((x * 7 + y * 13) % 257) / 256.0f;
    const auto show = [&](const char* name, const auto& filter) {
        hash h;
        h.add(ramp | filter);
        print(name, h);
    };
    show("gaussian", in::gaussian{.seed = 3});
    show("speckle", in::speckle{.variance = 0.1f, .seed = 3});
    show("gaussian and speckle", in::gaussian_speckle{.seed = 3});
    show("rayleigh", in::rayleigh{.seed = 3});
    show("poisson", in::poisson{.seed = 3});
    show("salt and pepper", in::salt_and_pepper{.seed = 3});
    show("looks", in::gamma_speckle{.looks = 2.2f, .seed = 3});
    show("K", in::k_speckle{.shape = 0.7f, .seed = 3});
    show("rician", in::rician{.seed = 3});
    show("correlated", in::gaussian{.correlation = {2, 1}, .seed = 3} | in::rayleigh{.correlation = {1, 2}, .seed = 3});
    show("correlated K", in::k_speckle{.shape = 1.5f, .correlation = {2, 0.7f}, .seed = 3});
    show("noise on 16 bits", in::to_uint16 | in::gaussian{.seed = 3} | in::match_binned(ramp, 300));
    show("equalize", in::equalize{});
    show("match", in::match_histogram(ramp | in::speckle{.seed = 5}));
    show("copper", in::colormap::copper);
}

/// Random triangles of all sizes, some of them far outside, behind the camera or not finite.
void triangles() {
    in::random_sequence random(9);
    in::mesh m;
    for (std::uint32_t i = 0; i < 600; ++i) {
        const double size = in::numeric::pow(10, random.uniform(-3, random.below(8) == 0 ? 7 : 0));
        const glm::dvec3 middle{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.2, 3)};
        for (int k = 0; k < 3; ++k)
            m.positions.emplace_back(
                middle + size * glm::dvec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        m.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    m.positions[77].y = std::numeric_limits<float>::quiet_NaN();
    const auto vertex_shader = [](const in::vertex& v) {
        return in::vertex_output<glm::vec3>{{v.position.x, v.position.y, 0.05f, v.position.z}, v.position};
    };
    for (const int bits : {8, 16}) {
        in::image<glm::vec3> color(160, 120);
        in::image<float> depth(160, 120);
        in::draw(m, vertex_shader, [](const auto& f) { return f.varyings; }, in::framebuffer<glm::vec3>{color, depth},
                 {.compare = in::depth_compare::greater, .load = in::depth_load::clear, .subpixel_bits = bits});
        hash h;
        h.add(color);
        h.add(depth);
        print(bits == 8 ? "triangles, 8 bits" : "triangles, 16 bits", h);
    }
}

/// Both sides of a track, with every part of the sonar equation.
template <in::across_track Axis>
void record(const char* name, const in::seabed::any& seabed) {
    const in::scene scene = scene_over(seabed);
    const in::side_scan_rig<Axis> rig{
        .position = {-3, -4}, .altitude = 3, .yaw = 0.4f, .ping_spacing = 0.1f, .pings = 90, .range = 14, .bins = 200};
    const in::sonar_equation equation{in::spreading_loss{},   in::absorption{}, in::vertical_beam{},
                                      in::horizontal_beam{},  in::pulse{0.2f},  in::noise_floor{1e-9f},
                                      in::time_varied_gain{}, in::level_gain{}};
    const auto hash_by = [&](auto& executor) {
        const auto swath = in::render_swath(scene, rig, in::record_options<>{}.with(equation), executor);
        hash h;
        h.add(swath.image);
        h.add(swath.labels.instance);
        h.add(swath.labels.shadow);
        h.add(swath.labels.seabed);
        h.add(in::with_speckle(swath.image.view(), swath.labels.seabed.view(), {}, {}, executor) | in::display{});
        return h;
    };
    in::serial_executor serial;
    const hash expected = hash_by(serial);
    print(name, expected);
    for (const int threads : {2, 7}) {
        thread_pool pool(threads);
        if (hash_by(pool).value == expected.value) continue;
        std::fprintf(stderr, "%s differs with %d threads\n", name, threads);
        all_equal = false;
    }
}

}  // namespace

int main() {
    geometry();
    lattice();
    filters();
    triangles();
    render<in::shadow::pcf>("flat, pcf", in::seabed::flat{});
    render<in::shadow::map>("ripples, map", in::seabed::ripples{});
    render<in::shadow::none>("mud, no shadow", in::seabed::mud{});
    render<in::shadow::pcf>("rock, pcf", in::seabed::rock{});
    render<in::shadow::pcf>("blend, pcf", in::seabed::blend{});
    render<in::shadow::exact>("rock, exact", in::seabed::rock{});
    record<in::across_track::slant_range>("blend, slant range", in::seabed::blend{});
    record<in::across_track::ground_range>("rock, ground range", in::seabed::rock{});
    return all_equal ? 0 : 1;
}
