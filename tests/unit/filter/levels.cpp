// Kernels of filters give the same bytes at every instruction set, also for runs that do not fill the lanes.
#include <insonify/filter/echo_noise.hpp>
#include <insonify/filter/histogram.hpp>
#include <insonify/filter/noise.hpp>
#include <insonify/filter/poisson.hpp>

#include <cmath>
#include <vector>

#include "../../catch.hpp"

namespace in = insonify;
using namespace insonify::detail;

namespace {

using floats = std::vector<float>;
const noise_key key(3, noise_stream::gaussian, 2);

/// Dark and bright pixels, pixels out of range, and NaN.
floats pixels(int count) {
    floats result;
    for (int i = 0; i < count; ++i) result.push_back(static_cast<float>(i * 37 % 101) / 80.0f - 0.1f);
    if (count > 7) result[7] = std::nanf("");
    return result;
}

/// Bits, as NaN isn't equal to itself.
std::vector<std::uint32_t> bits(const floats& values) {
    std::vector<std::uint32_t> result;
    for (const float v : values) result.push_back(std::bit_cast<std::uint32_t>(v));
    return result;
}

template <class Rule>
floats by_rule(const Rule& rule, int count, in::isa level) {
    const floats from = pixels(count), draw = pixels(count + 3), scale(from.size(), 0.3f);
    floats to(from.size());
    dispatch(rule_kernel<Rule>{rule, from.data(), draw.data() + 3, scale.data(), to.data(), count}, level);
    return to;
}

template <class Draws>
floats by_draws(int count, in::isa level) {
    draw_buffer buffer;
    dispatch(draw_kernel<Draws>{buffer, count, {5, 6, 7, 8}, key.key}, level);
    return floats(buffer, buffer + count);
}

floats by_poisson(int count, float photons, in::isa level) {
    std::vector<double> mean, drawn(static_cast<std::size_t>(count));
    pixel_list list;
    for (int i = 0; i < count; ++i) {
        mean.push_back(static_cast<double>(photons) * (i * 37 % 101) / 100);
        add_if(true, i, list.indices, list.count);
    }
    dispatch(rejection_kernel<poisson_counts>{{}, mean.data(), drawn.data(), &list, {11, 13, count, 0}, key}, level);
    floats to;
    for (const double d : drawn) to.push_back(static_cast<float>(d));
    return to;
}

floats by_gamma(int count, double shape, in::isa level) {
    std::vector<double> shapes(static_cast<std::size_t>(count), shape), drawn(shapes.size());
    pixel_list list;
    for (int i = 0; i < count; ++i) add_if(true, i, list.indices, list.count);
    dispatch(rejection_kernel<gamma_rejection>{{}, shapes.data(), drawn.data(), &list, {1, 2, count, 0}, key}, level);
    floats to;
    for (const double d : drawn) to.push_back(static_cast<float>(d));
    return to;
}

floats by_taps(int count, bool across, in::isa level) {
    const auto taps = field_taps(2.7);
    const auto reach = static_cast<int>(taps.size()) - 1;
    const floats from = pixels(count + 2 * reach);
    floats to(static_cast<std::size_t>(count));
    if (across) {
        std::vector<const float*> rows;
        for (int k = 0; k <= 2 * reach; ++k) rows.push_back(from.data() + k);
        dispatch(taps_across_rows{taps, rows, to.data(), to.size()}, level);
    } else {
        dispatch(taps_along_row{taps, from.data() + reach, 1, to.data(), to.size()}, level);
    }
    return to;
}

template <class Fn>
void same_at_all_levels(const Fn& run) {
    for (const int count : {1, 2, 7, 8, 9, 31, 64, 509, in::run_length}) {
        const auto expected = bits(run(count, in::isa::scalar));
        for (const in::isa level : {in::isa::baseline, in::isa::avx2, in::isa::avx512})
            CHECK(bits(run(count, level)) == expected);
    }
}

}  // namespace

TEST_CASE("Kernels of filters give the same bytes at every instruction set") {
    using in::isa;
    same_at_all_levels([](int n, isa level) { return by_draws<normal_draws>(n, level); });
    same_at_all_levels([](int n, isa level) { return by_draws<symmetric_draws>(n, level); });
    same_at_all_levels([](int n, isa level) { return by_draws<unit_draws>(n, level); });
    same_at_all_levels([](int n, isa level) { return by_draws<exponential_draws>(n, level); });
    same_at_all_levels([](int n, isa level) { return by_rule(added_draw{0.1f}, n, level); });
    same_at_all_levels([](int n, isa level) { return by_rule(multiplied_draw{}, n, level); });
    same_at_all_levels([](int n, isa level) { return by_rule(struck_pixel{}, n, level); });
    same_at_all_levels([](int n, isa level) { return by_rule(echo_factor<in::echo::intensity>{}, n, level); });
    same_at_all_levels([](int n, isa level) { return by_rule(echo_factor<in::echo::amplitude>{}, n, level); });
    same_at_all_levels([](int n, isa level) { return by_taps(n, false, level); });
    same_at_all_levels([](int n, isa level) { return by_taps(n, true, level); });
    same_at_all_levels([](int n, isa level) { return by_poisson(n, 1, level); });
    same_at_all_levels([](int n, isa level) { return by_poisson(n, 255, level); });
    same_at_all_levels([](int n, isa level) { return by_poisson(n, 1e9, level); });
    same_at_all_levels([](int n, isa level) { return by_gamma(n, 0.3, level); });
    same_at_all_levels([](int n, isa level) { return by_gamma(n, 7, level); });
}

TEST_CASE("NaN is counted at every instruction set") {
    for (const in::isa level : {in::isa::scalar, in::isa::baseline, in::isa::avx2, in::isa::avx512}) {
        for (const int count : {1, 8, 50}) {
            int found = -1;
            floats values = pixels(count);
            if (count > 8) values.back() = std::nanf("");  // after the last whole vector
            dispatch(count_nan_kernel{values.data(), count, &found}, level);
            CHECK(found == (count > 8 ? 2 : count > 7 ? 1 : 0));
        }
    }
}

TEST_CASE("quantize_row() rounds as quantize() does, at every instruction set and next to all ties") {
    floats values{0, 1, -1, 2, std::nanf(""), 1e-30f, std::numeric_limits<float>::infinity()};
    for (int code = 0; code < 65536; ++code) {
        const float tie = static_cast<float>((code + 0.5) / (code % 2 == 0 ? 255 : 65535));
        for (const float v : {std::nextafter(tie, 0.0f), tie, std::nextafter(tie, 2.0f)}) values.push_back(v);
    }
    std::vector<std::uint8_t> narrow(values.size());
    std::vector<std::uint16_t> wide(values.size());
    for (const in::isa level : {in::isa::scalar, in::isa::baseline, in::isa::avx2, in::isa::avx512}) {
        in::quantize_row<std::uint8_t>(values, narrow, level);
        in::quantize_row<std::uint16_t>(values, wide, level);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < values.size(); ++i)
            wrong +=
                narrow[i] != in::quantize<std::uint8_t>(values[i]) || wide[i] != in::quantize<std::uint16_t>(values[i]);
        CHECK(wrong == 0);
    }
}
