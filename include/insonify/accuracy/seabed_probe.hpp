// Measures the errors of pictures of a seabed on a few small ones.
//
// The ground truth is a picture of a grid of `probe.finest` cells per pixel, with exact shadows in place of maps.
#pragma once

#include <insonify/accuracy/metrics.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/sonar/overhead/render.hpp>

#include <array>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace accuracy {

/// Errors of a picture; as a budget, tolerated errors.
struct errors {
    double shadow_edge = 1;   ///< mean displacement of shadow edges, pixels
    double silhouette = 1;    ///< largest displacement of the targets' outlines, pixels
    double height = 1;        ///< of the seabed, rms, in pixels on the ground
    double intensity = 0.05;  ///< of the linear picture, rms
};

/// The small pictures that `settings_for` draws.
struct probe {
    int chips = 4;     ///< their number, distributed over the large picture
    int pixels = 128;  ///< along a side
    /// Cells per pixel of the ground truth, and the largest that settings may have; grids of more than half of it are
    /// compared with a truth of twice as many.
    double finest = 4;
    double usable_fraction = 0.7;  ///< of the budget that they may use; the rest is for other parts of the seabed
};

}  // namespace accuracy

namespace detail::inline INSONIFY_FLAGS {

/// Small pictures of a seabed with their ground truth.
class seabed_probe {
  public:
    /// @param shadow  of the ground truth
    template <class Shadow, executor E>
    seabed_probe(const seabed::any& bottom, const overhead& rig, const accuracy::probe& how, const Shadow& shadow,
                 E& ex)
        : how_(how) {
        scene_.seabed = bottom;
        const overhead_geometry view(rig);
        pixels_ = (std::min)(how.pixels, (std::min)(rig.size.x, rig.size.y));
        pixel_ = view.ground_sampling();
        // A low-discrepancy sequence in the unit square.
        // Martin Roberts. The Unreasonable Effectiveness of Quasirandom Sequences. 2018.
        for (int i = 0; i < how.chips; ++i) {
            const auto place = [&](double step, int size) {
                const double turn = 0.5 + step * i;
                const double share = turn - static_cast<double>(numeric::floor_to_int(turn));
                return (share - 0.5) * (1 - static_cast<double>(pixels_) / size);
            };
            const glm::dvec2 in_picture(place(0.7548776662466927, rig.size.x) * 2 * view.half_extent(0).x,
                                        place(0.5698402909980532, rig.size.y) * 2 * view.half_extent(0).y);
            overhead chip = rig;
            chip.position += view.along_world(in_picture);
            if (view.has_point_light()) {  // the light keeps its position in the world
                const glm::dvec3 light = view.light_position() - glm::dvec3(in_picture, 0);
                const double level = numeric::length(glm::dvec2(light));
                chip.light_distance = static_cast<float>(numeric::square_root(level * level + light.z * light.z));
                chip.grazing = (std::max)(static_cast<float>(numeric::atan2(light.z, level)), 1e-9f);
                chip.light_azimuth = static_cast<float>(numeric::atan2(-light.y, -light.x));
            }
            chip.size = {pixels_, pixels_};
            const double half = view.half_extent(0).x * pixels_ / rig.size.x;
            chip.field_of_view = static_cast<float>(2 * numeric::atan2(half, static_cast<double>(rig.altitude)));
            chips_.push_back(chip);
            truths_.push_back(render_chip(chip, how.finest, shadow, ex));
        }
    }

    /// Errors of pictures with so many cells per pixel, over all chips.
    template <class Shadow, executor E>
    accuracy::errors errors_of(double cells_per_pixel, const Shadow& shadow, E& ex) const {
        accuracy::mask_difference edges;
        double squares = 0, pixels = 0, heights = 0;
        for (std::size_t i = 0; i < chips_.size(); ++i) {
            const auto result = render_chip(chips_[i], cells_per_pixel, shadow, ex);
            edges += accuracy::compare_masks(result.dark, truths_[i].dark);
            const auto difference = accuracy::compare_images(result.values, truths_[i].values);
            squares += difference.mean_square * static_cast<double>(difference.pixels);
            pixels += static_cast<double>(difference.pixels);
            heights += mean_square_height_error(chips_[i], cells_per_pixel) / static_cast<double>(chips_.size());
        }
        accuracy::errors all{.shadow_edge = 0, .silhouette = 0};
        // A lower bound of the boundary, for chips without shadow edges.
        const auto wrong = static_cast<double>(edges.wrong_pixels());
        const auto few = static_cast<double>(pixels_) / 16;
        all.shadow_edge = wrong / (std::max)(static_cast<double>(edges.boundary_pixels), few);
        all.intensity = numeric::square_root(squares / pixels);
        all.height = numeric::square_root(heights) / pixel_;
        return all;
    }

  private:
    struct picture {
        image<float> values;
        image<std::uint8_t> dark;
    };

    template <class Shadow, executor E>
    picture render_chip(const overhead& chip, double cells_per_pixel, const Shadow& shadow, E& ex) const {
        const render_options<Shadow> options{.shadow = shadow,
                                             .cell = overhead_geometry(chip).ground_sampling() / cells_per_pixel};
        auto drawn = render(scene_, chip, options, ex);
        return {std::move(drawn.image), map_pixels(drawn.labels.shadow, [](std::uint16_t by) {
                    return static_cast<std::uint8_t>(by != labels::no_shadow);
                })};
    }

    /// Mean square difference of height, square metres, between a grid and the seabed band-limited as on the finest
    /// grid, over a lattice of points.
    double mean_square_height_error(const overhead& chip, double cells_per_pixel) const {
        constexpr int net = 24;
        const double side = 2 * overhead_geometry(chip).half_extent(0).x;
        const glm::dvec2 low = chip.position - 0.5 * side;
        const double spacing = pixel_ / cells_per_pixel;
        seabed::grid coarse = seabed::grid_over(low, low + side, spacing);
        coarse.band_limited = true;
        const seabed::heightfield field = seabed::sample(scene_.seabed, coarse);
        const auto prepared = scene_.seabed.prepare();
        double sum = 0;
        int known = 0;
        for (int j = 0; j < net; ++j) {
            std::array<float, net> heights;
            const seabed::scanline line{.y = low.y + side * (j + 0.5) / net,
                                        .origin = low.x + side * 0.5 / net,
                                        .spacing = side / net,
                                        .grid_spacing = pixel_ / how_.finest};
            prepared.row(line, heights, {});
            for (std::size_t i = 0; i < heights.size(); ++i) {
                const double difference =
                    static_cast<double>(heights[i]) - static_cast<double>(field.height_at(line.x(i), line.y));
                if (!numeric::is_finite(difference)) continue;
                sum += difference * difference;
                ++known;
            }
        }
        return known > 0 ? sum / known : 0;
    }

    accuracy::probe how_;
    scene scene_;
    int pixels_ = 0;
    double pixel_ = 1;  ///< of the picture on the ground, metres
    std::vector<overhead> chips_;
    std::vector<picture> truths_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
