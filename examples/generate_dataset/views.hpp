// Assigns target, aspect and seabed to each image. With a plan, each target is shown at every aspect on every seabed;
// without one, classes and seabeds take turns.
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "options.hpp"

namespace generator {

/// The class of `--mesh CLASS=FILE`.
inline std::string class_of(const std::string& mesh) {
    return mesh.substr(0, mesh.find('='));
}

/// The classes of a data set, in the order of their category numbers (from 1).
inline std::vector<std::string> class_names(const options& o) {
    std::vector<std::string> names = o.targets;
    for (const std::string& mesh : o.meshes) names.push_back(class_of(mesh));
    return names;
}

/// An item of `--per-class`.
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

/// The COCO categories, without `shadow`.
inline std::vector<std::string> category_names(const options& o) {
    std::vector<std::string> names = o.table ? o.table->classes() : o.is_sonar() ? o.targets : class_names(o);
    const auto add = [&](const std::string& name) {
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    };
    for (const char* const reserved : {"empty", "shadow"}) std::erase(names, reserved);
    for (const class_count& c : class_counts(o))
        if (c.name != "empty") add(c.name);
    if (o.is_sonar()) add("clutter");
    return names;
}

struct view_of_target {
    std::string class_name;        ///< empty: named by a line of the plan
    std::string seabed;            ///< empty: random, or named by a line of the plan
    std::string target_id;         ///< empty: no other image shows this target
    std::optional<double> aspect;  ///< degrees
};

/// Number of consecutive images that show the same target of a plan.
inline std::uint64_t views_of_each(const options& o) {
    if (!o.table || o.table->has_ids()) return 1;
    return (std::max<std::uint64_t>)(o.aspects.size(), 1) * (std::max<std::uint64_t>)(o.seabeds.size(), 1);
}

/// The id of the i-th image of a set.
inline std::uint64_t image_id(const options& o, std::uint64_t i) {
    return o.table && o.table->has_ids() ? o.table->id(static_cast<std::size_t>(i)) : i;
}

/// The line of the plan for the i-th image.
inline plan_row line_of_plan(const options& o, std::uint64_t i) {
    return o.table->row(static_cast<std::size_t>(i / views_of_each(o)));
}

/// The class of an image, and how many images of that class come before it.
struct class_turn {
    std::size_t class_index;
    std::uint64_t previous_images;
};
inline class_turn turn_at(const options& o, const std::vector<std::string>& classes, std::uint64_t i) {
    const std::vector<class_count> counts = class_counts(o);
    std::uint64_t total = 0;
    for (const class_count& c : counts) total += c.count;
    if (total == 0) return {static_cast<std::size_t>(i % classes.size()), i / classes.size()};
    std::uint64_t at = i % total;
    auto c = counts.begin();
    for (; at >= c->count; ++c) at -= c->count;
    const auto found = std::find(classes.begin(), classes.end(), c->name);
    return {static_cast<std::size_t>(found - classes.begin()), i / total * c->count + at};
}

/// The i-th image of the published recipe, or of a plan.
inline view_of_target view_of(const options& o, std::uint64_t i) {
    const std::uint64_t aspects = (std::max<std::uint64_t>)(o.aspects.size(), 1);
    const auto aspect = [&](std::uint64_t n) {
        return o.aspects.empty() ? std::nullopt : std::optional(o.aspects[static_cast<std::size_t>(n % aspects)]);
    };
    const std::uint64_t seabeds = (std::max<std::uint64_t>)(o.seabeds.size(), 1);
    const auto seabed = [&](std::uint64_t n) {
        return o.seabeds.empty() ? std::string() : o.seabeds[static_cast<std::size_t>(n % seabeds)];
    };
    const std::vector<std::string> classes = class_names(o);
    if (o.table && o.table->has_ids())
        return {"", seabed(turn_at(o, classes, image_id(o, i)).previous_images), "", std::nullopt};
    if (o.table) return {"", seabed(i / aspects), "", aspect(i)};
    const std::uint64_t scene = o.demo ? i % (classes.size() * seabeds) : i;
    const auto [class_index, previous] = turn_at(o, classes, scene);
    view_of_target v{classes[class_index], seabed(previous), "", aspect(previous / seabeds)};
    if (v.aspect) v.target_id = std::to_string(previous / (seabeds * aspects) * classes.size() + class_index + 1);
    return v;
}

/// The i-th image of the sonar recipe: empty ones are spread evenly, targets take turns among the others.
inline view_of_target view_of_sonar(const options& o, std::uint64_t i) {
    if (o.table) return view_of(o, i);
    if (!o.per_class.empty()) {
        std::vector<std::string> classes;
        for (const class_count& c : class_counts(o)) classes.push_back(c.name);
        return {classes[turn_at(o, classes, i).class_index], "", "", {}};
    }
    const auto empties = [&](std::uint64_t images) {
        return static_cast<std::uint64_t>(static_cast<double>(images) * o.empty);
    };
    if (empties(i + 1) > empties(i)) return {"empty", "", "", {}};
    return {o.targets[(i - empties(i)) % o.targets.size()], "", "", {}};
}

/// Ranges of a target's position in its image, as shares of the width from the left and of the height from below
/// (overhead) or from the first ping, the top row (side-scan).
struct placement_range {
    range across, along;
};
inline placement_range placement_range_of(const options& o) {
    if (o.place == "anywhere") return {{0.03, 0.97}, {0.03, 0.97}};
    // Leaves room for the long shadow on the right.
    if (o.place == "third" || !o.is_sonar()) return {{0.28, 0.38}, {0.42, 0.58}};
    return {{0.28, 0.6}, {0.34, 0.66}};
}

/// Hashes a target's id (FNV-1a): its random numbers do not depend on other lines of the plan.
inline std::uint64_t target_key(const std::string& id) {
    std::uint64_t key = 0xCBF29CE484222325u;
    for (const char c : id) key = (key ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
    return key;
}

}  // namespace generator
