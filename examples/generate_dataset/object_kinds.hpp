// The classes of targets that the generator models: the one list of their names.
#pragma once

#include <string>
#include <vector>

namespace generator {

/// A kind of object and its range of lengths in the recipe `sonar`, metres, sampled logarithmically.
struct object_kind {
    const char* name;
    double shortest, longest;
    bool is_primitive = false;  ///< a class of the recipe `published`, too
};
inline constexpr object_kind object_kinds[] = {
    {"ship", 5, 110},          {"plane", 7, 32},         {"truncated_cone", 0.6, 1.4}, {"wedge", 0.7, 1.3},
    {"tyre", 0.5, 1.8},        {"pipe", 3, 30},          {"boulder", 0.5, 5},          {"crate", 0.6, 6},
    {"lobster_pot", 0.6, 1.2}, {"cylinder", 1, 3, true}, {"cube", 0.4, 1.2, true},     {"cone", 0.5, 1.2, true},
    {"sphere", 0.4, 1.2, true}};

/// The kind of a name; null for an unknown one.
inline const object_kind* kind_named(const std::string& name) {
    for (const object_kind& k : object_kinds)
        if (name == k.name) return &k;
    return nullptr;
}

inline std::vector<std::string> kind_names() {
    std::vector<std::string> names;
    for (const object_kind& k : object_kinds) names.push_back(k.name);
    return names;
}

inline std::vector<std::string> primitive_names() {
    std::vector<std::string> names;
    for (const object_kind& k : object_kinds)
        if (k.is_primitive) names.push_back(k.name);
    return names;
}

}  // namespace generator
