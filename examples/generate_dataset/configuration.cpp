#include "configuration.hpp"

#include <insonify/version.hpp>

#include "views.hpp"

namespace generator {

namespace fs = std::filesystem;

namespace {

/// Version of the folder's layout and of the recipes.
constexpr int format = 4;

std::string version() {
    const auto text = [](int number) { return std::to_string(number); };
    return "insonify " + text(INSONIFY_VERSION_MAJOR) + "." + text(INSONIFY_VERSION_MINOR) + "." +
           text(INSONIFY_VERSION_PATCH);
}

/// A line "name was a, is b" for each member that differs; inputs are compared one by one.
std::string differences(const json& before, const json& now, const std::string& within = "") {
    std::string text;
    const auto add = [&](const std::string& name, const json* was, const json* is) {
        if (was != nullptr && is != nullptr && *was == *is) return;
        if (name == "inputs" && was != nullptr && is != nullptr) {
            text += differences(*was, *is, "input ");
            return;
        }
        text += "\n  " + within + name + " was " + (was == nullptr ? "absent" : was->dump()) + ", is " +
                (is == nullptr ? "absent" : is->dump());
    };
    const auto member = [](const json& of, const std::string& name) {
        const auto found = of.find(name);
        return found == of.end() ? nullptr : &*found;
    };
    for (const auto& [name, value] : now.items()) add(name, member(before, name), &value);
    for (const auto& [name, value] : before.items())
        if (!now.contains(name)) add(name, &value, nullptr);
    return text;
}

}  // namespace

json configuration_of(const options& o, const std::vector<input>& inputs) {
    const auto pair = [](const range& r) { return json::array({r.low, r.high}); };
    std::vector<std::string> meshes;
    for (const std::string& mesh : o.meshes) meshes.push_back(class_of(mesh));
    json files = json::object();
    for (std::size_t i = 0; i < inputs.size(); ++i)
        files[std::to_string(i) + " " + inputs[i].option + " " + inputs[i].name] = {{"bytes", inputs[i].bytes},
                                                                                    {"sha256", inputs[i].sha256}};
    return {{"format", format},
            {"version", version()},
            {"recipe", o.recipe},
            {"visible_share", o.visible_share},
            {"empty", o.empty},
            {"per_class", o.per_class},
            {"seed", o.seed},
            {"size", o.size},
            {"targets", o.targets},
            {"meshes", meshes},
            {"mesh_up", o.mesh_up},
            {"seabeds", o.seabeds},
            {"heightmap_spacing", o.heightmap_spacing},
            {"heightmap_scale", o.heightmap_scale},
            {"target_size", pair(o.target_size)},
            {"aspect", pair(o.aspect)},
            {"tilt", pair(o.tilt)},
            {"burial", pair(o.burial)},
            {"aspects", o.aspects},
            {"place", o.place},
            {"mode", o.mode},
            {"chip", o.chip},
            {"altitude", pair(o.altitude)},
            {"distance", pair(o.distance)},
            {"beam", pair(o.beam)},
            {"grazing", pair(o.grazing)},
            {"reflectivity", o.reflectivity},
            {"intensity", o.intensity},
            {"sky", o.sky},
            {"match", o.match},
            {"noise", o.noise},
            {"colormap", o.colormap},
            {"display", o.display},
            {"white", o.white ? pair(*o.white) : json()},
            {"display_range", o.display_range ? pair(*o.display_range) : json()},
            {"formats", o.formats},
            {"categories", category_names(o)},
            {"demo", o.demo},
            {"inputs", files}};
}

json shards_of(const options& o) {
    json shards{{"first", o.first}, {"count", o.count}, {"shards", o.shard.of}};
    if (!o.table || !o.table->has_ids()) return shards;
    // The ids of a plan may have gaps: list the first and last of each run.
    json& runs = shards["ids"] = json::array();
    for (std::uint64_t i = o.first; i < o.first + o.count; ++i) {
        const std::uint64_t id = image_id(o, i);
        if (!runs.empty() && runs.back()[1] == id - 1)
            runs.back()[1] = id;
        else
            runs.push_back({id, id});
    }
    return shards;
}

json pinned(const fs::path& root, const std::string& name) {
    const fs::path path = root / name;
    if (!fs::exists(path)) return {};
    const json before = json::parse(insonify::read_file(path.string()), nullptr, false);
    if (!before.is_object())
        throw insonify::io_error(path.string() + ": is damaged; restore it from a copy, or name another folder");
    return before;
}

void pin(const fs::path& root, const std::string& name, const json& now, staging& into) {
    json before = pinned(root, name);
    if (before.is_null()) {
        if (into.write_if_absent({name, now.dump(2, ' ', false, json::error_handler_t::replace) + "\n"})) return;
        before = pinned(root, name);
    }
    check_pinned(root, before, now);
}

void check_pinned(const fs::path& root, const json& before, const json& now) {
    const std::string text = differences(before, now);
    if (!text.empty())
        throw insonify::io_error(root.string() + ": holds a data set of another configuration:" + text +
                                 "\nName another folder, or use the same options.");
}

}  // namespace generator
