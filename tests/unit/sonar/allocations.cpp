// Out of memory at any point of a picture or a recording: std::bad_alloc, without leaks.
#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>

#include <utility>

#include "../../failing_new.hpp"

namespace in = insonify;

namespace {

in::scene mixed_scene() {
    in::scene s;
    s.seabed = in::seabed::mixed{.layers = {{in::seabed::ripples{}, in::seabed::disc{{0, 0}, 2}}}};
    s.add(in::cylinder{.radius = 0.3f, .length = 1, .segments = 8}, {.position = {0, 0, 0.3}}, "cylinder");
    s.add(in::cube{}, {.position = {1, 1, 0.5}}, "cube");
    return s;
}
constexpr in::overhead small_rig{.altitude = 4, .size = {12, 10}, .grazing = 0.4f};
const in::side_scan sonar{.altitude = 4, .ping_spacing = 0.5f, .pings = 3, .range = 8, .bins = 12};

}  // namespace

TEST_CASE("render() survives any failed allocation, with each shadow policy") {
    const in::scene s = mixed_scene();
    const auto drawn = [&](const auto& policy) {
        return failing_new::fail_each_allocation([&] {
            const auto frame = in::render(s, small_rig, in::render_options<>{.cell = 2.3}.with(policy));
            return std::pair(frame.image, frame.labels.shadow);
        });
    };
    CHECK(drawn(in::shadow::exact{}) > 50);
    CHECK(drawn(in::shadow::none{}) > 20);
    CHECK(drawn(in::shadow::map{}) > 50);
    CHECK(drawn(in::shadow::pcf{}) > 50);
    CHECK(drawn(in::shadow::penumbra{.samples = 2}) > 50);
    CHECK(failing_new::fail_each_allocation([&] { return in::visible_triangles(s, small_rig).triangle; }) > 20);
}

TEST_CASE("record() survives any failed allocation, with looks and speckle") {
    const in::scene s = mixed_scene();
    const auto options = in::record_options<>{}.with(
        in::sonar_equation{in::horizontal_beam{0.2f}, in::pulse{}, in::noise_floor{}, in::level_gain{}});
    CHECK(failing_new::fail_each_allocation([&] {
              auto heard = in::with_speckle(in::with_tone(in::render(s, sonar, options), sonar, {.drift = 2}));
              const auto ground = in::to_ground_range(heard, sonar, {.altitude = 4, .range = 7, .bins = 9});
              return std::pair(ground.image | in::water_column{} | in::automatic_display{}, ground.labels.seabed);
          }) > 50);
}

TEST_CASE("Drawing on several threads survives any failed allocation, and the pool stays usable") {
    const in::scene s = mixed_scene();
    in::thread_pool pool(3);
    CHECK(failing_new::fail_each_allocation([&] { return in::render(s, small_rig, {.cell = 2.3}, pool).image; }) > 50);
    CHECK(failing_new::fail_each_allocation([&] { return in::render(s, sonar, in::record_options<>{}, pool).image; }) >
          20);
}

TEST_CASE("A context survives any failed allocation without leaks") {
    const in::scene s = mixed_scene();
    constexpr in::overhead larger{
        .altitude = 4, .size = {160, 110}, .grazing = 0.4f};  // planes of 70 KB come from the context
    CHECK(failing_new::fail_each_allocation([&] {
              in::context context;
              in::image<float> last;
              for (int frame = 0; frame < 2; ++frame) last = in::render(s, larger, {.cell = 0.7}, context).image;
              return last;
          }) > 50);
}

TEST_CASE("Occlusion survives any failed allocation") {
    const in::scene s = mixed_scene();
    const glm::dvec3 at[] = {{0, 0, 1}, {0.9, 0.1, 0.02}};
    CHECK(failing_new::fail_each_allocation([&] {
              const auto built =
                  in::occlusion_of(s, in::light_of(small_rig), {.box = {{-1, -1, 0}, {1, 1, 1}}, .cell = 0.5});
              return built.test(at).lit;
          }) > 20);
}

TEST_CASE("A failed add() leaves the scene unchanged") {
    in::scene s = mixed_scene();
    s.targets.shrink_to_fit();
    const std::string long_name(100, 'x');
    CHECK(failing_new::fail_each_allocation([&] {
              const std::size_t before = s.targets.size();
              bool is_whole = true;
              try {
                  s.add(in::cube{}, {}, long_name);
                  is_whole = s.targets.size() == before + 1 && s.targets.back().class_name == long_name;
                  s.targets.pop_back();
                  s.targets.shrink_to_fit();
              } catch (const std::bad_alloc&) {
                  is_whole = s.targets.size() == before && s.targets.back().class_name == "cube";
              }
              return is_whole;
          }) > 3);
}
