// The built-in seabeds: determinism, moments, spectra and shapes of their relief.
#include <insonify/core/thread_pool.hpp>
#include <insonify/seabed/models.hpp>
#include <insonify/seabed/sample.hpp>

#include <algorithm>
#include <cmath>

#include "../../catch.hpp"
#include "../../larger.hpp"
#include "smooth.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

constexpr double pi = 3.14159265358979323846;

struct moments {
    double mean = 0, variance = 0, kurtosis = 0, low = 1e30, high = -1e30;
};
moments moments_of(const in::image<float>& heights) {
    moments m;
    const auto n = static_cast<double>(heights.size());
    for (const float h : heights.pixels()) {
        m.mean += static_cast<double>(h) / n;
        m.low = std::min(m.low, static_cast<double>(h));
        m.high = std::max(m.high, static_cast<double>(h));
    }
    double fourth = 0;
    for (const float h : heights.pixels()) {
        const double square = (static_cast<double>(h) - m.mean) * (static_cast<double>(h) - m.mean);
        m.variance += square / n;
        fourth += square * square / n;
    }
    m.kurtosis = m.variance > 0 ? fourth / (m.variance * m.variance) : 0;
    return m;
}

/// Power of a row at a frequency in cycles per sample, through a Hann window.
double power_at(std::span<const float> row, double frequency) {
    double re = 0, im = 0;
    const auto n = static_cast<double>(row.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
        const auto t = static_cast<double>(i);
        const double value = static_cast<double>(row[i]) * (1 - std::cos(2 * pi * t / n));
        re += value * std::cos(2 * pi * frequency * t);
        im += value * std::sin(2 * pi * frequency * t);
    }
    return re * re + im * im;
}

/// Fraction of vertices in the shadow of a parallel light from -x at a grazing angle.
double shadowed(const sb::heightfield& field, double degrees) {
    const double rise = std::tan(degrees * pi / 180) * field.spacing;
    std::size_t dark = 0;
    for (int j = 0; j < field.heights.height(); ++j) {
        double horizon = -1e30;
        for (int i = 0; i < field.heights.width(); ++i) {
            const double level = static_cast<double>(field.heights(i, j)) + rise * i;
            dark += level < horizon ? 1u : 0u;
            horizon = std::max(horizon, level);
        }
    }
    return static_cast<double>(dark) / static_cast<double>(field.heights.size());
}

/// Executor that makes its calls in reverse order.
struct backwards {
    template <class Fn>
    void bulk(std::size_t count, Fn&& fn) const {
        while (count > 0) fn(--count);
    }
};

const std::vector<sb::any>& kinds() {
    static const std::vector<sb::any> all{sb::flat{.seed = 5},
                                          sb::ripples{.seed = 5},
                                          sb::mud{.seed = 5},
                                          sb::rock{.seed = 5},
                                          sb::blend{.first = sb::rock{}, .patch = 4, .seed = 5},
                                          sb::mixed{.layers = {{sb::ripples{}, sb::patches{.size = 5}},
                                                               {sb::mud{}, sb::band{{{-9, 0}, {9, 6}}, 2}, 0.4f},
                                                               {sb::rock{}, sb::disc{{4, 4}, 1}}}}};
    return all;
}

static_assert(sb::model<sb::flat> && sb::model<sb::ripples> && sb::model<sb::mud> && sb::model<sb::rock>);
static_assert(sb::model<sb::blend> && sb::model<sb::heightfield> && sb::model<sb::any> && !sb::model<int>);

}  // namespace

TEST_CASE("Heights and types depend on the position alone, for any patch, cut, order and thread", "[threads]") {
    const double far_away = GENERATE(0.0, -10000000.0);
    for (const sb::any& kind : kinds()) {
        const double spacing = 1.0 / 32;
        const sb::grid whole{.origin = {far_away, 3}, .spacing = spacing, .width = 300, .height = 40};
        const auto reference = sb::sample(kind, whole);
        in::thread_pool pool(3);
        CHECK(sb::sample(kind, whole, pool).heights == reference.heights);
        CHECK(sb::sample(kind, whole, backwards{}).types == reference.types);

        const sb::grid patch{
            .origin = {far_away + 97 * spacing, 3 + 11 * spacing}, .spacing = spacing, .width = 150, .height = 9};
        const auto part = sb::sample(kind, patch);
        const auto prepared = sb::prepare(kind);
        const auto label = [](const sb::heightfield& field, int i, int j) {
            return field.types.empty() ? field.fallback : field.types(i, j);
        };
        std::size_t differing = 0;
        for (int j = 0; j < patch.height; ++j) {
            for (int i = 0; i < patch.width; ++i) {
                differing += part.heights(i, j) != reference.heights(i + 97, j + 11) ? 1u : 0u;
                differing += label(part, i, j) != label(reference, i + 97, j + 11) ? 1u : 0u;
                const auto point = sb::at(prepared, patch.origin.x + i * spacing, patch.origin.y + j * spacing);
                differing += point.height != part.heights(i, j) || point.kind != label(part, i, j) ? 1u : 0u;
            }
        }
        CHECK(differing == 0);
    }
}

namespace {

struct raise_blocks {
    const sb::detail::block_layer& layer;
    const sb::detail::stretch& part;
    float* values;
    static constexpr int avx512_lanes = 16;
    template <int N>
    INSONIFY_INLINE void run() const {
        layer.raise<N>(part, values);
    }
};

}  // namespace

TEST_CASE("Every instruction set gives the same bits, for dense and for sparse samples") {
    using namespace sb::detail;
    const double origin = GENERATE(0.0, -10000000.0), spacing = GENERATE(0.001, 0.03, 5.3);
    const sb::detail::power_law_noise noise({.rms = 0.1f, .longest = 2}, 3, stream::sand);
    const ripple_train train({.wavelength = 0.5f, .direction = 0.7f}, 3, stream::ripples, "ripples");
    const round_marks marks(1.5, 0.9f, 0.5f, 0.1f, 0.2f, {3, stream::mounds});
    const trawl_furrows furrows({.density = 0.3f}, 3);
    const block_layer blocks(0.7, 0.6f, 0.4f, 2, {3, stream::blocks});
    for (int j = 0; j < 5; ++j) {
        const sb::scanline line{.y = origin + 0.37 * j, .origin = origin, .spacing = spacing};
        const stretch part(line, 201);
        const auto at = [&](in::isa level) {
            stretch_values values{};
            insonify::detail::dispatch(raise_blocks{blocks, part, values.data()}, level);
            noise.add(part, values, level);
            train.add(part, values, level);
            marks.add(part, values, level);
            furrows.add(part, values, level);
            return std::vector<float>(values.begin(), values.begin() + 201);
        };
        CHECK(at(in::isa::baseline) == at(in::isa::scalar));
        CHECK(at(in::isa::avx2) == at(in::isa::scalar));
        CHECK(at(in::isa::avx512) == at(in::isa::scalar));
    }
}

TEST_CASE("at() equals the prepared sampler, and seeds give different relief") {
    std::visit(
        [](const auto&... recipe) {
            const auto check = [](const auto& r) {
                auto other = r;
                other.seed = 77;
                const float height = sb::at(r, 12.25, -3.5).height;
                CHECK(height == sb::at(sb::prepare(r), 12.25, -3.5).height);
                CHECK(height != sb::at(other, 12.25, -3.5).height);
            };
            (check(recipe), ...);
        },
        std::variant<sb::flat>(), std::variant<sb::ripples>(), std::variant<sb::mud>(), std::variant<sb::rock>());
    CHECK(sb::at(sb::blend{}, 2.0, 1.0).kind == sb::at(sb::blend{}.prepare(), 2.0, 1.0).kind);
}

TEST_CASE("Relief is as continuous 10^7 m from the origin as at it") {
    const double origin = GENERATE(0.0, 10000000.0);
    for (const sb::any& kind : kinds()) {
        const auto field =
            sb::sample(kind, {.origin = {origin, origin}, .spacing = 1.0 / 1024, .width = 400, .height = 8});
        float steepest = 0;
        for (int j = 0; j < 8; ++j) {
            for (int i = 1; i < 400; ++i) {
                steepest = std::max(steepest, std::abs(field.heights(i, j) - field.heights(i - 1, j)) * 1024);
            }
        }
        CHECK(steepest < 9.0f);
    }
}

TEST_CASE("A seabed sinks about as deep as 99 % of its surface strays from its mean level") {
    std::vector<sb::any> all = kinds();
    all.back() = sb::ripples{.surface = {.rms = 0.05f}, .seed = 5};  // mixed ones sink as deep as their deepest layer
    all.push_back(sb::mud{.density = 0, .trawls = {.density = 0.1f, .depth = 0.3f}});
    for (const sb::any& kind : all) {
        const auto field = sb::sample(kind, {.origin = {-20, -20}, .spacing = 0.08, .width = 500, .height = 500});
        const double mean = moments_of(field.heights).mean;
        std::vector<double> strayed;
        for (const float h : field.heights.pixels()) strayed.push_back(std::abs(static_cast<double>(h) - mean));
        std::sort(strayed.begin(), strayed.end());
        const double most = strayed[strayed.size() * 99 / 100];
        CHECK(static_cast<double>(kind.sink_depth()) > 0.6 * most);
        CHECK(static_cast<double>(kind.sink_depth()) < 2 * most);
    }
}

TEST_CASE("Gradient noise has mean 0, variance 1 and the slope that its integrals give") {
    const sb::flat noise{.surface{.rms = 1, .longest = 1, .shortest = 1}, .seed = 3};
    const auto prepared = noise.prepare();
    double mean = 0, square = 0, slope = 0;
    const int rows = 700, columns = 700;
    std::vector<float> here(columns), next(columns);
    for (int j = 0; j < rows; ++j) {
        const double y = 0.37 * j;
        prepared.row({.y = y, .spacing = 0.37}, here);
        prepared.row({.y = y, .origin = 1e-3, .spacing = 0.37}, next);
        for (std::size_t i = 0; i < columns; ++i) {
            const double n = static_cast<double>(here[i]), rise = static_cast<double>(next[i] - here[i]) / 1e-3;
            mean += n / (rows * columns);
            square += n * n / (rows * columns);
            slope += rise * rise / (rows * columns);
        }
    }
    CHECK(mean == Approx(0).margin(0.02));
    CHECK(square == Approx(1).epsilon(0.02));
    CHECK(2 * slope == Approx(static_cast<double>(sb::detail::gradient_noise::mean_square_slope)).epsilon(0.02));
}

TEST_CASE("The spectrum of a roughness falls with its exponent, and its rms is the parameter's") {
    const float exponent = GENERATE(2.6f, 3.25f, 3.8f);
    const sb::flat sand{.surface{.rms = 0.02f, .longest = 64, .shortest = 0.1f, .exponent = exponent}, .seed = 11};
    // Rows far apart are independent. A cut through an isotropic K^-g spectrum has a spectrum k^-(g - 1).
    const int n = 1024, rows = 160;
    const auto prepared = sand.prepare();
    std::vector<float> row(n);
    std::vector<double> power(13, 0.0), frequency;
    for (std::size_t f = 0; f < power.size(); ++f) frequency.push_back(4 * std::pow(2.0, 0.5 * static_cast<double>(f)));
    for (int j = 0; j < rows; ++j) {
        prepared.row({.y = 71.3 * j, .origin = 13.7 * j, .spacing = 1.0 / 16}, row);
        for (std::size_t f = 0; f < power.size(); ++f) power[f] += power_at(row, frequency[f] / n);
    }
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    const auto count = static_cast<double>(power.size());
    for (std::size_t f = 0; f < power.size(); ++f) {
        const double x = std::log(frequency[f]), y = std::log(power[f]);
        sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    const double slope = (count * sxy - sx * sy) / (count * sxx - sx * sx);
    INFO("exponent measured: " << 1 - slope);
    CHECK(1 - slope == Approx(static_cast<double>(exponent)).margin(0.2));

    const sb::flat small{.surface{.rms = 0.02f, .longest = 1, .shortest = 0.1f, .exponent = exponent}};
    const auto m = moments_of(sb::sample(small, {.spacing = 0.2, .width = 600, .height = 600}).heights);
    CHECK(std::sqrt(m.variance) == Approx(0.02).epsilon(0.03));
}

TEST_CASE("Flat sand without roughness is a plane at the datum") {
    const auto m = moments_of(sb::sample(sb::flat{.surface = smooth}, {.width = 20, .height = 20}).heights);
    CHECK(m.low == 0);
    CHECK(m.high == 0);
}

TEST_CASE("Ripples have one amplitude everywhere, not that of a Gaussian field") {
    sb::ripples recipe{.wavelength = 0.8f, .steepness = 0.125f, .sharpness = 0, .surface = smooth, .seed = 4};
    const sb::grid area{.spacing = 0.0625, .width = 800, .height = 800};
    const auto plain = moments_of(sb::sample(recipe, area).heights);
    CHECK(plain.kurtosis == Approx(1.5).margin(0.06));  // 3 for a Gaussian field, 1.5 for a sinusoid
    CHECK(plain.mean == Approx(0).margin(1e-3));
    CHECK(plain.low >= -0.05);
    CHECK(plain.high <= 0.05);
    CHECK(plain.high - plain.low > 0.0985);

    SECTION("sharper crests are narrower and keep the height") {
        recipe.sharpness = 0.5f;
        const auto sharp = moments_of(sb::sample(recipe, area).heights);
        // The mean of (c - s) / (1 - s c) over a period is (sqrt(1 - s^2) - 1) / s.
        CHECK(sharp.mean == Approx(0.05 * (std::sqrt(0.75) - 1) / 0.5).margin(1.5e-3));
        CHECK(sharp.low >= -0.05);
        CHECK(sharp.high <= 0.05);
        CHECK(sharp.high - sharp.low > 0.0985);
    }
}

TEST_CASE("The spectrum of ripples peaks at their wavelength, along their direction") {
    const bool along_y = GENERATE(false, true);
    const float wavelength = GENERATE(0.3f, 1.2f);
    const sb::ripples recipe{.wavelength = wavelength,
                             .direction = along_y ? static_cast<float>(pi / 2) : 0.0f,
                             .surface = smooth,
                             .seed = 8};
    const int n = 512;
    const double spacing = static_cast<double>(wavelength) / 16;
    auto heights = sb::sample(recipe, {.spacing = spacing, .width = n, .height = n}).heights;
    if (along_y) {
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < j; ++i) std::swap(heights(i, j), heights(j, i));
        }
    }
    double best = 0;
    int peak = 0;
    for (int cycles = 4; cycles < 96; ++cycles) {
        double power = 0;
        for (int j = 0; j < n; j += 8) power += power_at(heights.row(j), static_cast<double>(cycles) / n);
        if (power > best) best = power, peak = cycles;
    }
    CHECK(peak == Approx(n / 16.0).epsilon(0.1));
}

TEST_CASE("Interpolating the envelope of ripples costs less than a hundredth of their height") {
    const double origin = GENERATE(0.0, 10000000.0);
    const float spread = GENERATE(0.0f, 0.09f, 0.4f);
    const sb::ripples recipe{.wavelength = 0.8f, .steepness = 0.5f, .spread = spread, .surface = smooth, .seed = 9};
    const double s = static_cast<double>(recipe.sharpness),
                 soft = static_cast<double>(sb::detail::ripple_train::softening);
    const sb::ripples_sampler prepared(recipe);
    const sb::grid area{.origin = {origin, -origin}, .spacing = 0.137, .width = 150, .height = 150};
    const auto field = sb::sample(recipe, area);
    double worst = 0, square = 0;
    for (int j = 0; j < area.height; ++j) {
        for (int i = 0; i < area.width; ++i) {
            const auto psi = prepared.psi(origin + area.spacing * i, -origin + area.spacing * j);
            const double magnitude = std::sqrt(psi.re * psi.re + psi.im * psi.im + soft * soft);
            const double exact = (psi.re - s * magnitude) / (magnitude - s * psi.re);
            const double error = std::abs(exact - static_cast<double>(field.heights(i, j)) / 0.2) / 2;
            worst = larger(worst, error);
            square += error * error / (area.width * area.height);
        }
    }
    INFO("worst " << worst << ", rms " << std::sqrt(square));
    CHECK(worst < 0.01);
    CHECK(std::sqrt(square) < 0.001);
}

TEST_CASE("Slopes of ripples stay bounded, at forks as elsewhere") {
    const sb::ripples recipe{.wavelength = 1, .steepness = 0.1f, .sharpness = 0, .surface = smooth, .seed = 3};
    const double spacing = 1.0 / 64;
    const auto field = sb::sample(recipe, {.spacing = spacing, .width = 1500, .height = 300});
    double steepest = 0;
    for (int j = 0; j < 300; ++j) {
        for (int i = 1; i < 1500; ++i) {
            const auto rise = static_cast<double>(field.heights(i, j) - field.heights(i - 1, j));
            steepest = std::max(steepest, std::abs(rise) / spacing);
        }
    }
    // A sinusoid of this height and length has slopes up to pi height / wavelength.
    CHECK(steepest > 0.9 * pi * 0.1);
    CHECK(steepest < 3 * pi * 0.1);
}

TEST_CASE("Mounds and pock marks of mud have the density, height and volume of their parameters") {
    const float share = GENERATE(0.0f, 1.0f);
    const sb::mud recipe{.surface = smooth,
                         .density = 0.3f,
                         .size = 0.4f,
                         .mound_height = 0.05f,
                         .pock_depth = 0.1f,
                         .pock_fraction = share,
                         .seed = 6};
    const sb::grid around_origin{.origin = {-70, -70}, .spacing = 0.09, .width = 1500, .height = 1500};
    const auto m = moments_of(sb::sample(recipe, around_origin).heights);
    const double height = share > 0 ? -0.1 : 0.05;
    CHECK((share > 0 ? m.low : m.high) == Approx(height).epsilon(0.05));
    CHECK((share > 0 ? m.high : m.low) == 0);
    // The bump h (1 - (r / R)^2)^2 holds pi R^2 h / 3, with R = size q, h = height q, q uniform in [0.4, 1]: <q^3> is
    // 0.406.
    CHECK(m.mean == Approx(0.3 * pi / 3 * 0.16 * height * 0.406).epsilon(0.05));
}

TEST_CASE("Trawl marks have the density, depth and width of their parameters") {
    const int directions = GENERATE(1, 3);
    const float density = GENERATE(0.02f, 0.1f);
    const double spacing = 0.02, depth = 0.1;
    std::vector<float> profile(20000);
    const double rows = 200 * 2;
    double furrows = 0, deepest = 0, highest = 0, narrowest = 1e30;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {  // each with headings of its own
        sb::mud bed{.surface = smooth, .density = 0, .seed = seed};
        bed.trawls = {.density = density, .depth = 0.1f, .width = 0.5f, .directions = directions, .length = 20};
        const auto prepared = bed.prepare();
        for (int row = 0; row < 2; ++row) {
            prepared.row({.y = 357.3 * row - 200, .origin = -200, .spacing = spacing}, profile);
            double berm = -1;  // the last sample of the highest part of the berm before a furrow
            bool inside = false;
            for (std::size_t i = 1; i + 1 < profile.size(); ++i) {
                const auto before = static_cast<double>(profile[i - 1]), z = static_cast<double>(profile[i]);
                const auto next = static_cast<double>(profile[i + 1]);
                deepest = std::min(deepest, z);
                highest = std::max(highest, z);
                if (z < -0.5 * depth && !inside) furrows += 1, inside = true;
                if (z <= 0.25 * depth || before >= z || next > z) continue;  // not the top of a berm
                const double here = spacing * static_cast<double>(i);
                if (inside && berm >= 0) narrowest = std::min(narrowest, here - berm);
                berm = here;
                inside = false;
            }
        }
    }
    // A line at random meets 2 / pi of what a line across the furrows meets.
    CHECK(furrows / (rows * spacing * 20000) == Approx(2 / pi * static_cast<double>(density)).epsilon(0.1));
    if (directions > 1) return;  // where furrows cross, their reliefs add
    CHECK(narrowest == Approx(0.5).margin(2 * spacing));
    CHECK(deepest == Approx(-depth).epsilon(0.01));
    CHECK(highest == Approx(0.3 * depth).epsilon(0.01));
}

TEST_CASE("At a grazing angle of six degrees rock and ripples are a third in shadow, sand and mud almost free of it") {
    const sb::grid area{.spacing = 0.025, .width = 800, .height = 200};
    const auto share = [&](const sb::any& kind) { return shadowed(sb::sample(kind, area), 6); };
    const double sand = share(sb::flat{}), ripples = share(sb::ripples{}), mud = share(sb::mud{}),
                 rock = share(sb::rock{});
    INFO(sand << " " << ripples << " " << mud << " " << rock);
    CHECK(sand < 0.02);
    CHECK(mud < 0.05);
    CHECK(ripples > 0.3);
    CHECK(rock > 0.3);
}

TEST_CASE("Rock stands on the datum, about as high as its relief, with faces of the given steepness") {
    const sb::rock recipe{.relief = 0.8f, .steepness = 2.5f, .surface = smooth};
    const double spacing = 0.01;
    const auto field = sb::sample(recipe, {.spacing = spacing, .width = 2000, .height = 200});
    const auto m = moments_of(field.heights);
    CHECK(m.low >= 0);
    CHECK(m.high > 0.6 * 0.8);
    CHECK(m.high < 2 * 0.8);
    std::size_t steep = 0;
    for (int j = 0; j < 200; ++j) {
        for (int i = 1; i < 2000; ++i) {
            steep += std::abs(field.heights(i, j) - field.heights(i - 1, j)) > 0.01f ? 1u : 0u;
        }
    }
    CHECK(static_cast<double>(steep) / 400000 > 0.05);
    CHECK(moments_of(sb::sample(sb::rock{.relief = 0, .surface = smooth}, {}).heights).high == 0);
}

TEST_CASE("A blend covers its given fraction and is the pure model at fractions of 0 and 1") {
    const float coverage = GENERATE(0.1f, 0.35f, 0.5f, 0.8f);
    const sb::blend recipe{.first = sb::mud{}, .second = sb::flat{}, .coverage = coverage, .patch = 3, .border = 0.5f};
    const auto field = sb::sample(recipe, {.spacing = 0.73, .width = 500, .height = 500});
    std::size_t first = 0;
    for (const sb::type t : field.types.pixels()) first += t == sb::type::mud ? 1u : 0u;
    CHECK(static_cast<double>(first) / 250000 == Approx(static_cast<double>(coverage)).margin(0.03));

    const sb::grid area{.spacing = 0.1, .width = 200, .height = 50};
    CHECK(sb::sample(sb::blend{.first = sb::mud{}, .coverage = 1}, area).heights ==
          sb::sample(sb::mud{}, area).heights);
    CHECK(sb::sample(sb::blend{.second = sb::mud{}, .coverage = 0}, area).heights ==
          sb::sample(sb::mud{}, area).heights);
}

namespace {

/// A slope of one, as a user would write it.
struct ramp {
    static constexpr sb::type kind = sb::type::rock;
    void row(const sb::scanline& line, std::span<float> heights) const {
        for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = static_cast<float>(line.x(i));
    }
};

}  // namespace

TEST_CASE("Blends take users' own models") {
    const sb::blend recipe{.first = ramp{}, .coverage = 1};
    CHECK(sb::at(recipe, 3.5, 0).height == 3.5f);
    CHECK(sb::at(recipe, 3.5, 0).kind == sb::type::rock);
}

TEST_CASE("Refusals name the parameter") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_WITH(sb::ripples{.wavelength = 0}.prepare(), ContainsSubstring("ripples.wavelength is 0"));
    CHECK_THROWS_WITH(sb::ripples{.steepness = -1}.prepare(), ContainsSubstring("ripples.steepness is -1"));
    CHECK_THROWS_WITH(sb::ripples{.direction = nan}.prepare(), ContainsSubstring("ripples.direction"));
    CHECK_THROWS_WITH(sb::ripples{.spread = 2}.prepare(), ContainsSubstring("ripples.spread"));
    CHECK_THROWS_WITH(sb::ripples{.bandwidth = nan}.prepare(), ContainsSubstring("ripples.bandwidth"));
    CHECK_THROWS_WITH(sb::ripples{.sharpness = 1}.prepare(), ContainsSubstring("ripples.sharpness"));
    CHECK_THROWS_WITH((sb::flat{.surface = {.shortest = 0}}.prepare()), ContainsSubstring("roughness.shortest"));
    CHECK_THROWS_WITH((sb::flat{.surface = {.exponent = 5}}.prepare()), ContainsSubstring("roughness.exponent"));
    CHECK_THROWS_WITH((sb::mud{.density = 9}.prepare()), ContainsSubstring("mud.density is 9"));
    CHECK_THROWS_WITH(sb::mud{.size = nan}.prepare(), ContainsSubstring("mud.size"));
    CHECK_THROWS_WITH(sb::rock{.steepness = 0}.prepare(), ContainsSubstring("rock.steepness"));
    CHECK_THROWS_WITH(sb::blend{.coverage = 1.5f}.prepare(), ContainsSubstring("blend.coverage"));
    CHECK_THROWS_WITH((sb::blend{.patch = 1, .border = 2}.prepare()), ContainsSubstring("blend.border"));
    CHECK_THROWS_AS(sb::sample(sb::any(sb::rock{.block = 0}), {}), in::invalid_input);
}
