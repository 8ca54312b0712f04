#include "plan_options.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "../common/parse.hpp"
#include "plan_limits.hpp"
#include "values.hpp"
#include "views.hpp"

namespace generator {

namespace {

using json = nlohmann::ordered_json;

std::string joined(const std::vector<std::string>& names, char between) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : std::string(1, between)) + name;
    return text;
}

/// Columns that are written but never read: measurements and file names.
bool is_measured(const std::string& column) {
    static const std::vector<std::string> names{
        "file",          "target_mask",      "shadow_mask",    "seabed_mask",       "png16",          "npy",
        "pfm",           "target_x_m",       "target_y_m",     "target_z_m",        "burial_m",       "rig_x_m",
        "rig_y_m",       "metres_per_pixel", "metres_per_row", "left_edge_m",       "ground_range_m", "slant_range_m",
        "grazing_deg",   "target_height_m",  "shadow_m",       "shadow_measured_m", "shadow_is_cut",  "target_is_cut",
        "visible_share", "target_area_px",   "shadow_area_px"};
    const auto known = [&](const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    for (const std::string ending : {"_bytes", "_sha256"})
        if (column.ends_with(ending) && known(column.substr(0, column.size() - ending.size()))) return true;
    return known(column);
}

/// Columns that identify image, target and class.
bool is_bookkeeping(const std::string& column) {
    for (const char* const name : {"index", "class", "target_id", "recipe", "categories", "seabed", "attempt"})
        if (column == name) return true;
    return false;
}

/// Columns that tables of targets give, too: a plan may have them in any recipe.
bool is_of_target(const std::string& column) {
    for (const char* const name : {"aspect_deg", "orientation_deg", "length_m", "width_m", "height_m"})
        if (column == name) return true;
    return false;
}

}  // namespace

json columns_of_options(const options& o) {
    json columns{
        {"recipe", o.recipe}, {"categories", joined(category_names(o), ';')}, {"seed", o.seed}, {"size_px", o.size}};
    if (o.is_sonar()) return columns;
    columns.update({{"mode", o.mode},
                    {"chip_m", o.chip},
                    {"reflectivity", o.reflectivity},
                    {"intensity", o.intensity},
                    {"sky", o.sky},
                    {"match", o.match},
                    {"noise", joined(o.noise, ',')},
                    {"colormap", o.colormap},
                    {"heightmap_spacing_m", o.heightmap.empty() ? json() : json(o.heightmap_spacing)},
                    {"heightmap_scale_m", o.heightmap.empty() ? json() : json(o.heightmap_scale)},
                    {"mesh_up", o.meshes.empty() ? json() : json(o.mesh_up)}});
    return columns;
}

options with_line(const options& o, const plan_row& row) {
    options own = o;
    own.seed = row.whole("seed", o.seed, 0, UINT64_MAX);
    own.size = static_cast<int>(row.whole("size_px", static_cast<std::uint64_t>(o.size), 16, 16384));
    const auto same = [&](const char* column, const std::string& as, const std::string& option) {
        if (const std::string* const text = row.find(column); text != nullptr && *text != as)
            row.refuse(column, as + ", as " + option + " has it");
    };
    same("recipe", o.recipe, "--recipe");
    if (o.is_sonar()) return own;
    const auto one_of = [&](const char* column, std::string& into, std::initializer_list<const char*> names) {
        const std::string* const text = row.find(column);
        if (text == nullptr) return;
        std::string list;
        for (const char* const name : names) {
            list += (list.empty() ? "" : ", ") + std::string(name);
            if (*text == name) return void(into = name);
        }
        row.refuse(column, "one of " + list);
    };
    one_of("mode", own.mode, {"overhead", "ground_range", "slant_range"});
    take_mode_defaults(own);
    one_of("match", own.match, {"masked", "whole"});
    one_of("colormap", own.colormap, {"gray", "copper"});
    own.chip = row.number("chip_m", own.chip, 0, 1e4);
    if (!own.is_overhead() && !(own.chip > 0)) row.refuse("chip_m", "metres a side, for a sonar's mode");
    own.reflectivity = row.number("reflectivity", o.reflectivity, 0, 1e6);
    own.intensity = row.number("intensity", o.intensity, 0, 1e6);
    own.sky = row.number("sky", o.sky, 0, 1e6);
    if (const std::string* const noise = row.find("noise")) own.noise = CLI::detail::split(*noise, ',');
    try {
        for (const noise_step& step : noise_steps(own))
            if (step.kind == "seabed" && own.is_overhead()) row.refuse("noise", "a chain without seabed");
    } catch (const CLI::ValidationError&) {
        row.refuse("noise", std::string("none, or a chain of speckle:VARIANCE, gaussian:VARIANCE, poisson:PHOTONS, "
                                        "rayleigh") +
                                (own.is_overhead() ? "" : ", seabed"));
    }
    // Input files are read once, so these options must be the same for all images.
    if (!o.heightmap.empty()) {
        if (row.number("heightmap_spacing_m", o.heightmap_spacing, 0, 1e9) != o.heightmap_spacing)
            row.refuse("heightmap_spacing_m", "the --heightmap-spacing");
        if (row.number("heightmap_scale_m", o.heightmap_scale, -1e9, 1e9) != o.heightmap_scale)
            row.refuse("heightmap_scale_m", "the --heightmap-scale");
    }
    if (!o.meshes.empty()) same("mesh_up", o.mesh_up, "--mesh-up");
    return own;
}

void check_columns(const options& o, const known_columns& known) {
    const plan_table& table = *o.table;
    const json of_options = columns_of_options(o);
    const std::vector<std::string> truths{"true", "false"};
    std::vector<std::string> numbers, kinds;
    std::map<std::string, std::vector<std::string>> lists{{"class", known.classes}};
    for (const std::string& column : table.columns()) {
        if (const auto choice = known.choices.find(column); choice != known.choices.end()) lists.insert(*choice);
        if (column.empty() || is_measured(column) || is_bookkeeping(column) || of_options.contains(column)) continue;
        if (is_of_target(column)) {
            numbers.push_back(column);
            continue;
        }
        if (!known.examples.contains(column))
            throw plan_error("--plan " + table.name() + ": line 1: recipe " + o.recipe + " has no column '" + column +
                             "'; docs/dataset.md lists the columns");
        if (known.examples[column].is_boolean()) lists[column] = truths;
        if (column.ends_with("_kind")) kinds.push_back(column);
        if (known.examples[column].is_number()) numbers.push_back(column);
    }
    for (std::size_t i = 0; i < table.size(); ++i) {
        const plan_row row = table.row(i);
        for (const std::string& column : numbers) {
            const limits within = limits_of(column);
            const bool is_word = column.ends_with("_seed") || column.ends_with("_form");
            const double value = row.number(column, 0, is_word ? 0 : within.low, is_word ? 4294967295.0 : within.high);
            if (!is_of_target(column) && known.examples[column].is_number_integer() && value != std::floor(value))
                row.refuse(column, "a whole number");
        }
        for (const std::string& column : kinds)
            if (const std::string* const kind = row.find(column); kind != nullptr && *kind != *row.find("class"))
                row.refuse(column, "the class of the image");
        for (const auto& [column, list] : lists)
            if (const std::string* const text = row.find(column);
                text != nullptr && std::find(list.begin(), list.end(), *text) == list.end())
                row.refuse(column, list == truths ? "true or false" : "one of " + joined(list, ','));
    }
}

std::vector<double> parse_aspects(const std::string& text) {
    const std::string usage = "'" + text + "' is not first:step:last, or a list of degrees";
    const auto number = [&](std::string_view part) {
        double value = 0;
        if (!examples::parse(part, value) || !(value >= -360 && value <= 360))
            throw std::invalid_argument(usage + " from -360 to 360");
        return value;
    };
    const std::size_t first = text.find(':'), second = text.find(':', first + 1);
    std::vector<double> aspects;
    if (first == std::string::npos) {
        for (std::size_t at = 0; at <= text.size();) {
            const std::size_t end = (std::min)(text.find(',', at), text.size());
            aspects.push_back(number(std::string_view(text).substr(at, end - at)));
            at = end + 1;
        }
        return aspects;
    }
    if (second == std::string::npos) throw std::invalid_argument(usage);
    const double low = number(std::string_view(text).substr(0, first)),
                 step = number(std::string_view(text).substr(first + 1, second - first - 1)),
                 high = number(std::string_view(text).substr(second + 1));
    if (!(step >= 0.01)) throw std::invalid_argument(usage + "; the step is 0.01 at least");
    if (high < low) throw std::invalid_argument(usage + "; the last is not below the first");
    // Multiplied rather than accumulated, so that rounding does not lose the last aspect.
    for (int i = 0; low + i * step <= high + 1e-9; ++i) aspects.push_back(low + i * step);
    return aspects;
}

namespace {

/// Refuses options that a column of the plan decides for every image.
void refuse_decided(const plan_table& table, const is_given& given) {
    constexpr const char* columns[][2] = {{"--seed", "seed"},
                                          {"--size", "size_px"},
                                          {"--mode", "mode"},
                                          {"--chip", "chip_m"},
                                          {"--reflectivity", "reflectivity"},
                                          {"--intensity", "intensity"},
                                          {"--sky", "sky"},
                                          {"--match", "match"},
                                          {"--noise", "noise"},
                                          {"--colormap", "colormap"},
                                          {"--display", "display"},
                                          {"--white", "white"},
                                          {"--display-range", "display_range_db"},
                                          {"--altitude", "altitude_m"},
                                          {"--grazing", "light_deg"},
                                          {"--distance", "distance"},
                                          {"--beam", "beam_deg"},
                                          {"--target-size", "target_size_m"},
                                          {"--aspect", "aspect"},
                                          {"--burial", "burial"}};
    for (const auto& [option, column] : columns) {
        if (!given(option) || !table.has(column)) continue;
        std::size_t lines = 0;
        while (lines < table.size() && table.row(lines).find(column) != nullptr) ++lines;
        if (lines == table.size())
            throw CLI::ValidationError(option, std::string("the plan has a column ") + column + "; remove either");
    }
}

}  // namespace

void apply_plan(options& o, const std::string& path, const is_given& given) {
    for (const char* const name : {"--per-class", "--demo", "--targets", "--empty"})
        if (given(name))
            throw CLI::ValidationError(name, "cannot be combined with --plan, whose lines name the classes");
    try {
        o.table = std::make_shared<const plan_table>(path.substr(path.rfind('/') + 1),
                                                     examples::read_input(path, o.input_limit, "raise --input-limit"));
    } catch (const insonify::io_error& error) {
        throw CLI::ValidationError(error.what(), CLI::ExitCodes::ValidationError);
    }
    const plan_row first = o.table->row(0);
    const auto open = [&](const char* option, const char* column, std::string& into, const char* otherwise) {
        const std::string* const text = first.find(column);
        if (!given(option)) into = text == nullptr ? otherwise : *text;
    };
    open("--recipe", "recipe", o.recipe, o.table->is_published() ? "published" : "sonar");
    open("--mode", "mode", o.mode, "overhead");
    if (o.recipe != "sonar" && o.recipe != "published") first.refuse("recipe", "sonar or published");
    if (o.mode != "overhead" && o.mode != "slant_range" && o.mode != "ground_range")
        first.refuse("mode", "overhead, slant_range or ground_range");
    for (const char* const name : {"png16", "npy", "pfm"})
        if (!given("--format") && o.table->has(name)) o.formats.push_back(name);
    if (o.table->has("seabed")) {
        if (given("--seabeds")) throw CLI::ValidationError("--seabeds", "the plan has a column seabed; remove either");
        o.seabeds.clear();
    }
    refuse_decided(*o.table, given);
}

void apply_aspects(options& o, const std::string& text) {
    const char* const decided = !o.table                     ? nullptr
                                : o.table->has_ids()         ? "index"
                                : o.table->has("yaw_deg")    ? "yaw_deg"
                                : o.table->has("aspect_deg") ? "aspect_deg"
                                : o.table->has("t1_yaw_rad") ? "t1_yaw_rad"
                                                             : nullptr;
    if (!text.empty() && text != "random") {
        if (decided != nullptr)
            throw CLI::ValidationError("--aspects", std::string("the plan has a column ") + decided +
                                                        ", so that each line is one image; remove either");
        if (o.demo) throw CLI::ValidationError("--aspects", "cannot be combined with --demo");
        try {
            o.aspects = parse_aspects(text);
        } catch (const std::invalid_argument& error) {
            throw CLI::ValidationError("--aspects", error.what());
        }
    } else if (text.empty() && decided == nullptr && !o.is_sonar() && o.is_overhead() && !o.demo) {
        o.aspects = parse_aspects("0:10:350");
    }
}

void apply_plan_count(options& o, const is_given& given) {
    const std::uint64_t images = o.table->size() * views_of_each(o);
    if (o.first >= images)
        throw CLI::ValidationError("--first", std::to_string(o.first) + " is not below " + std::to_string(images) +
                                                  ", the number of images of the plan");
    if (!given("--count")) o.count = images - o.first;
    if (o.first + o.count > images)
        throw CLI::ValidationError("--count", std::to_string(o.count) + " images from --first " +
                                                  std::to_string(o.first) + " on are more than the " +
                                                  std::to_string(images) + " of the plan");
}

}  // namespace generator
