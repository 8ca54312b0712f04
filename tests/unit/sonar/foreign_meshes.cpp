// Shadows on imported meshes against the oracle: open, closed, non-manifold, self-touching, inside-out, dense and huge
// ones, in any order.
#include "../../catch.hpp"
#include "../../foreign_scenes.hpp"
#include "../../shadow_oracle.hpp"

namespace in = insonify;
namespace foreign = foreign_scenes;
namespace shapes = shadow_meshes;

namespace {

struct light_from {
    double azimuth, elevation;
};

/// A policy's pictures of one scene. The oracle judges the triangles that the picture shows.
template <class Policy>
shadow_oracle::tally judged(const in::scene& s, const std::vector<int>& sizes, const std::vector<light_from>& lights) {
    const shadow_oracle::oracle truth(s, foreign::rig(0, 45, 64));
    shadow_oracle::tally sum;
    for (const int size : sizes)
        for (const light_from& l : lights) {
            const in::overhead rig = foreign::rig(l.azimuth, l.elevation, size);
            const in::render_options<Policy> how;
            const auto frame = in::render(s, rig, how);
            const in::visibility shown = in::visible_triangles(s, rig, how);
            REQUIRE(shown.instance == frame.labels.instance);
            sum += shadow_oracle::compare(truth.judge(rig, shown), frame.labels);
        }
    return sum;
}

}  // namespace

TEST_CASE("Exact shadows are right on every mesh: at most 1e-5 of the pixels are wrong") {
    shadow_oracle::tally all;
    for (const auto& [name, s] : foreign::all(false)) {
        auto t = judged<in::shadow::exact>(s, {64}, {{23.7, 0.5}, {160, 6}, {0, 33}, {251.3, 89}});
        t += judged<in::shadow::exact>(s, {128}, {{95, 2}, {310, 60}});
        t += judged<in::shadow::exact>(s, {256}, {{23.7, 33}});
        INFO(name << ": " << t.false_dark << " dark that should be lit, " << t.false_lit << " lit that should be dark");
        CHECK(t.share() <= 1e-5);
        CHECK(t.undecided <= t.shown / 1000);
        all += t;
    }
    CHECK(all.shown > 1500000);
    CHECK(all.share() <= 1e-5);
}

TEST_CASE("Exact shadows are right on meshes of up to 320 000 triangles", "[.slow]") {
    for (const auto& [name, s] : foreign::all(true)) {
        const auto t = judged<in::shadow::exact>(s, {64, 512}, {{23.7, 0.5}, {160, 6}, {0, 33}, {251.3, 89}});
        INFO(name << ": " << t.false_dark << " dark that should be lit, " << t.false_lit << " lit that should be dark");
        CHECK(t.share() <= 1e-5);
        CHECK(t.undecided <= t.shown / 1000);
    }
}

TEST_CASE("Pixels whose centre lies beside the visible triangle have no more errors") {
    for (const auto& s : {foreign::on_ground(shapes::statue(), {.position = {0.0123, 0.0457, 0.7}}),
                          foreign::bare(shapes::relief(400))}) {
        const auto t = judged<in::shadow::exact>(s, {64, 128, 256}, {{23.7, 6}, {160, 33}, {0, 89}});
        CAPTURE(t.beside, t.beside_wrong);
        CHECK(t.beside > 0);
        CHECK(static_cast<double>(t.beside_wrong) <= 1e-5 * static_cast<double>(t.shown));
    }
}

TEST_CASE("A mesh with an index without a position cannot enter a scene") {
    for (const std::uint32_t index : {4u, 0xFFFFFFFFu}) {
        in::mesh m = shapes::tilted_quad();
        m.triangles[1].y = index;
        in::scene s;
        CHECK_THROWS_AS(s.add(m, {}, "broken"), in::invalid_input);
    }
    // Wherever it stands, among as many triangles as fill the lanes and leave some over.
    for (std::size_t count = 1; count < 14; ++count)
        for (std::size_t bad = 0; bad < 3 * count; ++bad) {
            in::mesh m = shapes::tilted_quad();
            m.triangles.assign(count, {0, 1, 2});
            m.triangles[bad / 3][static_cast<int>(bad % 3)] = 4;
            CHECK_THROWS_AS(in::scene().add(m, {}, "broken"), in::invalid_input);
        }
}
