// Ground truth per pixel: target instances, seabed labels, and shadows with their casters.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/detail/filled.hpp>
#include <insonify/core/rect.hpp>
#include <insonify/sonar/scene.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// One target, as a picture shows it. Bounding boxes are empty and areas 0 if it is not visible.
struct target_label {
    std::string class_name;
    std::uint16_t instance = 0;  ///< as in labels::instance
    pose placement;
    rect box;                      ///< bounding box of its visible pixels
    rect shadow_box;               ///< bounding box of the seabed's pixels whose `shadow` is its instance
    std::int64_t area = 0;         ///< visible pixels
    std::int64_t shadow_area = 0;  ///< the number of these pixels
};

/// One value per pixel of the picture in each image, and a list of the targets.
struct labels {
    static constexpr std::uint16_t no_instance = 0;     ///< seabed, or neither seabed nor target
    static constexpr std::uint16_t no_shadow = 0;       ///< at least half of the light, or that of its centre, arrives
    static constexpr std::uint16_t by_seabed = 0xFFFF;  ///< in the shadow of the seabed
    static constexpr std::uint8_t no_seabed = 0xFF;     ///< a target, or neither

    image<std::uint16_t> instance;  ///< 1 for the scene's first target, 2 for the second, ...
    /// no_shadow, by_seabed, or the instance that casts the shadow; of several, overhead, the first in the scene.
    image<std::uint16_t> shadow;
    image<std::uint8_t> seabed;  ///< a seabed::type, or no_seabed
    std::vector<target_label> targets;
    std::vector<insonify::seabed::type_properties> legend;  ///< of the values of `seabed`

    /// The label of a caster in `shadow`. Targets are the first casters.
    INSONIFY_MEMBER static std::uint16_t of_caster(std::size_t caster, std::size_t targets) {
        return caster < targets ? static_cast<std::uint16_t>(caster + 1) : by_seabed;
    }

    labels() = default;
    template <executor_argument Executor = serial_executor>
    INSONIFY_MEMBER labels(int width, int height, Executor&& ex = serial_executor{})
        : instance(detail::filled(width, height, no_instance, ex)),
          shadow(detail::filled(width, height, no_shadow, ex)),
          seabed(detail::filled(width, height, no_seabed, ex)) {}
    /// Lists the scene's targets and legend; no pixel is labelled yet.
    template <executor_argument Executor = serial_executor>
    INSONIFY_TAGGED labels(const scene& s, int width, int height, Executor&& ex = serial_executor{})
        : labels(width, height, ex) {
        legend = s.seabed.legend();
        for (std::size_t i = 0; i < s.targets.size(); ++i)
            targets.push_back(
                {s.targets[i].class_name, static_cast<std::uint16_t>(i + 1), s.targets[i].placement, {}, {}});
    }
};

namespace detail::inline INSONIFY_FLAGS {

/// @throws invalid_input for more targets than labels can number
inline void require_numbered_targets(const scene& s) {
    require(s.targets.size() < labels::by_seabed, "scene.targets.size()", s.targets.size(), "below 65535");
}

/// @throws invalid_input for an image of another size
inline void require_sizes(const labels& l, int width, int height, std::string_view expected) {
    const auto check = [&](const char* name, const auto& of) {
        require(of.width() == width && of.height() == height, name, of.size(), expected);
    };
    check("labels.instance.size()", l.instance);
    check("labels.shadow.size()", l.shadow);
    check("labels.seabed.size()", l.seabed);
}

/// @throws invalid_input for an instance that has no target
inline void require_listed(const labels& l, const char* name, std::uint16_t instance) {
    require(instance <= l.targets.size(), name, instance, "at most labels.targets.size()");
}

}  // namespace detail::inline INSONIFY_FLAGS

/// Requests no labels: none are stored or computed.
struct no_labels {};

/// The class of every pixel.
struct class_map {
    std::vector<std::string> names;  ///< each once, in the order of the targets
    image<std::uint16_t> classes;    ///< 0 for no target, 1 for names[0], ...
};

inline namespace INSONIFY_ONCE {

/// 255 where a target is visible, 0 elsewhere.
/// @param instance  number of the target, from 1; 0 gives the pixels that show none
INSONIFY_FUNCTION image<std::uint8_t> target_mask(const labels& l, std::uint16_t instance);

/// 255 where the seabed is in a target's shadow, 0 elsewhere, on the target itself too.
/// @param instance  number of the target, from 1; 0 gives the seabed that is lit
/// @throws invalid_input for images of different sizes
INSONIFY_FUNCTION image<std::uint8_t> shadow_mask(const labels& l, std::uint16_t instance);

/// The class of every pixel that shows a target.
/// @throws invalid_input for an instance that is not listed
INSONIFY_FUNCTION class_map classes_of(const labels& l);

/// Sets the bounding boxes and areas of the listed targets from the images.
/// @throws invalid_input for an instance that is not listed, or images of different sizes
INSONIFY_FUNCTION void measure_targets(labels& l);

#if INSONIFY_BODIES
INSONIFY_FUNCTION image<std::uint8_t> target_mask(const labels& l, std::uint16_t instance) {
    return map_pixels(l.instance, [=](std::uint16_t i) { return static_cast<std::uint8_t>(i == instance ? 255 : 0); });
}

INSONIFY_FUNCTION image<std::uint8_t> shadow_mask(const labels& l, std::uint16_t instance) {
    detail::require_sizes(l, l.shadow.width(), l.shadow.height(), "that of labels.shadow");
    image<std::uint8_t> mask(l.shadow.width(), l.shadow.height());
    const auto is_shown = [&](std::size_t i) {
        if (l.instance.pixels()[i] != labels::no_instance || l.shadow.pixels()[i] != instance) return false;
        return instance != labels::no_shadow || l.seabed.pixels()[i] != labels::no_seabed;
    };
    for (std::size_t i = 0; i < mask.size(); ++i) mask.pixels()[i] = is_shown(i) ? 255 : 0;
    return mask;
}

INSONIFY_FUNCTION class_map classes_of(const labels& l) {
    class_map map;
    detail::dynamic_array<std::uint16_t> class_of{0};  // by instance
    for (const target_label& t : l.targets) {
        const auto known = std::find(map.names.begin(), map.names.end(), t.class_name);
        class_of.push_back(static_cast<std::uint16_t>(known - map.names.begin() + 1));
        if (known == map.names.end()) map.names.push_back(t.class_name);
    }
    map.classes = map_pixels(l.instance, [&](std::uint16_t instance) {
        detail::require_listed(l, "labels.instance", instance);
        return class_of[instance];
    });
    return map;
}

INSONIFY_FUNCTION void measure_targets(labels& l) {
    const auto include = [](rect& box, std::int64_t& area, int x, int y) {
        if (area++ == 0) box = {x, y, x, y};
        box = {(std::min)(box.x0, x), (std::min)(box.y0, y), (std::max)(box.x1, x + 1), (std::max)(box.y1, y + 1)};
    };
    detail::require_sizes(l, l.instance.width(), l.instance.height(), "that of labels.instance");
    for (target_label& t : l.targets) t.area = t.shadow_area = 0, t.box = t.shadow_box = {};
    for (int y = 0; y < l.instance.height(); ++y) {
        const auto instances = l.instance.row(y), shadows = l.shadow.row(y);
        for (int x = 0; x < l.instance.width(); ++x) {
            const std::uint16_t instance = instances[static_cast<std::size_t>(x)],
                                shadow = shadows[static_cast<std::size_t>(x)];
            if (instance != labels::no_instance) {
                detail::require_listed(l, "labels.instance", instance);
                target_label& t = l.targets[instance - 1u];
                include(t.box, t.area, x, y);
            } else if (shadow != labels::no_shadow && shadow != labels::by_seabed) {
                detail::require_listed(l, "labels.shadow", shadow);
                target_label& t = l.targets[shadow - 1u];
                include(t.shadow_box, t.shadow_area, x, y);
            }
        }
    }
}
#endif

}  // namespace INSONIFY_ONCE

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
