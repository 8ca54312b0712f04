// The tree finds what looking at every box finds.
#include <insonify/core/dispatch.hpp>
#include <insonify/core/random.hpp>
#include <insonify/core/thread_pool.hpp>
#include <insonify/shadow/box_tree.hpp>

#include <set>

#include "../../catch.hpp"

namespace in = insonify;
namespace shadow = insonify::shadow;

namespace {

std::vector<shadow::topped_box> boxes(std::size_t count, double stretch) {
    in::random_sequence random(7);
    std::vector<shadow::topped_box> all;
    for (std::size_t i = 0; i < count; ++i) {
        const double u = random.uniform(-9, 9), v = random.uniform(-3, 3);
        const double w = stretch * random.uniform(0, 0.4), l = random.uniform(0, 0.4);
        all.push_back({shadow::rounded_down(u - w), shadow::rounded_up(u + w), shadow::rounded_down(v - l),
                       shadow::rounded_up(v + l), shadow::rounded_up(random.uniform()), static_cast<std::uint32_t>(i)});
    }
    return all;
}

/// Every pair of a box and a point that the tree asks about, in packets of as many points as there are lanes.
struct pairs {
    const shadow::box_tree& tree;
    const std::vector<shadow::point_range>& points;
    std::multiset<std::pair<std::uint32_t, std::size_t>>& found;

    template <int N>
    INSONIFY_INLINE void run() const {
        for (std::size_t first = 0; first + N <= points.size(); first += N)
            tree.find<N>(&points[first], (1u << N) - 1, [&](std::uint32_t name, int k) {
                found.insert({name, first + static_cast<std::size_t>(k)});
                return false;
            });
    }
};

}  // namespace

TEST_CASE("A float below and one above every double") {
    in::random_sequence random(1);
    for (int i = 0; i < 10000; ++i) {
        const double v = random.uniform(-1, 1) * std::pow(10.0, random.uniform(-60, 38));
        CHECK(static_cast<double>(shadow::rounded_down(v)) <= v);
        CHECK(static_cast<double>(shadow::rounded_up(v)) >= v);
    }
    CHECK(shadow::rounded_down(0) <= 0);
    CHECK(shadow::rounded_up(1) < 1.000001f);
}

TEST_CASE("Asked about are all boxes over a point and no others, each once") {
    in::serial_executor serial;
    in::thread_pool pool(3);
    for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 64u, 65u, 3000u})
        for (const double stretch : {1.0, 20.0}) {
            const std::vector<shadow::topped_box> all = boxes(count, stretch);
            in::random_sequence random(count + 1);
            std::vector<shadow::point_range> points;
            double u = 0, v = 0;
            for (int i = 0; i < 160; ++i) {
                if (i % 16 == 0) u = random.uniform(-10, 10), v = random.uniform(-4, 4);
                points.emplace_back(u += 0.05, v += 0.01, random.uniform(), 0);
            }
            std::multiset<std::pair<std::uint32_t, std::size_t>> expected;
            for (const shadow::topped_box& b : all)
                for (std::size_t k = 0; k < points.size(); ++k) {
                    const shadow::point_range& p = points[k];
                    if (b.u_low <= p.u_high && b.u_high >= p.u_low && b.v_low <= p.v_high && b.v_high >= p.v_low &&
                        b.top > p.above)
                        expected.insert({b.name, k});
                }
            CAPTURE(count, stretch);
            for (const in::isa level : {in::isa::scalar, in::isa::baseline, in::isa::avx2}) {
                std::multiset<std::pair<std::uint32_t, std::size_t>> one, other;
                in::detail::dispatch(pairs{shadow::box_tree(all, serial), points, one}, level);
                in::detail::dispatch(pairs{shadow::box_tree(all, pool), points, other}, level);
                CHECK((one == expected));
                CHECK((other == expected));
            }
        }
}

TEST_CASE("A point that is settled is asked about no more") {
    in::serial_executor serial;
    const shadow::box_tree tree({100, {-1, 1, -1, 1, 1, 5}}, serial);
    const shadow::point_range at[] = {{0, 0, 0, 0}};
    int asked = 0;
    const auto settle = [&](std::uint32_t name, int) {
        CHECK(name == 5);
        return ++asked == 3;
    };
    CHECK(tree.find<1>(at, 1, settle) == 1);
    CHECK(asked == 3);
    CHECK(tree.find<1>(at, 0, settle) == 0);

    // Of several points only the one that is settled.
    constexpr int count = INSONIFY_SIMD ? 4 : 1;
    const std::vector<shadow::point_range> several(count, shadow::point_range(0, 0, 0, 0));
    const auto settle_last = [&](std::uint32_t, int k) { return k == count - 1; };
    CHECK(tree.find<count>(several.data(), (1u << count) - 1, settle_last) == 1u << (count - 1));
}
