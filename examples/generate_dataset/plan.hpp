// What image i shows: every parameter, drawn from the seed and i alone.
#pragma once

#include <insonify/core/random.hpp>

#include <algorithm>
#include <string>

#include "options.hpp"

namespace generator {

struct plan {
    std::uint64_t index;
    std::string class_name, seabed;
    bool referenced;
    std::size_t reference;  ///< which of the references, if any

    double size, aspect, yaw, pitch, roll, burial;  ///< metres, -, radians, share of the height
    double altitude, grazing, rig_yaw;              ///< metres, radians
    double offset_x, offset_y;                      ///< of the target, in half pictures from the middle
    double place_x, place_y;                        ///< of the rig in the world, metres
    std::uint64_t seabed_seed, noise_seed;
    double relief, wavelength, direction;  ///< of the seabed: in [0, 1], metres, radians
    double distance, beam;                 ///< of the target from a sonar's track, altitudes; radians
    bool port;                             ///< which side of a sonar's track it is on
    double third, halfway;                 ///< where a chip has the target, in chips from its left and lower edges
    double noise, white;                   ///< of a sonar: what is heard in a shadow, and what is shown as white
};

/// The classes of a data set, in the order of their category numbers (from 1).
inline std::vector<std::string> class_names(const options& o) {
    std::vector<std::string> names = o.targets;
    for (const std::string& mesh : o.meshes) names.push_back(mesh.substr(0, mesh.find('=')));
    return names;
}

/// A class and how many images of it, of `--per-class`.
struct class_count {
    std::string name;
    std::uint64_t count;
};
inline std::vector<class_count> class_counts(const options& o) {
    std::vector<class_count> counts;
    for (const std::string& text : o.per_class) {
        const std::size_t equals = text.find('=');
        counts.push_back({text.substr(0, equals), std::stoull(text.substr(equals + 1))});
    }
    return counts;
}

/// What COCO's categories are, but for shadows.
inline std::vector<std::string> category_names(const options& o) {
    if (!o.is_sonar()) return class_names(o);
    std::vector<std::string> names = o.targets;
    for (const class_count& c : class_counts(o))
        if (c.name != "empty" && std::find(names.begin(), names.end(), c.name) == names.end()) names.push_back(c.name);
    names.push_back("clutter");
    return names;
}

/// Which class an image of the sonar recipe is of: empty ones are spread evenly, targets take turns among the others.
inline std::string class_of_image(const options& o, std::uint64_t index) {
    const std::vector<class_count> counts = class_counts(o);
    std::uint64_t total = 0;
    for (const class_count& c : counts) total += c.count;
    if (total > 0) {
        std::uint64_t at = index % total;
        for (const class_count& c : counts) {
            if (at < c.count) return c.name;
            at -= c.count;
        }
    }
    const auto empties = [&](std::uint64_t images) {
        return static_cast<std::uint64_t>(static_cast<double>(images) * o.empty);
    };
    if (empties(index + 1) > empties(index)) return "empty";
    return o.targets[(index - empties(index)) % o.targets.size()];
}

/// Classes and seabeds take turns, so that every run of targets x seabeds images is balanced; the rest is random.
/// The demonstration shows the same scenes twice: as they are, and with the look of a reference.
inline plan plan_image(const options& o, std::uint64_t index, std::size_t references) {
    const std::vector<std::string> classes = class_names(o);
    const std::uint64_t scenes = classes.size() * o.seabeds.size();
    const std::uint64_t scene = o.demo ? index % scenes : index;

    insonify::random_sequence random(o.seed, 1, scene);
    const auto from = [&](const range& r) { return random.uniform(r.low, r.high); };
    const auto radians = [](double degrees) { return insonify::numeric::to_radians(degrees); };
    const double full_turn = 2 * insonify::numeric::pi;
    plan p{};
    p.index = index;
    p.class_name = classes[scene % classes.size()];
    p.seabed = o.seabeds[scene / classes.size() % o.seabeds.size()];
    p.referenced = references > 0 && (!o.demo || index >= scenes);
    p.reference = references > 0 ? random.below(static_cast<std::uint32_t>(references)) : 0;
    p.size = from(o.target_size);
    p.aspect = from(o.aspect);
    p.yaw = random.uniform(0, full_turn);
    p.pitch = radians(from(o.tilt));
    p.roll = radians(from(o.tilt));
    p.burial = from(o.burial);
    p.altitude = from(o.altitude);
    p.grazing = radians(from(o.grazing));
    p.rig_yaw = random.uniform(0, full_turn);
    // Left of the middle, so that the long shadow has room to the right.
    p.offset_x = random.uniform(-0.4, -0.2);
    p.offset_y = random.uniform(-0.2, 0.2);
    p.place_x = random.uniform(-500, 500);
    p.place_y = random.uniform(-500, 500);
    p.seabed_seed = random.word();
    p.noise_seed = random.word();
    p.relief = random.uniform();
    p.wavelength = random.uniform(0.5, 1.1);
    p.direction = random.uniform(0, full_turn);
    p.distance = from(o.distance);
    p.beam = radians(from(o.beam));
    p.port = random.uniform() < 0.5;
    p.third = random.uniform(0.28, 0.38);
    p.halfway = random.uniform(0.42, 0.58);
    p.noise = random.uniform(0.003, 0.03);
    p.white = random.uniform(4, 12);
    return p;
}

}  // namespace generator
