#include "options.hpp"

#include <algorithm>
#include <functional>

#include "../common/refusal.hpp"
#include "config_text.hpp"
#include "formats.hpp"
#include "layout.hpp"
#include "plan_options.hpp"
#include "values.hpp"
#include "views.hpp"

namespace generator {

void take_mode_defaults(options& o) {
    if (!o.given.contains("--chip")) o.chip = o.is_overhead() ? 0 : 5;
    if (!o.given.contains("--altitude")) o.altitude = o.is_overhead() ? range{3.5, 5} : range{3, 10};
    if (!o.given.contains("--noise")) o.noise = {o.is_overhead() ? "speckle:0.1" : "seabed"};
}

std::vector<noise_step> noise_steps(const options& o) {
    std::vector<noise_step> steps;
    for (const std::string& text : o.noise)
        if (text != "none") steps.push_back(parse_noise(text));
    return steps;
}

namespace {

/// Help without the validators' shorthand: the descriptions state the allowed values.
struct plain_formatter : CLI::Formatter {
    plain_formatter() { column_width(30); }
    std::string make_option_opts(const CLI::Option* option) const override {
        return option->get_expected_max() == 0 ? "" : option->get_required() ? " VALUE (required)" : " VALUE";
    }
};

/// Checks combinations of ranges.
void check_geometry(const options& o) {
    const auto text = [](double value) { return insonify::detail::to_text(value); };
    if (o.is_overhead()) {
        if (o.chip > 1000 * o.altitude.low)
            throw CLI::ValidationError("--chip", text(o.chip) + " m from an --altitude of " + text(o.altitude.low) +
                                                     " m exceeds the field of view; use at most 1000 altitudes");
        return;
    }
    const double farthest = (o.distance.high + 1) * o.altitude.high + o.chip;
    if (farthest > 1e5)
        throw CLI::ValidationError("--distance", text(o.distance.high) + " times an --altitude of " +
                                                     text(o.altitude.high) + " m, and a --chip of " + text(o.chip) +
                                                     " m, exceed 100000 m; reduce one of them");
}

/// Refuses options that would have no effect.
void refuse_options(const is_given& given, std::initializer_list<const char*> names, const std::string& reason) {
    for (const char* const name : names)
        if (given(name)) throw CLI::ValidationError(name, reason);
}

void check_recipe(const options& o, const is_given& given) {
    if (o.is_sonar()) {
        const char* const reason = "belongs to --recipe published; recipe sonar samples its own";
        refuse_options(given, {"--demo", "--mesh", "--mesh-up", "--target-size", "--aspect", "--tilt", "--burial"},
                       reason);
        refuse_options(given, {"--heightmap", "--heightmap-spacing", "--heightmap-scale"}, reason);
        refuse_options(given, {"--mode", "--chip", "--altitude", "--grazing", "--distance", "--beam"}, reason);
        refuse_options(given, {"--intensity", "--sky", "--reflectivity"}, reason);
        refuse_options(given, {"--reference", "--match", "--noise", "--colormap"}, reason);
        if (!o.table)
            refuse_options(given, {"--seabeds", "--aspects"}, "belongs to --recipe published, or to a --plan");
        return;
    }
    refuse_options(given, {"--empty", "--visible-share"}, "belongs to --recipe sonar");
    if (o.meshes.empty()) refuse_options(given, {"--mesh-up"}, "needs --mesh");
    if (o.heightmap.empty()) refuse_options(given, {"--heightmap-spacing", "--heightmap-scale"}, "needs --heightmap");
    if (o.references.empty() && !o.demo && !o.table) refuse_options(given, {"--match"}, "needs --reference");
    const std::vector<std::string> primitives = primitive_names();
    for (const std::string& target : o.targets)
        if (std::find(primitives.begin(), primitives.end(), target) == primitives.end())
            throw CLI::ValidationError("--targets", "'" + target + "' belongs to --recipe sonar");
}

/// Whether every image is of `--mode`: the lines of a plan may each have their own.
bool has_one_mode(const options& o) {
    return !o.is_sonar() && !(o.table && o.table->has("mode"));
}

/// Refuses options of the other modes of recipe published.
void check_mode(const options& o, const is_given& given) {
    if (!has_one_mode(o)) return;
    const std::string reason = "has no effect in --mode " + o.mode + "; it needs ";
    if (o.is_overhead())
        refuse_options(given, {"--distance", "--beam"}, reason + "a side-scan mode, such as --mode slant_range");
    else
        refuse_options(given, {"--grazing", "--intensity", "--sky"}, reason + "--mode overhead");
}

/// Refuses options of displays that are not used: overhead images have none, and only one in decibels has a range.
void check_display(const options& o, const is_given& given) {
    if (has_one_mode(o) && o.is_overhead())
        refuse_options(given, {"--display", "--white", "--display-range"},
                       "needs a side-scan mode, such as --mode slant_range");
    const bool has_range = o.display == "decibels" || (o.display.empty() && o.is_sonar()) || o.table;
    if (o.display_range && !has_range)
        throw CLI::ValidationError("--display-range", "needs --display decibels; other displays have no range");
}

options parsed(int argc, const char* const* argv,
               const std::function<void(const CLI::App&, const CLI::ParseError&)>& refuse) {
    options o;
    CLI::App app{
        "Makes labelled side-scan sonar images: targets on seabeds, with masks, boxes and parameters.\n\n"
        "Image i depends on the seed and i alone. A run verifies existing files by checksum, repairs damaged ones, "
        "and\n"
        "continues where an earlier run stopped.",
        "generate_dataset"};
    app.footer(
        "A range is low:high, or one number. Examples:\n"
        "  generate_dataset --out out/a --count 4000\n"
        "  generate_dataset --out out/k --per-class ship=600,plane=600,truncated_cone=200,empty=1400\n"
        "  generate_dataset --out out/l --count 1000000 --shard 3/8\n"
        "  generate_dataset --out out/p --recipe published --count 400 --size 512 --noise speckle:0.1\n"
        "  generate_dataset --out out/b --recipe published --reference real_images/ --colormap copper\n"
        "  generate_dataset --out out/s --recipe published --mode slant_range --chip 5 --pixels 128 --count 400\n"
        "  generate_dataset --out out/c --recipe published --targets cylinder --mesh wreck=wreck.obj --seabeds mud");
    app.formatter(std::make_shared<plain_formatter>());
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    app.set_config("--config", "",
                   "Read options from a file with a line `option = value` for each; the command line wins")
        ->check(config_file());
    app.config_formatter(std::make_shared<strict_config>(app));

    std::uint64_t input_limit = examples::usual_input_limit >> 20;
    std::string shard, plan, aspects, target_size, aspect, tilt, burial, altitude, grazing, distance, beam, white,
        display_range;
    const auto one_of = [](const auto& names) {
        return CLI::IsMember(std::vector<std::string>(std::begin(names), std::end(names)));
    };

    const char* const what = "What to make";
    app.add_option("--out", o.out, "Folder of the data set; created if missing")
        ->required()
        ->check(examples::folder_to_fill())
        ->group(what);
    app.add_option("--count", o.count, "How many images (24)")->check(whole_number(1, max_images))->group(what);
    app.add_option("--first", o.first, "Index of the first image (0)")
        ->check(whole_number(0, max_images - 1))
        ->group(what);
    app.add_option("--shard", shard,
                   "K/N: make shard K of N, counted from 0. N alone: K is the index of this task in a job array,\n"
                   "SLURM_ARRAY_TASK_ID or JOB_COMPLETION_INDEX. tools/merge joins the shards")
        ->group(what);
    app.add_flag("--verify", o.verify, "Check and decode every file of the set; write nothing")->group(what);
    app.add_flag("--dry-run", o.dry_run, "Print counts, size and estimates of time and bytes; write nothing")
        ->group(what);
    app.add_option("--seed", o.seed, "Seed of all random values (1)")->check(whole_number(0, UINT64_MAX))->group(what);
    app.add_option("--size,--pixels", o.size, "Pixels a side (2048; recipe sonar and side-scan modes: 128)")
        ->check(whole_number(16, 16384))
        ->group(what);
    app.add_option("--threads", o.threads,
                   "Number of threads, 0 for one per hardware thread (0); does not change the output")
        ->check(whole_number(0, 1024))
        ->group(what);
    app.add_option("--input-limit", input_limit, "Maximum size of an input file, MiB (1024)")
        ->check(whole_number(1, 1 << 20))
        ->group(what);
    app.add_option("--format", o.formats,
                   "In addition to 8-bit PNG: png16, npy, pfm (16 bits or float), webdataset (tar files of a thousand\n"
                   "samples each)")
        ->delimiter(',')
        ->check(one_of(format_names))
        ->group(what);
    app.add_flag("--preview", o.preview, "Write preview.html, a page to browse the set")->group(what);
    app.add_flag("--demo", o.demo, "Every target on every seabed, plain and matched with a reference")->group(what);

    app.add_option("--recipe", o.recipe,
                   "sonar: side-scan images of wrecks, aeroplanes and bare bottoms;\n"
                   "published: the paper's primitives, camera and light, or side-scan modes (sonar)")
        ->check(CLI::IsMember({"sonar", "published"}))
        ->group(what);

    app.add_option("--plan", plan,
                   "CSV with a line for each image or target, whose values replace random ones: the manifest.csv of a\n"
                   "set, which reproduces it, or a table of targets (id, shape, length, width, height, orientation),\n"
                   "each shown at every aspect on every seabed")
        ->check(CLI::ExistingFile)
        ->group(what);

    const char* const scene = "Scene";
    app.add_option("--aspects", aspects,
                   "Aspects of each target, degrees from the line of sight: first:step:last, a list, or random\n"
                   "(recipe published from overhead: 0:10:350; otherwise random)")
        ->group(scene);
    app.add_option("--place", o.place, "Position of the target in the image: third or anywhere (decided by the recipe)")
        ->check(CLI::IsMember({"third", "anywhere"}))
        ->group(scene);
    app.add_option("--visible-share", o.visible_share,
                   "Recipe sonar: images are redrawn if less than this share of a target's outline is visible (0.1)")
        ->check(number(0, 1))
        ->group(scene);
    app.add_option("--empty", o.empty, "Recipe sonar: share of images without a target, class `empty` (0.4)")
        ->check(number(0, 1))
        ->group(scene);
    app.add_option("--per-class", o.per_class,
                   "CLASS=COUNT,...: number of images of each class, one class after the other instead of in turn;\n"
                   "again from the first for a larger --count")
        ->delimiter(',')
        ->group(scene);
    app.add_option("--targets", o.targets,
                   "Classes of targets, taken in turn (cylinder,cube,cone,sphere; recipe sonar: ship,plane)")
        ->delimiter(',')
        ->check(one_of(kind_names()))
        ->group(scene);
    app.add_option("--mesh", o.meshes, "CLASS=FILE.obj: add a mesh as a class; may be repeated")->group(scene);
    app.add_option("--mesh-up", o.mesh_up, "Up axis of the meshes: y or z (y)")
        ->check(CLI::IsMember({"y", "z"}))
        ->group(scene);
    app.add_option("--seabeds", o.seabeds, "Of ripples,mud,rock,sand,mixed,heightmap; taken in turn (ripples,mud,rock)")
        ->delimiter(',')
        ->check(one_of(seabed_names))
        ->group(scene);
    app.add_option("--heightmap", o.heightmap, "Heights of the seabed `heightmap`: PNG of 8 or 16 bits, PGM or PFM")
        ->check(CLI::ExistingFile)
        ->group(scene);
    app.add_option("--heightmap-spacing", o.heightmap_spacing, "Metres between pixels (0.02)")
        ->check(number(1e-4, 1e4))
        ->group(scene);
    app.add_option("--heightmap-scale", o.heightmap_scale, "Height of a full-scale pixel, metres (1)")
        ->check(number(-1e6, 1e6))
        ->group(scene);
    app.add_option("--target-size", target_size,
                   "Range of height or diameter, of a mesh half of its largest extent, metres (0.4:0.8)")
        ->group(scene);
    app.add_option(
           "--aspect", aspect,
           "Range of a factor on the length of a cylinder or sphere, the width of a cube, the diameter of a cone\n"
           "(0.8:1.25)")
        ->group(scene);
    app.add_option("--tilt", tilt, "Range of pitch and roll, degrees (-3:3)")->group(scene);
    app.add_option("--burial", burial, "Range of the buried share of the height (0.1:0.3)")->group(scene);

    const char* const rig = "Camera and light, or sonar";
    app.add_option("--mode", o.mode,
                   "overhead: the paper's camera and light; slant_range, ground_range: a side-scan sonar (overhead)")
        ->check(CLI::IsMember({"overhead", "ground_range", "slant_range"}))
        ->group(rig);
    app.add_option("--chip", o.chip,
                   "Side of the image, metres; range increases to the right\n"
                   "(overhead: 0, the field of view; side-scan modes: 5)")
        ->check(number(0, 1e4))
        ->group(rig);
    app.add_option("--altitude", altitude, "Range of altitude, metres (3.5:5; side-scan modes: 3:10)")->group(rig);
    app.add_option("--grazing", grazing, "Overhead: range of the light's grazing angle, degrees (6)")->group(rig);
    app.add_option("--distance", distance,
                   "Side-scan modes: range of the target's distance from the track, in altitudes (2:9)")
        ->group(rig);
    app.add_option("--beam", beam, "Side-scan modes: range of the along-track beamwidth, degrees (0.2:0.5)")
        ->group(rig);
    app.add_option("--intensity", o.intensity, "Overhead: intensity on a surface that faces the light (4)")
        ->check(number(0, 1e6))
        ->group(rig);
    app.add_option("--sky", o.sky, "Overhead: light from the upper hemisphere, without shadows (0.05)")
        ->check(number(0, 1e6))
        ->group(rig);
    app.add_option("--reflectivity", o.reflectivity, "Reflectivity of targets; seabeds have 0.4 to 0.6 (0.9)")
        ->check(number(0, 1e6))
        ->group(rig);

    const char* const look = "Look";
    app.add_option("--reference", o.references,
                   "Real image or folder of images to match histograms with; may be repeated")
        ->check(CLI::ExistingPath)
        ->group(look);
    app.add_option("--match", o.match,
                   "masked: match shadows with the darkest part of the reference, other pixels with the rest;\n"
                   "whole: match all pixels together (masked)")
        ->check(CLI::IsMember({"masked", "whole"}))
        ->group(look);
    app.add_option(
           "--noise", o.noise,
           "none, or a chain: speckle:0.1,gaussian:0.01,poisson:255,rayleigh; side-scan modes also take seabed,\n"
           "speckle that depends on the type of bottom (speckle:0.1; side-scan modes: seabed)")
        ->delimiter(',')
        ->group(look);
    app.add_option("--colormap", o.colormap, "gray or copper (gray)")
        ->check(CLI::IsMember({"gray", "copper"}))
        ->group(look);
    app.add_option("--display", o.display,
                   "Side-scan images: gray by amplitude, power or decibels (amplitude; recipe sonar:\n"
                   "one of these or automatic, at random)")
        ->check(CLI::IsMember({"amplitude", "power", "decibels"}))
        ->group(look);
    app.add_option(
           "--white", white,
           "Side-scan images: range of the intensity shown white; bottoms return about 0.5 (4:12; recipe sonar:\n"
           "2:32)")
        ->group(look);
    app.add_option("--display-range", display_range,
                   "Displays in decibels: range of decibels from black to white (40; recipe sonar: the instrument's)")
        ->group(look);

    try {
        app.parse(argc, argv);
        const auto given = [&](const char* name) { return !app.get_option(name)->empty(); };
        o.input_limit = input_limit << 20;
        if (!plan.empty()) apply_plan(o, plan, given);
        check_recipe(o, given);
        if (o.is_sonar()) {
            if (!given("--seabeds")) o.seabeds.clear();
            if (!given("--size")) o.size = 128;
            if (!given("--targets")) o.targets = {"ship", "plane"};
        }
        for (const char* const name : {"--chip", "--altitude", "--noise"})
            if (given(name)) o.given.insert(name);
        take_mode_defaults(o);
        if (!o.is_sonar() && !o.is_overhead()) {
            if (!given("--size")) o.size = 128;
            if (o.chip == 0)
                throw CLI::ValidationError("--chip", "'0' must be above 0 in --mode " + o.mode +
                                                         ": metres a side; only --mode overhead has a field of view");
        }
        if (o.demo && !given("--count")) o.count = 24;
        if (o.demo && !given("--noise") && o.is_overhead()) o.noise = {"speckle:0.05"};
        apply_aspects(o, aspects);
        const auto take = [](const char* name, const std::string& text, range& into, double lowest, double highest) {
            if (!text.empty()) into = parse_range(name, text);
            if (into.low < lowest || into.high > highest)
                throw CLI::ValidationError(name, "'" + text + "' must lie within " + insonify::detail::to_text(lowest) +
                                                     " and " + insonify::detail::to_text(highest));
        };
        take("--target-size", target_size, o.target_size, 1e-3, 1e3);
        take("--aspect", aspect, o.aspect, 1e-2, 1e2);
        take("--tilt", tilt, o.tilt, -90, 90);
        take("--burial", burial, o.burial, 0, 0.95);
        take("--altitude", altitude, o.altitude, 1e-2, 1e4);
        take("--grazing", grazing, o.grazing, 0.01, 90);
        take("--distance", distance, o.distance, 0, 1e3);
        take("--beam", beam, o.beam, 1e-3, 20);
        const auto take_if_given = [&](const char* name, const std::string& text, std::optional<range>& into,
                                       double lowest, double highest) {
            if (!text.empty()) take(name, text, into.emplace(), lowest, highest);
        };
        take_if_given("--white", white, o.white, 1e-3, 1e6);
        take_if_given("--display-range", display_range, o.display_range, 1, 400);
        check_mode(o, given);
        check_display(o, given);
        for (const noise_step& step : noise_steps(o))
            if (step.kind == "seabed" && has_one_mode(o) && o.is_overhead())
                throw CLI::ValidationError("--noise", "'seabed' needs a side-scan mode, such as --mode slant_range");
        check_classes(o);
        check_counts(o);
        std::vector<std::string> formats;
        for (const char* const name : format_names)
            if (std::find(o.formats.begin(), o.formats.end(), name) != o.formats.end()) formats.push_back(name);
        o.formats = formats;
        if (o.preview && !shard.empty())
            throw CLI::ValidationError("--preview", "cannot be combined with --shard; use tools/merge --preview");
        const bool needs_map = std::find(o.seabeds.begin(), o.seabeds.end(), "heightmap") != o.seabeds.end();
        if (needs_map && o.heightmap.empty())
            throw CLI::ValidationError("--seabeds", "heightmap needs --heightmap FILE");
        if (!o.heightmap.empty() && !needs_map && !(o.table && o.table->has("seabed"))) {
            if (given("--seabeds"))
                throw CLI::ValidationError("--heightmap", "has no effect; add heightmap to --seabeds");
            o.seabeds = {"heightmap"};
        }
        if (o.table) apply_plan_count(o, given);
        if (!o.per_class.empty() && !given("--count")) {
            o.count = 0;
            for (const class_count& c : class_counts(o)) o.count += c.count;
        }
        if (o.first + o.count > max_images)
            throw CLI::ValidationError("--count", std::to_string(o.count) + " images from --first " +
                                                      std::to_string(o.first) + " exceed index " +
                                                      std::to_string(max_images - 1) + "; ids have nine digits");
        if (!shard.empty()) try {
                o.shard = parse_shard(shard);
            } catch (const std::invalid_argument& error) {
                throw CLI::ValidationError("--shard", error.what());
            }
        if (o.shard.of > o.count)
            throw CLI::ValidationError("--shard", std::to_string(o.shard.of) + " shards are more than --count " +
                                                      std::to_string(o.count) + "; use at most one per image");
        check_geometry(o);
    } catch (const CLI::ParseError& error) {
        refuse(app, error);
        throw;
    }
    return o;
}

}  // namespace

options parse(int argc, const char* const* argv) {
    return parsed(argc, argv,
                  [](const CLI::App& app, const CLI::ParseError& error) { examples::exit_after(app, error); });
}

options parse_quietly(int argc, const char* const* argv) {
    try {
        return parsed(argc, argv, [](const CLI::App&, const CLI::ParseError&) {});
    } catch (const CLI::ParseError& error) {
        throw insonify::invalid_input(error.what());
    }
}

}  // namespace generator
