// Histograms, equalization and matching against hand-counted cases, invariants, and independent implementations of
// the published rules.
#include <insonify/core/random.hpp>
#include <insonify/core/thread_pool.hpp>
#include <insonify/filter/convert.hpp>
#include <insonify/filter/histogram.hpp>
#include <insonify/filter/match.hpp>
#include <insonify/filter/pipe.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "../../catch.hpp"

namespace in = insonify;

namespace {

const float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// Values with ties: u^power on a grid of `steps`.
in::image<float> random_image(int width, int height, std::uint64_t seed, int power, int steps) {
    in::random_sequence draws(seed);
    in::image<float> out(width, height);
    for (float& pixel : out.pixels()) {
        double value = draws.uniform();
        for (int i = 1; i < power; ++i) value *= draws.uniform();
        pixel = static_cast<float>(std::floor(value * steps) / steps);
    }
    return out;
}

/// np.interp(source quantiles, reference quantiles, reference values), value by value.
std::map<float, double> scikit_rule(const in::image<float>& source, const in::image<float>& reference) {
    const auto quantiles = [](const in::image<float>& image) {
        std::map<float, double> fractions;
        for (const float pixel : image.pixels()) fractions[pixel] += 1;
        double sum = 0;
        for (auto& [value, fraction] : fractions) fraction = (sum += fraction) / static_cast<double>(image.size());
        return fractions;
    };
    const auto wanted = quantiles(reference);
    std::map<float, double> result;
    for (const auto& [value, fraction] : quantiles(source)) {
        auto above = wanted.begin();
        while (above->second < fraction) ++above;
        result[value] = static_cast<double>(above->first);
        if (above == wanted.begin()) continue;
        const auto below = std::prev(above);
        const double t = (fraction - below->second) / (above->second - below->second);
        result[value] = static_cast<double>(below->first) * (1 - t) + static_cast<double>(above->first) * t;
    }
    return result;
}

/// The matrix form of histeq(I, hgram): err = cumd - cum + tol, the least that isn't negative.
std::vector<double> histeq_rule(const std::vector<std::uint64_t>& nn, const std::vector<std::uint64_t>& hgram) {
    double pixels = 0, wanted = 0;
    for (const auto n : nn) pixels += static_cast<double>(n);
    for (const auto n : hgram) wanted += static_cast<double>(n);
    std::vector<double> map;
    double cum = 0;
    for (std::size_t k = 0; k < nn.size(); ++k) {
        cum += static_cast<double>(nn[k]);
        const double tol = k == 0 || k + 1 == nn.size() ? 0 : static_cast<double>(nn[k]) / 2;
        double best = 2 * pixels, cumd = 0;
        std::size_t at = 0;
        for (std::size_t j = 0; j < hgram.size(); ++j) {
            cumd += static_cast<double>(hgram[j]) * pixels / wanted;
            double err = cumd - cum + tol;
            if (err < -pixels * std::sqrt(2.220446049250313e-16)) err = pixels;
            if (err < best - 1e-9 * pixels) {
                best = err;
                at = j;
            }
        }
        map.push_back(static_cast<double>(at) / static_cast<double>(hgram.size() - 1));
    }
    return map;
}

bool is_monotone(const in::image<float>& from, const in::image<float>& to) {
    std::map<float, std::set<float>> map;
    for (std::size_t i = 0; i < from.size(); ++i) map[from.pixels()[i]].insert(to.pixels()[i]);
    float last = -1e30f;
    for (const auto& [value, results] : map) {
        if (results.size() != 1 || *results.begin() < last) return false;
        last = *results.begin();
    }
    return true;
}

/// Largest difference between the cumulative distributions of two images.
double kolmogorov(const in::image<float>& a, const in::image<float>& b) {
    std::map<float, std::pair<double, double>> steps;
    for (const float v : a.pixels()) steps[v].first += 1.0 / static_cast<double>(a.size());
    for (const float v : b.pixels()) steps[v].second += 1.0 / static_cast<double>(b.size());
    double first = 0, second = 0, largest = 0;
    for (const auto& [value, step] : steps) {
        first += step.first;
        second += step.second;
        largest = std::fmax(largest, std::abs(first - second));
    }
    return largest;
}

}  // namespace

TEST_CASE("A histogram counts each pixel at the nearest level") {
    const in::image<float> values{{0, 0.124f, 0.125f, 0.5f, 0.874f, 0.876f, 1, -2, 9, not_a_number}};
    CHECK(in::histogram_of(values, 5).counts == std::vector<std::uint64_t>{3, 1, 1, 1, 3});
    CHECK(in::histogram_of(values, 5).total() == 9);
    // imhist(uint8, 4): bins of 85 centred at 0, 85, 170, 255.
    const in::image<std::uint8_t> codes{{0, 42, 43, 127, 128, 212, 213, 255}};
    CHECK(in::histogram_of(codes, 4).counts == std::vector<std::uint64_t>{2, 2, 2, 2});
    CHECK(in::histogram_of(codes).counts[43] == 1);
    CHECK(in::histogram_of(codes | in::to_float, 64).counts == in::histogram_of(codes, 64).counts);
    CHECK(in::histogram_of(in::image<float>()).total() == 0);
    for (const int bins : {-1, 0, 1, 65537}) CHECK_THROWS_AS(in::histogram_of(values, bins), in::invalid_input);
}

TEST_CASE("A distribution lists the distinct finite values in order") {
    const float inf = std::numeric_limits<float>::infinity();
    const auto d =
        in::distribution_of(in::image<float>{{3, -1, 0.5f, -0.0f, 0.0f, not_a_number}, {inf, 3, -inf, -1e-42f, 3, -1}});
    CHECK(d.values == std::vector<float>{-1, -1e-42f, 0, 0.5f, 3});
    CHECK(d.cumulative == std::vector<std::uint64_t>{2, 3, 5, 6, 9});
    CHECK(in::distribution_of(in::image<float>()).total() == 0);

    const auto random = random_image(200, 100, 5, 1, 1 << 23);
    std::map<float, std::uint64_t> counts;
    for (const float v : random.pixels()) ++counts[v];
    const auto sorted = in::distribution_of(random);
    REQUIRE(sorted.values.size() == counts.size());
    std::size_t i = 0;
    std::uint64_t sum = 0;
    for (const auto& [value, count] : counts) {
        CHECK(sorted.values[i] == value);
        CHECK(sorted.cumulative[i++] == (sum += count));
    }
}

TEST_CASE("Exact matching follows scikit-image's rule") {
    const int power = GENERATE(1, 3), steps = GENERATE(7, 300, 1 << 23);
    const auto source = random_image(61, 47, 1, power, steps);
    const auto reference = random_image(53, 71, 2, 2, 100);
    const auto matched = source | in::match_histogram(reference);
    const auto expected = scikit_rule(source, reference);
    for (std::size_t i = 0; i < source.size(); ++i) {
        REQUIRE(static_cast<double>(matched.pixels()[i]) ==
                Approx(expected.at(source.pixels()[i])).epsilon(0).margin(1e-7));
    }
}

TEST_CASE("Exact matching is monotone, idempotent, and the identity on its own reference") {
    const auto source = random_image(90, 80, 3, 2, GENERATE(5, 1000, 1 << 23));
    const auto reference = random_image(70, 60, 4, 1, GENERATE(3, 200, 1 << 23));
    const in::match_histogram match(reference);
    const auto once = source | match;
    CHECK(is_monotone(source, once));
    CHECK((once | match) == once);
    CHECK((reference | match) == reference);
    CHECK((source | in::match_histogram(source)) == source);

    // The distributions differ by at most the largest fraction of one value in the source plus that in the reference.
    const auto values = in::distribution_of(source);
    double largest_fraction = 0;
    for (std::size_t i = 0; i < values.values.size(); ++i) {
        const auto count = values.cumulative[i] - (i > 0 ? values.cumulative[i - 1] : 0);
        largest_fraction = std::fmax(largest_fraction, static_cast<double>(count) / static_cast<double>(source.size()));
    }
    const auto wanted = in::distribution_of(reference);
    double largest_step = 0;
    for (std::size_t i = 0; i < wanted.values.size(); ++i) {
        const auto count = wanted.cumulative[i] - (i > 0 ? wanted.cumulative[i - 1] : 0);
        largest_step = std::fmax(largest_step, static_cast<double>(count) / static_cast<double>(reference.size()));
    }
    CHECK(kolmogorov(once, reference) <= largest_fraction + largest_step + 1e-9);
}

TEST_CASE("Matching depends on the reference's distribution alone") {
    const auto source = random_image(40, 40, 6, 1, 500);
    const auto reference = random_image(30, 20, 7, 2, 90);
    in::image<float> shuffled(20, 60);  // every pixel twice, backwards, another shape
    for (std::size_t i = 0; i < shuffled.size(); ++i) shuffled.pixels()[i] = reference.pixels()[(1199 - i) / 2];
    CHECK((source | in::match_histogram(reference)) == (source | in::match_histogram(shuffled)));
    CHECK((source | in::match_histogram(in::distribution_of(reference))) == (source | in::match_histogram(reference)));
    CHECK((source | in::match_binned(reference)) == (source | in::match_binned(shuffled)));
    CHECK((source | in::match_binned(in::histogram_of(reference, 64))) == (source | in::match_binned(reference)));
}

TEST_CASE("References may be views of images that can be changed, and filters be moved from") {
    auto reference = random_image(30, 20, 7, 2, 90);
    const auto source = random_image(16, 16, 8, 1, 200);
    const auto corner = reference.view().part(3, 4, 10, 9);
    in::image<float> copy(10, 9);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 10; ++x) copy(x, y) = corner(x, y);
    CHECK(in::histogram_of(corner, 64).counts == in::histogram_of(copy, 64).counts);
    in::match_binned by_bins(corner);
    in::match_histogram by_rank(corner);
    const auto moved_bins = std::move(by_bins);
    const auto moved_rank = std::move(by_rank);
    for (const auto& filter : {by_bins, moved_bins}) CHECK((source | filter) == (source | in::match_binned(copy)));
    for (const auto& filter : {by_rank, moved_rank}) CHECK((source | filter) == (source | in::match_histogram(copy)));
}

TEST_CASE("A constant image takes the reference's largest value, and a constant reference gives its only one") {
    const in::image<float> flat(9, 9, 0.3f);
    const auto reference = random_image(30, 30, 8, 1, 50);
    const float largest = in::distribution_of(reference).values.back();
    CHECK((flat | in::match_histogram(reference)) == in::image<float>(9, 9, largest));
    CHECK((reference | in::match_histogram(flat)) == in::image<float>(30, 30, 0.3f));
    const in::image<std::uint8_t> codes(3, 3, 17);
    CHECK((codes | in::match_histogram(flat)) == in::image<std::uint8_t>(3, 3, in::quantize<std::uint8_t>(0.3f)));
}

TEST_CASE("Codes of 8 bits are matched as floats are, and rounded") {
    const auto source = random_image(50, 40, 9, 1, 200) | in::to_uint8;
    const auto reference = random_image(50, 40, 10, 2, 200);
    CHECK((source | in::match_histogram(reference)) ==
          (source | in::to_float | in::match_histogram(reference) | in::to_uint8));
    CHECK((source | in::match_histogram(source)) == source);
    CHECK((source | in::match_histogram(source | in::to_float)) == source);
    CHECK((source | in::match_binned(reference)) ==
          (source | in::to_float | in::match_binned(reference) | in::to_uint8));
}

TEST_CASE("NaN stays NaN, is not counted, and changes no other pixel") {
    const float inf = std::numeric_limits<float>::infinity();
    const in::image<float> reference{{0.25f, 0.5f, 0.75f}};
    const auto out = in::image<float>{{0, not_a_number, 1, 2, inf, -inf}} | in::match_histogram(reference);
    CHECK(out(0, 0) == 0.25f);
    CHECK(std::isnan(out(1, 0)));
    CHECK(out(2, 0) == 0.5f);
    CHECK(out(3, 0) == 0.75f);
    CHECK(out(4, 0) == 0.75f);
    CHECK(out(5, 0) == 0.25f);
    const auto none = in::image<float>{{not_a_number, not_a_number}} | in::match_histogram(reference);
    CHECK(std::isnan(none(0, 0)));
    const auto binned = in::image<float>{{not_a_number, 1}} | in::match_binned(reference);
    CHECK(std::isnan(binned(0, 0)));
    CHECK(binned(1, 0) == (in::image<float>{{1}} | in::match_binned(reference))(0, 0));
    CHECK_THROWS_AS(in::match_histogram(in::image<float>{{not_a_number, inf}}), in::invalid_input);
    CHECK_THROWS_AS(in::match_histogram(in::image<float>()), in::invalid_input);
    CHECK_THROWS_AS(in::match_binned(in::image<float>{{not_a_number}}), in::invalid_input);
    CHECK_THROWS_AS(in::match_binned(in::image<std::uint8_t>()), in::invalid_input);
    CHECK_THROWS_AS(in::match_binned(reference, 1), in::invalid_input);
}

TEST_CASE("Binned matching follows histeq's rule") {
    const int bins = GENERATE(2, 10, 64, 256, 1000);
    const auto source = random_image(100, 90, 11, GENERATE(1, 3), 255);
    const auto reference = random_image(64, 64, 12, 2, 255);
    const auto map = histeq_rule(in::histogram_of(source).counts, in::histogram_of(reference, bins).counts);
    const auto matched = source | in::match_binned(reference, bins);
    for (std::size_t i = 0; i < source.size(); ++i) {
        REQUIRE(matched.pixels()[i] == static_cast<float>(map[in::quantize<std::uint8_t>(source.pixels()[i])]));
    }
    CHECK(is_monotone(source, matched));
    std::set<float> levels(matched.pixels().begin(), matched.pixels().end());
    CHECK(levels.size() <= static_cast<std::size_t>(bins));
}

TEST_CASE("Equalization is histeq: a flat histogram of 64 levels") {
    const auto source = random_image(128, 128, 13, 3, 255);
    const in::histogram flat{std::vector<std::uint64_t>(64, 1)};
    const auto map = histeq_rule(in::histogram_of(source).counts, flat.counts);
    const auto out = source | in::equalize{};
    for (std::size_t i = 0; i < source.size(); ++i) {
        REQUIRE(out.pixels()[i] == static_cast<float>(map[in::quantize<std::uint8_t>(source.pixels()[i])]));
    }
    CHECK((source | in::equalize{.levels = 2}) == (source | in::match_binned(in::histogram{{5, 5}})));
    CHECK((source | in::to_uint8 | in::equalize{}) == (source | in::equalize{} | in::to_uint8));
    CHECK_THROWS_AS((source | in::equalize{.levels = 1}), in::invalid_input);
}

TEST_CASE("Codes of 16 bits: counted at 65536 levels, matched by exact ranks and by bins") {
    in::image<std::uint16_t> all(256, 256);
    for (std::size_t i = 0; i < all.size(); ++i) all.pixels()[i] = static_cast<std::uint16_t>(i);
    CHECK(in::histogram_of(all, 65536).counts == std::vector<std::uint64_t>(65536, 1));
    CHECK(in::histogram_of(all | in::to_float, 65536).counts == std::vector<std::uint64_t>(65536, 1));
    for (const int bins : {2, 3, 64, 255, 256, 1000}) {
        CHECK(in::histogram_of(all, bins).total() == 65536);
        CHECK(in::histogram_of(all, bins).counts == in::histogram_of(all | in::to_float, bins).counts);
    }
    CHECK((all | in::match_histogram(all)) == all);

    const auto source = random_image(70, 50, 14, 1, 1 << 14) | in::to_uint16;
    const auto reference = random_image(60, 40, 15, 2, 1 << 14);
    const in::match_histogram match(reference);
    CHECK((source | match) == (source | in::to_float | match | in::to_uint16));
    const auto codes = reference | in::to_uint16;
    CHECK((source | in::match_histogram(codes)) ==
          (source | in::to_float | in::match_histogram(codes | in::to_float) | in::to_uint16));
    const auto binned = source | in::match_binned(reference, 128);
    CHECK(in::distribution_of(binned).values.size() <= 128);
    CHECK(is_monotone(source | in::to_float, binned | in::to_float));
    // histeq takes 65536 source levels for uint16.
    const auto map = histeq_rule(in::histogram_of(source, 65536).counts, in::histogram_of(reference, 128).counts);
    for (std::size_t i = 0; i < source.size(); ++i)
        REQUIRE(binned.pixels()[i] == static_cast<std::uint16_t>(65535 * map[source.pixels()[i]] + 0.5));
}

TEST_CASE("Histograms of parts add up, on any executor") {
    const auto source = random_image(1200, 2000, 16, 2, 999);  // more than two bands of 2^20 pixels
    for (const int bins : {64, 256, 65536}) {
        in::histogram sum = in::histogram_of(source.view().part(0, 0, 1200, 500), bins);
        sum += in::histogram_of(source.view().part(0, 500, 600, 1500), bins);
        sum += in::histogram_of(source.view().part(600, 500, 600, 1500), bins);
        CHECK(sum == in::histogram_of(source, bins));
        in::thread_pool pool(3);
        CHECK(in::histogram_of(source, bins, pool) == sum);
        CHECK((source | in::match_binned(sum)) == (source | in::match_binned(source, bins)));
    }
    in::histogram other = in::histogram_of(source, 8);
    CHECK_THROWS_AS(other += in::histogram_of(source, 9), in::invalid_input);

    const in::match_binned look(source);
    in::thread_pool pool(3);
    const auto codes = source | in::to_uint8;
    CHECK(apply(codes, look, pool) == (codes | look));
    CHECK(apply(source, in::equalize{}, pool) == (source | in::equalize{}));
}

TEST_CASE("Matching in a chain gives the result of matching alone, with and without NaN") {
    const auto reference = random_image(30, 30, 18, 2, 255);
    const auto double_it = [](float v) { return 2 * v - 0.3f; };  // beyond both ends, too
    const auto same = [](const in::image<float>& a, const in::image<float>& b) {
        return std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin(), b.pixels().end(),
                          [](float p, float q) { return p == q || (std::isnan(p) && std::isnan(q)); });
    };
    in::image<float> source = random_image(700, 301, 19, 1, 9999);
    for (const bool holes : {false, true}) {
        if (holes) source(699, 300) = source(0, 7) = not_a_number;
        const auto doubled = apply(source, double_it);
        const auto behind = [&](const auto& look) {
            const auto alone = doubled | look;
            in::thread_pool pool(3);
            CHECK(same(apply(source, in::filter_chain<>{} | double_it | look, pool), alone));
            CHECK((source | (in::filter_chain<>{} | double_it | look | in::to_uint8)) == (alone | in::to_uint8));
            CHECK(same(source | (in::filter_chain<>{} | double_it | look | double_it), apply(alone, double_it)));
            in::image<float> in_place = source;
            apply_in_place(in_place.view(), in::filter_chain<>{} | double_it | look, pool);
            CHECK(same(in_place, alone));
        };
        behind(in::match_binned(reference));
        behind(in::equalize{.levels = 17});
    }
    CHECK_THROWS_AS(source | (in::filter_chain<>{} | double_it | in::equalize{.levels = 1}), in::invalid_input);
}

TEST_CASE("Binned matching and equalization accept images without contrast, pixels or finite values") {
    const in::image<float> flat(5, 5, 0.4f), reference = random_image(30, 30, 17, 1, 255);
    CHECK(in::distribution_of(flat | in::match_binned(reference)).values.size() == 1);
    // histeq: the level at which half of the reference's pixels are reached.
    CHECK((flat | in::match_binned(in::histogram{{1, 1, 1, 1, 1}})) == in::image<float>(5, 5, 0.5f));
    CHECK((flat | in::equalize{.levels = 5}) == in::image<float>(5, 5, 0.5f));
    // All black or all white: the highest level that the reference has.
    for (const float end : {0.0f, 1.0f})
        CHECK((in::image<float>(5, 5, end) | in::match_binned(in::histogram{{1, 1, 0}})) ==
              in::image<float>(5, 5, 0.5f));
    CHECK((in::image<float>(5, 5, 0.0f) | in::equalize{.levels = 5}) == in::image<float>(5, 5, 1.0f));
    CHECK((reference | in::match_binned(flat, 6)) == in::image<float>(30, 30, 0.4f));
    CHECK((in::image<float>() | in::equalize{}).empty());
    const in::image<float> none(2, 2, not_a_number);
    CHECK(std::isnan((none | in::equalize{})(1, 1)));
    CHECK(std::isnan((none | in::match_binned(reference))(0, 1)));
    CHECK(in::histogram_of(none).total() == 0);
    in::image<float> holes = reference;
    for (int i = 0; i < 30; ++i) holes(i, i) = not_a_number;
    CHECK(in::histogram_of(holes, 256).total() == 870);
    CHECK(in::histogram_of(holes, 77).total() == 870);
}
