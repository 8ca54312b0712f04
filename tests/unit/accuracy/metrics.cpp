// Metrics of masks and images, against hand counts and closed forms.
#include <insonify/accuracy/metrics.hpp>
#include <insonify/core/image.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

#include "../../catch.hpp"

namespace in = insonify;
namespace accuracy = insonify::accuracy;
using mask = in::image<std::uint8_t>;

namespace {

mask rectangle(int width, int height, int x0, int y0, int x1, int y1) {
    mask out(width, height);
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) out(x, y) = 255;
    }
    return out;
}
constexpr double inf = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("Masks are compared by their intersection over union, false positives and false negatives") {
    const mask truth = rectangle(20, 20, 5, 5, 15, 15), shifted = rectangle(20, 20, 6, 5, 16, 15);
    const auto d = accuracy::compare_masks(shifted, truth);
    CHECK(d.true_positives == 90);
    CHECK(d.false_positives == 10);
    CHECK(d.false_negatives == 10);
    CHECK(d.intersection_over_union() == Approx(90.0 / 110));
    CHECK(d.boundary_pixels == 36);
    CHECK(d.mean_boundary_displacement() == Approx(20.0 / 36));

    const auto reversed = accuracy::compare_masks(truth, rectangle(20, 20, 5, 5, 15, 14));
    CHECK(reversed.false_positives == 10);
    CHECK(reversed.false_negatives == 0);
}

TEST_CASE("Growing a mask by a pixel displaces its boundary by about one pixel") {
    const auto d =
        accuracy::compare_masks(rectangle(400, 400, 99, 99, 301, 301), rectangle(400, 400, 100, 100, 300, 300));
    CHECK(d.mean_boundary_displacement() == Approx(1).epsilon(0.02));
}

TEST_CASE("Empty and full masks have an intersection over union of one with themselves and no boundary") {
    const mask none(8, 4), all(8, 4, 1);
    CHECK(accuracy::compare_masks(none, none).intersection_over_union() == 1);
    CHECK(accuracy::compare_masks(none, none).mean_boundary_displacement() == 0);
    CHECK(accuracy::compare_masks(all, all).intersection_over_union() == 1);
    CHECK(accuracy::compare_masks(all, all).boundary_pixels == 0);
    CHECK(accuracy::compare_masks(all, none).intersection_over_union() == 0);
    CHECK(accuracy::compare_masks(all, none).mean_boundary_displacement() == inf);
    CHECK(accuracy::compare_masks(mask(), mask()).intersection_over_union() == 1);
}

TEST_CASE("Any value but zero is in the mask; strided views are compared by their pixels") {
    const mask a{{0, 1, 9}, {0, 2, 9}}, b{{0, 255}, {0, 7}};
    CHECK(accuracy::compare_masks(a.view().part(0, 0, 2, 2), b).intersection_over_union() == 1);
    CHECK(accuracy::compare_masks(a.view().part(0, 0, 2, 2), b).boundary_pixels == 2);
}

TEST_CASE("Images are compared by root mean square, largest difference, and peak signal-to-noise ratio") {
    const in::image<float> truth{{0.0f, 0.5f}, {1.0f, 0.25f}}, result{{0.0f, 0.5f}, {0.0f, 0.25f}};
    const auto d = accuracy::compare_images(result, truth);
    CHECK(d.pixels == 4);
    CHECK(d.mean_square == 0.25);
    CHECK(d.rmse() == 0.5);
    CHECK(d.largest == 1);
    CHECK(d.psnr(1) == Approx(20 * std::log10(2.0)).epsilon(1e-14));

    // A uniform error of one grey level: the textbook 48.13 dB.
    const auto bytes = accuracy::compare_images(mask(16, 16, 100), mask(16, 16, 101));
    CHECK(bytes.psnr(255) == Approx(48.1308).epsilon(1e-6));
    CHECK(bytes.largest == 1);
}

TEST_CASE("Equal images have no error and an infinite signal-to-noise ratio") {
    const in::image<float> m(3, 3, 0.1f);
    CHECK(accuracy::compare_images(m, m).rmse() == 0);
    CHECK(accuracy::compare_images(m, m).largest == 0);
    CHECK(accuracy::compare_images(m, m).psnr(1) == inf);
    CHECK(accuracy::compare_images(in::image<float>(), in::image<float>()).rmse() == 0);
    CHECK_THROWS_AS(accuracy::compare_images(m, m).psnr(0), in::invalid_input);
    CHECK_THROWS_AS(accuracy::compare_images(m, m).psnr(inf), in::invalid_input);
}

TEST_CASE("One NaN pixel makes every figure NaN") {
    const in::image<float> truth(50, 50, 0.5f);
    in::image<float> broken = truth;
    broken(10, 10) = std::numeric_limits<float>::quiet_NaN();
    broken(40, 40) = 0;
    const auto d = accuracy::compare_images(broken, truth);
    CHECK(std::isnan(d.rmse()));
    CHECK(std::isnan(d.largest));
    CHECK(std::isnan(d.psnr(1)));
    in::image<float> infinite = truth;
    infinite(1, 1) = std::numeric_limits<float>::infinity();
    CHECK(accuracy::compare_images(infinite, truth).largest == inf);
    CHECK(accuracy::compare_images(infinite, infinite).largest == 0);
}

TEST_CASE("Images of different sizes are refused") {
    CHECK_THROWS_AS(accuracy::compare_masks(mask(2, 3), mask(3, 2)), in::invalid_input);
    CHECK_THROWS_AS(accuracy::compare_images(mask(2, 3), mask(2, 2)), in::invalid_input);
    CHECK_THROWS_AS(accuracy::compare_images(in::image<float>(2, 3), in::image<float>(1, 3)), in::invalid_input);
}
