// Strict parsers of option values. Errors name the option, the value and the expected form.
#pragma once

#include <cmath>
#include <set>
#include <string>

#include "../common/option_values.hpp"
#include "../common/parse.hpp"
#include "views.hpp"

namespace generator {

using examples::number, examples::whole_number;

/// Parses `low:high`, or one number.
inline range parse_range(const std::string& name, const std::string& text) {
    const auto number = [&](const std::string& part) {
        double value = 0;
        if (!examples::parse(part, value) || !std::isfinite(value))
            throw CLI::ValidationError(name, "'" + text + "' is neither a number nor a range low:high");
        return value;
    };
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return {number(text), number(text)};
    const range r{number(text.substr(0, colon)), number(text.substr(colon + 1))};
    if (!(r.low <= r.high)) throw CLI::ValidationError(name, "'" + text + "': low is above high");
    return r;
}

inline noise_step parse_noise(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    const double usual = kind == "speckle" ? 0.05 : kind == "gaussian" ? 0.01 : kind == "poisson" ? 255 : -1;
    if ((kind == "rayleigh" || kind == "seabed") && colon == std::string::npos) return {kind, 0};
    if (usual < 0)
        throw CLI::ValidationError("--noise", "'" + text +
                                                  "' is not one of none, speckle:VARIANCE, gaussian:VARIANCE, "
                                                  "poisson:PHOTONS, rayleigh, seabed");
    if (colon == std::string::npos) return {kind, usual};
    double strength = 0;
    if (!examples::parse(std::string_view(text).substr(colon + 1), strength) || !(strength > 0 && strength <= 1e9))
        throw CLI::ValidationError("--noise", "'" + text + "': the strength must be one number above 0, at most 1e9");
    return {kind, strength};
}

/// Checks class names: each names a folder and a category, so it must be unique and plain.
inline void check_classes(const options& o) {
    const auto lower = [](std::string text) {
        for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        return text;
    };
    std::vector<std::string> taken = primitive_names();
    taken.insert(taken.end(), {"empty", "shadow"});
    for (std::size_t i = 0; i < o.targets.size(); ++i)
        if (std::count(o.targets.begin(), o.targets.end(), o.targets[i]) > 1)
            throw CLI::ValidationError("--targets", "'" + o.targets[i] + "' appears twice; name each class once");
    for (const std::string& mesh : o.meshes) {
        const std::string name = class_of(mesh);
        const bool plain = name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
                           std::string::npos;
        if (mesh.find('=') == std::string::npos || name.empty() || mesh.back() == '=' || !plain || name[0] == '-' ||
            name.size() > 64)
            throw CLI::ValidationError("--mesh", "'" + mesh +
                                                     "' is not CLASS=FILE with a class of letters, digits, _ and -, 64 "
                                                     "at most");
        if (std::find(taken.begin(), taken.end(), lower(name)) != taken.end())
            throw CLI::ValidationError("--mesh",
                                       "'" + mesh + "': the class " + name + " is taken; choose another name");
        taken.push_back(lower(name));
    }
}

/// Checks `--per-class`.
/// @throws CLI::ValidationError unless each item is CLASS=COUNT with a class of the set, each class once
inline void check_counts(const options& o) {
    std::set<std::string> known(o.targets.begin(), o.targets.end()), counted;
    for (const std::string& mesh : o.meshes) known.insert(class_of(mesh));
    if (o.is_sonar()) {
        for (const std::string& name : kind_names()) known.insert(name);
        known.insert("empty");
    }
    for (const std::string& text : o.per_class) {
        const std::size_t equals = text.find('=');
        const std::string name = text.substr(0, equals);
        std::uint64_t count = 0;
        const bool is_number = equals != std::string::npos &&
                               examples::parse(std::string_view(text).substr(equals + 1), count) && count >= 1 &&
                               count <= 1'000'000'000;
        if (!is_number || !known.contains(name))
            throw CLI::ValidationError(
                "--per-class",
                "'" + text + "' is not CLASS=COUNT with a count from 1 and one of " + CLI::detail::join(known));
        if (!counted.insert(name).second)
            throw CLI::ValidationError("--per-class", "'" + name + "' appears twice; name each class once");
    }
}

}  // namespace generator
