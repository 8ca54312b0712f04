// The sonar: blocks of pings, recorded on both sides.
#pragma once

#include <insonify/sonar/side_scan/record_options.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/side_scan/sonar_equation.hpp>
#include <insonify/sonar/side_scan/swath.hpp>
#include <insonify/sonar/speckle.hpp>

#include "field.hpp"
#include "options.hpp"

namespace survey {

/// Consecutive pings: gray values and labels, a row per ping, port to the left. Targets have their contact numbers.
struct block {
    std::span<const fix> pings;
    in::image<std::uint8_t> gray;
    in::labels labels;
};

class sonar {
  public:
    sonar(const options& o, double spacing)
        : rig_{.altitude = static_cast<float>(o.driving.altitude),
               .ping_spacing = static_cast<float>(spacing),
               .range = static_cast<float>(o.range),
               .bins = o.bins},
          beam_{static_cast<float>(in::numeric::to_radians(o.beam))},
          speckle_{.seed = o.seed} {}

    const in::side_scan& rig() const { return rig_; }
    /// Number of pings before and after a ping that its beam overlaps.
    int halo() const {
        return static_cast<int>(beam_.reach(static_cast<double>(rig_.range)) / static_cast<double>(rig_.ping_spacing));
    }

    /// Records `count` pings from the first + `before` on; the others only overlap the beam.
    block record_block(const sight& in_sight, std::span<const fix> pings, int before, int count, auto& ex) {
        const in::sonar_equation equation{
            in::spreading_loss{},      in::absorption{}, in::vertical_beam{.side_lobes = 0.01f}, beam_, in::pulse{},
            in::noise_floor{2.5e-13f}, in::level_gain{}};
        std::vector<in::ping> track;
        for (const fix& f : pings) track.push_back(f.at);
        const auto side = [&](in::side looks) {
            rig_.side = looks;
            auto recorded = in::record(in_sight.scene, std::span<const in::ping>(track), rig_,
                                       in::record_options<>{}.with(equation), ex);
            const auto cut = [&](auto& picture) {
                picture =
                    std::remove_reference_t<decltype(picture)>(picture.view().part(0, before, picture.width(), count));
            };
            cut(recorded.image);
            cut(recorded.labels.instance);
            cut(recorded.labels.shadow);
            cut(recorded.labels.seabed);
            recorded.image = in::with_speckle(recorded.image.view(), recorded.labels.seabed.view(), speckle_,
                                              {pings[static_cast<std::size_t>(before)].number, 1, looks}, ex);
            return recorded;
        };
        auto both = in::both_sides(side(in::side::port), side(in::side::starboard));
        const auto global = [&](std::uint16_t& i) {
            if (i != in::labels::by_seabed) i = in_sight.numbers[i];
        };
        for (std::uint16_t& i : both.labels.instance.pixels()) global(i);
        for (std::uint16_t& i : both.labels.shadow.pixels()) global(i);
        return {pings.subspan(static_cast<std::size_t>(before), static_cast<std::size_t>(count)),
                in::apply(in::apply(std::move(both.image), in::display{.white = 6}, ex), in::to_uint8, ex),
                std::move(both.labels)};
    }

  private:
    in::side_scan rig_;
    in::horizontal_beam beam_;
    in::seabed_speckle speckle_;
};

}  // namespace survey
