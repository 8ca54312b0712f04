// Ground truth per pixel: target instances, seabed labels, and shadows with their casters.
#pragma once

#include <insonify/core/detail/filled.hpp>
#include <insonify/sonar/scene.hpp>

#include <algorithm>
#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A rectangle of pixels: left, top, width and height, as COCO writes boxes.
struct label_box {
    int x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const label_box&, const label_box&) = default;
};

/// One target, as a picture shows it. Boxes are empty and areas 0 where nothing of it is in the picture.
struct target_label {
    std::string class_name;
    std::uint16_t instance = 0;  ///< as in labels::instance
    pose placement;
    label_box box;          ///< around its visible pixels
    label_box shadow_box;   ///< around the pixels of the bottom that it keeps dark
    std::int64_t area = 0;  ///< visible pixels
    std::int64_t shadow_area = 0;
};

/// One value per pixel of the picture, each image as large as the picture.
struct labels {
    static constexpr std::uint16_t no_instance = 0;     ///< bottom, or nothing at all
    static constexpr std::uint16_t is_lit = 0;          ///< at least half of the light arrives
    static constexpr std::uint16_t by_seabed = 0xFFFF;  ///< dark by the bottom itself
    static constexpr std::uint8_t no_seabed = 0xFF;     ///< a target, or nothing at all

    image<std::uint16_t> instance;  ///< 1 for the scene's first target, 2 for the second, ...
    image<std::uint16_t> shadow;    ///< is_lit, by_seabed, or the instance that casts the shadow
    image<std::uint8_t> seabed;     ///< a seabed::type, or no_seabed
    std::vector<target_label> targets;
    std::vector<insonify::seabed::type_properties> legend;  ///< what the values of `seabed` mean

    labels() = default;
    template <executor_argument Executor = serial_executor>
    INSONIFY_MEMBER labels(int width, int height, Executor&& ex = serial_executor{})
        : instance(detail::filled(width, height, no_instance, ex)),
          shadow(detail::filled(width, height, is_lit, ex)),
          seabed(detail::filled(width, height, no_seabed, ex)) {}
};

/// Asks for no labels: none are stored or computed.
struct no_labels {};

inline namespace INSONIFY_FLAGS {

/// 255 where a target is visible, 0 elsewhere.
inline image<std::uint8_t> target_mask(const labels& l, std::uint16_t instance) {
    return map_pixels(l.instance, [=](std::uint16_t i) { return static_cast<std::uint8_t>(i == instance ? 255 : 0); });
}

/// 255 where a target keeps the bottom dark, 0 elsewhere (on the target's own dark side too).
inline image<std::uint8_t> shadow_mask(const labels& l, std::uint16_t instance) {
    image<std::uint8_t> mask(l.shadow.width(), l.shadow.height());
    for (std::size_t i = 0; i < mask.size(); ++i)
        mask.pixels()[i] = l.shadow.pixels()[i] == instance && l.instance.pixels()[i] == labels::no_instance ? 255 : 0;
    return mask;
}

}  // namespace INSONIFY_FLAGS

/// The class of every pixel.
struct class_map {
    std::vector<std::string> names;  ///< each once, in the order in which the targets bring them
    image<std::uint16_t> classes;    ///< 0 for no target, 1 for names[0], ...
};

inline namespace INSONIFY_FLAGS {

inline class_map classes_of(const labels& l) {
    class_map map;
    std::vector<std::uint16_t> class_of{0};  // by instance
    for (const target_label& t : l.targets) {
        const auto known = std::find(map.names.begin(), map.names.end(), t.class_name);
        class_of.push_back(static_cast<std::uint16_t>(known - map.names.begin() + 1));
        if (known == map.names.end()) map.names.push_back(t.class_name);
    }
    map.classes = map_pixels(l.instance, [&](std::uint16_t instance) { return class_of[instance]; });
    return map;
}

}  // namespace INSONIFY_FLAGS

inline namespace INSONIFY_ONCE {

/// Fills in labels::targets from the images.
INSONIFY_FUNCTION void describe_targets(labels& l, const std::vector<target>& targets);

#if INSONIFY_BODIES
INSONIFY_FUNCTION void describe_targets(labels& l, const std::vector<target>& targets) {
    struct extent {
        int x0 = (std::numeric_limits<int>::max)(), y0 = x0, x1 = -1, y1 = -1;
        std::int64_t area = 0;
        void include(int x, int y) {
            x0 = (std::min)(x0, x), y0 = (std::min)(y0, y);
            x1 = (std::max)(x1, x), y1 = (std::max)(y1, y);
            ++area;
        }
        label_box box() const { return area == 0 ? label_box{} : label_box{x0, y0, x1 - x0 + 1, y1 - y0 + 1}; }
    };
    std::vector<extent> visible(targets.size() + 1), dark(targets.size() + 1);
    for (int y = 0; y < l.instance.height(); ++y) {
        const auto instances = l.instance.row(y);
        const auto shadows = l.shadow.row(y);
        for (int x = 0; x < l.instance.width(); ++x) {
            const std::uint16_t instance = instances[static_cast<std::size_t>(x)];
            const std::uint16_t shadow = shadows[static_cast<std::size_t>(x)];
            if (instance != labels::no_instance)
                visible[instance].include(x, y);
            else if (shadow != labels::is_lit && shadow != labels::by_seabed)
                dark[shadow].include(x, y);
        }
    }
    l.targets.clear();
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const extent &seen = visible[i + 1], &shaded = dark[i + 1];
        l.targets.push_back({targets[i].class_name, static_cast<std::uint16_t>(i + 1), targets[i].placement, seen.box(),
                             shaded.box(), seen.area, shaded.area});
    }
}
#endif

}  // namespace INSONIFY_ONCE
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
