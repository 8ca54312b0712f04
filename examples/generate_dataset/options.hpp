// What a data set shall be: everything the command line and a config file can say, checked and explained.
#pragma once

#include <insonify/core/image.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace generator {

/// Drawn uniformly for every image; a single value is a range without width.
struct range {
    double low, high;
};

/// Everything but out, first, count and threads decides pixels and is pinned in the folder's config.json.
struct options {
    std::string out;
    std::size_t first = 0, count = 24;
    int threads = 0;

    std::uint64_t seed = 1;
    int size = 2048;
    std::vector<std::string> targets{"cylinder", "cube", "cone", "sphere"};
    std::vector<std::string> meshes;  ///< class=path
    std::string mesh_up = "y";
    std::vector<std::string> seabeds{"ripples", "mud", "rock"};
    std::string heightmap;
    double heightmap_spacing = 0.02, heightmap_scale = 1;
    range target_size{0.4, 0.8}, aspect{0.8, 1.25}, tilt{-3, 3}, burial{0.1, 0.3};
    std::string mode = "overhead";
    double chip = 0;  ///< metres a side; 0: what the camera sees
    range altitude{3.5, 5}, grazing{6, 6}, distance{2, 9}, beam{0.2, 0.5};
    double reflectivity = 0.9, intensity = 4, sky = 0.05;
    std::vector<std::string> references;
    std::vector<std::string> noise{"speckle:0.1"};
    std::string colormap = "gray";
    bool demo = false;

    bool is_overhead() const { return mode == "overhead"; }
};

/// One step of the noise chain: a kind and its strength.
struct noise_step {
    std::string kind;
    double strength;
};

inline range parse_range(const std::string& name, const std::string& text) {
    const auto number = [&](const std::string& part) {
        double value = 0;
        const auto [end, status] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (status != std::errc{} || end != part.data() + part.size())
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
    const range strength = parse_range("--noise", text.substr(colon + 1));
    if (strength.low != strength.high || !(strength.low > 0))
        throw CLI::ValidationError("--noise", "'" + text + "': the strength must be one number above 0");
    return {kind, strength.low};
}

inline std::vector<noise_step> noise_steps(const options& o) {
    std::vector<noise_step> steps;
    for (const std::string& text : o.noise)
        if (text != "none") steps.push_back(parse_noise(text));
    return steps;
}

/// What is pinned: two runs into one folder must agree on all of it.
inline nlohmann::ordered_json pinned(const options& o) {
    const auto pair = [](const range& r) { return nlohmann::ordered_json::array({r.low, r.high}); };
    return {{"seed", o.seed},
            {"size", o.size},
            {"targets", o.targets},
            {"meshes", o.meshes},
            {"mesh_up", o.mesh_up},
            {"seabeds", o.seabeds},
            {"heightmap", o.heightmap},
            {"heightmap_spacing", o.heightmap_spacing},
            {"heightmap_scale", o.heightmap_scale},
            {"target_size", pair(o.target_size)},
            {"aspect", pair(o.aspect)},
            {"tilt", pair(o.tilt)},
            {"burial", pair(o.burial)},
            {"mode", o.mode},
            {"chip", o.chip},
            {"altitude", pair(o.altitude)},
            {"distance", pair(o.distance)},
            {"beam", pair(o.beam)},
            {"grazing", pair(o.grazing)},
            {"reflectivity", o.reflectivity},
            {"intensity", o.intensity},
            {"sky", o.sky},
            {"references", o.references},
            {"noise", o.noise},
            {"colormap", o.colormap},
            {"demo", o.demo}};
}

/// Help without the validators' shorthand: what a value may be is said in words.
struct plain_formatter : CLI::Formatter {
    plain_formatter() { column_width(30); }
    std::string make_option_opts(const CLI::Option* option) const override {
        return option->get_expected_max() == 0 ? "" : option->get_required() ? " VALUE (needed)" : " VALUE";
    }
};

/// Reads the command line. Prints help or an error and exits where there is nothing to generate.
inline options parse(int argc, char** argv) {
    options o;
    CLI::App app{
        "Makes labelled side-scan sonar images: for every image a target on a seabed, camera and light posed,\n"
        "rendered, given the look of a reference, and written with its masks.\n\n"
        "Image i depends on the seed and i alone. A stopped run goes on where it stopped.",
        "generate_dataset"};
    app.footer(
        "A range is low:high, or one number. Examples:\n"
        "  generate_dataset --out out/a --count 400 --size 512 --noise speckle:0.1\n"
        "  generate_dataset --out out/b --first 200 --count 200 --reference real_images/ --colormap copper\n"
        "  generate_dataset --out out/s --mode slant_range --chip 5 --pixels 128 --count 400\n"
        "  generate_dataset --out out/c --targets cylinder --mesh wreck=wreck.obj --seabeds mud,mixed");
    app.formatter(std::make_shared<plain_formatter>());
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    app.set_config("--config", "", "Read options from a TOML or INI file; the command line wins");

    std::string target_size, aspect, tilt, burial, altitude, grazing, distance, beam;
    const CLI::Validator target_names = CLI::IsMember({"cylinder", "cube", "cone", "sphere"});
    const CLI::Validator seabed_names = CLI::IsMember({"ripples", "mud", "rock", "sand", "mixed", "heightmap"});

    const char* const what = "What to make";
    app.add_option("--out", o.out, "Folder of the data set; made if need be")->required()->group(what);
    app.add_option("--count", o.count, "How many images (24)")->group(what);
    app.add_option("--first", o.first, "Index of the first image (0)")->group(what);
    app.add_option("--seed", o.seed, "Another seed is another data set (1)")->group(what);
    app.add_option("--size,--pixels", o.size, "Pixels a side (2048; 128 for a sonar's modes)")
        ->check(CLI::Range(16, 16384))
        ->group(what);
    app.add_option("--threads", o.threads, "0: one for each hardware thread; never changes a byte")
        ->check(CLI::Range(0, 1024))
        ->group(what);
    app.add_flag("--demo", o.demo, "All targets on all seabeds, plain and with a reference")->group(what);

    const char* const scene = "Scene";
    app.add_option("--targets", o.targets, "cylinder,cube,cone,sphere; taken in turn")
        ->delimiter(',')
        ->check(target_names)
        ->group(scene);
    app.add_option("--mesh", o.meshes, "CLASS=FILE.obj: a mesh as a class of its own; repeat for more")->group(scene);
    app.add_option("--mesh-up", o.mesh_up, "Which axis of the meshes is up: y or z (y)")
        ->check(CLI::IsMember({"y", "z"}))
        ->group(scene);
    app.add_option("--seabeds", o.seabeds, "ripples,mud,rock,sand,mixed,heightmap; taken in turn")
        ->delimiter(',')
        ->check(seabed_names)
        ->group(scene);
    app.add_option("--heightmap", o.heightmap, "PGM or PFM with heights, for the seabed `heightmap`")
        ->check(CLI::ExistingFile)
        ->group(scene);
    app.add_option("--heightmap-spacing", o.heightmap_spacing, "Metres from pixel to pixel (0.02)")->group(scene);
    app.add_option("--heightmap-scale", o.heightmap_scale, "Metres for a full-scale pixel (1)")->group(scene);
    app.add_option("--target-size", target_size, "Range: height or diameter, metres (0.4:0.8)")->group(scene);
    app.add_option("--aspect", aspect, "Range: length over what is usual for the kind (0.8:1.25)")->group(scene);
    app.add_option("--tilt", tilt, "Range: pitch and roll, degrees (-3:3)")->group(scene);
    app.add_option("--burial", burial, "Range: share of the height that is buried (0.1:0.3)")->group(scene);

    const char* const rig = "Camera and light, or sonar";
    app.add_option("--mode", o.mode,
                   "overhead: the paper's camera and light; slant_range: as a side-scan sonar hears it;\n"
                   "ground_range: the same laid out on the bottom (overhead)")
        ->check(CLI::IsMember({"overhead", "ground_range", "slant_range"}))
        ->group(rig);
    app.add_option("--chip", o.chip,
                   "Metres a side, the target a third from the left; range grows to the right\n"
                   "(overhead: 0, all that the camera sees; a sonar's modes: 5)")
        ->check(CLI::Range(0.0, 1e4))
        ->group(rig);
    app.add_option("--altitude", altitude, "Range: metres above the sea floor (3.5:5; a sonar's: 3:10)")->group(rig);
    app.add_option("--grazing", grazing, "Range: light above the sea floor, degrees (6)")->group(rig);
    app.add_option("--distance", distance, "Range: of the target from a sonar's track, in altitudes (2:9)")->group(rig);
    app.add_option("--beam", beam, "Range: width of a sonar's beam along the track, degrees (0.2:0.5)")->group(rig);
    app.add_option("--intensity", o.intensity, "Light on a surface that faces it (4)")
        ->check(CLI::NonNegativeNumber)
        ->group(rig);
    app.add_option("--sky", o.sky, "Light from everywhere (0.05)")->check(CLI::NonNegativeNumber)->group(rig);
    app.add_option("--reflectivity", o.reflectivity, "Of targets; seabeds have 0.4 to 0.6 (0.9)")
        ->check(CLI::NonNegativeNumber)
        ->group(rig);

    const char* const look = "Look";
    app.add_option("--reference", o.references,
                   "Real image or folder of images to match histograms with; repeat for more")
        ->check(CLI::ExistingPath)
        ->group(look);
    app.add_option(
           "--noise", o.noise,
           "none, or a chain: speckle:0.1,gaussian:0.01,poisson:255,rayleigh; seabed, of a sonar's modes alone,\n"
           "is speckle that depends on the type of bottom (speckle:0.1; a sonar's: seabed)")
        ->delimiter(',')
        ->group(look);
    app.add_option("--colormap", o.colormap, "gray or copper (gray)")
        ->check(CLI::IsMember({"gray", "copper"}))
        ->group(look);

    try {
        app.parse(argc, argv);
        const auto given = [&](const char* name) { return !app.get_option(name)->empty(); };
        if (!o.is_overhead()) {
            if (!given("--size")) o.size = 128;
            if (o.chip == 0) o.chip = 5;
            if (!given("--noise")) o.noise = {"seabed"};
            o.altitude = {3, 10};
        }
        const auto take = [](const char* name, const std::string& text, range& into, double lowest, double highest) {
            if (!text.empty()) into = parse_range(name, text);
            if (into.low < lowest || into.high > highest)
                throw CLI::ValidationError(name, "must lie within " + insonify::detail::to_text(lowest) + " and " +
                                                     insonify::detail::to_text(highest));
        };
        take("--target-size", target_size, o.target_size, 1e-3, 1e3);
        take("--aspect", aspect, o.aspect, 1e-2, 1e2);
        take("--tilt", tilt, o.tilt, -90, 90);
        take("--burial", burial, o.burial, 0, 0.95);
        take("--altitude", altitude, o.altitude, 1e-2, 1e4);
        take("--grazing", grazing, o.grazing, 0.01, 90);
        take("--distance", distance, o.distance, 0, 1e3);
        take("--beam", beam, o.beam, 1e-3, 20);
        for (const noise_step& step : noise_steps(o))
            if (step.kind == "seabed" && o.is_overhead())
                throw CLI::ValidationError("--noise", "'seabed' is for the sonar's modes: --mode slant_range");
        for (const std::string& mesh : o.meshes)
            if (mesh.find('=') == std::string::npos || mesh.front() == '=' || mesh.back() == '=' ||
                mesh.substr(0, mesh.find('=')).find_first_of("/\\ .") != std::string::npos)
                throw CLI::ValidationError("--mesh", "'" + mesh + "' is not CLASS=FILE with a plain word as class");
        const bool needs_map = std::find(o.seabeds.begin(), o.seabeds.end(), "heightmap") != o.seabeds.end();
        if (needs_map && o.heightmap.empty())
            throw CLI::ValidationError("--seabeds", "heightmap needs --heightmap FILE");
        if (!o.heightmap.empty() && !needs_map) o.seabeds = {"heightmap"};
        if (o.count == 0) throw CLI::ValidationError("--count", "must be at least 1");
    } catch (const CLI::ParseError& error) {
        std::exit(app.exit(error) == 0 ? 0 : 2);
    }
    if (o.demo) {
        if (app.get_option("--count")->empty()) o.count = 24;
        if (app.get_option("--noise")->empty() && o.is_overhead()) o.noise = {"speckle:0.05"};
    }
    return o;
}

}  // namespace generator
