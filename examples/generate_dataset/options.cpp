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

std::vector<noise_step> noise_steps(const options& o) {
    std::vector<noise_step> steps;
    for (const std::string& text : o.noise)
        if (text != "none") steps.push_back(parse_noise(text));
    return steps;
}

namespace {

/// Help without the validators' shorthand: what a value may be is said in words.
struct plain_formatter : CLI::Formatter {
    plain_formatter() { column_width(30); }
    std::string make_option_opts(const CLI::Option* option) const override {
        return option->get_expected_max() == 0 ? "" : option->get_required() ? " VALUE (needed)" : " VALUE";
    }
};

/// Ranges that are fine one by one may be too much together.
void check_geometry(const options& o) {
    const auto text = [](double value) { return insonify::detail::to_text(value); };
    if (o.is_overhead()) {
        if (o.chip > 1000 * o.altitude.low)
            throw CLI::ValidationError("--chip", text(o.chip) + " m from an --altitude of " + text(o.altitude.low) +
                                                     " m is wider than a camera sees; take at most 1000 altitudes");
        return;
    }
    const double farthest = (o.distance.high + 1) * o.altitude.high + o.chip;
    if (farthest > 1e5)
        throw CLI::ValidationError("--distance", text(o.distance.high) + " times an --altitude of " +
                                                     text(o.altitude.high) + " m, and a --chip of " + text(o.chip) +
                                                     " m, end beyond 100000 m; take less of one of them");
}

options parsed(int argc, const char* const* argv,
               const std::function<void(const CLI::App&, const CLI::ParseError&)>& refuse) {
    options o;
    CLI::App app{
        "Makes labelled side-scan sonar images: for every image a target on a seabed, camera and light posed,\n"
        "rendered, given the look of a reference, and written with its masks.\n\n"
        "Image i depends on the seed and i alone. A run checks what is there by checksum, repairs what is not what it\n"
        "was, and goes on where another one stopped.",
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
    std::string shard, plan, aspects, target_size, aspect, tilt, burial, altitude, grazing, distance, beam;
    const CLI::Validator target_names =
        CLI::IsMember({"cylinder", "cube", "cone", "sphere", "ship", "plane", "truncated_cone", "wedge", "tyre", "pipe",
                       "boulder", "crate", "lobster_pot"});
    const CLI::Validator seabed_names = CLI::IsMember({"ripples", "mud", "rock", "sand", "mixed", "heightmap"});

    const char* const what = "What to make";
    app.add_option("--out", o.out, "Folder of the data set; made if need be")
        ->required()
        ->check([](const std::string& name) { return name.empty() ? "this is no folder's name" : ""; })
        ->group(what);
    app.add_option("--count", o.count, "How many images (24)")->check(whole_number(1, most_images))->group(what);
    app.add_option("--first", o.first, "Index of the first image (0)")
        ->check(whole_number(0, most_images - 1))
        ->group(what);
    app.add_option(
           "--shard", shard,
           "K/N: of N contiguous shares of the set, make that with number K, from 0. N alone: K is the number of\n"
           "this task in a job array, SLURM_ARRAY_TASK_ID or JOB_COMPLETION_INDEX. tools/merge joins the shards")
        ->group(what);
    app.add_flag("--verify", o.verify, "Make nothing; check every file of the set, and decode it")->group(what);
    app.add_flag("--dry-run", o.dry_run,
                 "Make nothing; say what would be made: counts, size, estimates of time and bytes")
        ->group(what);
    app.add_option("--seed", o.seed, "Another seed is another data set (1)")
        ->check(whole_number(0, UINT64_MAX))
        ->group(what);
    app.add_option("--size,--pixels", o.size, "Pixels a side (2048; 128 for a sonar's modes)")
        ->check(whole_number(16, 16384))
        ->group(what);
    app.add_option("--threads", o.threads, "0: one for each hardware thread; never changes a byte")
        ->check(whole_number(0, 1024))
        ->group(what);
    app.add_option("--input-limit", input_limit, "Largest file taken as an input, MiB (1024)")
        ->check(whole_number(1, 1 << 20))
        ->group(what);
    app.add_option("--format", o.formats,
                   "Beside PNG of 8 bits: png16, npy, pfm (what an image shows, 16 bits or float), and webdataset\n"
                   "(tar files of a thousand samples each)")
        ->delimiter(',')
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(format_names), std::end(format_names))))
        ->group(what);
    app.add_flag("--preview", o.preview, "Write preview.html, a page to look through the set")->group(what);
    app.add_flag("--demo", o.demo, "All targets on all seabeds, plain and with a reference")->group(what);

    app.add_option("--recipe", o.recipe,
                   "sonar: wrecks, aeroplanes and bare bottoms as side-scan sonars show them;\n"
                   "published: the paper's primitives, camera and light, or a sonar's modes over them (sonar)")
        ->check(CLI::IsMember({"sonar", "published"}))
        ->group(what);

    app.add_option(
           "--plan", plan,
           "CSV with a line for each image or target, that gives what is drawn at random otherwise: the\n"
           "manifest.csv of a set, which makes it again, or a table of targets (id, shape, length, width, height,\n"
           "orientation), each shown at every aspect on every seabed")
        ->check(CLI::ExistingFile)
        ->group(what);

    const char* const scene = "Scene";
    app.add_option("--aspects", aspects,
                   "first:step:last or a list, degrees from the line of sight: each target at each of them; or random\n"
                   "(recipe published from overhead: 0:10:350; otherwise random)")
        ->group(scene);
    app.add_option("--place", o.place,
                   "Where a picture has its target: at one third, or anywhere (as the recipe has it)")
        ->check(CLI::IsMember({"third", "anywhere"}))
        ->group(scene);
    app.add_option("--visible-share", o.visible_share,
                   "Recipe sonar: share of its outline that a target shows at least, or it is drawn again (0.1)")
        ->check(number(0, 1))
        ->group(scene);
    app.add_option("--empty", o.empty, "Recipe sonar: share of images without a target, a class of their own (0.5)")
        ->check(number(0, 1))
        ->group(scene);
    app.add_option("--per-class", o.per_class,
                   "CLASS=COUNT,...: so many images of each class, one class after the other, instead of taking turns")
        ->delimiter(',')
        ->group(scene);
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
    app.add_option("--heightmap", o.heightmap,
                   "PNG of 8 or 16 bits, PGM or PFM with heights, for the seabed `heightmap`")
        ->check(CLI::ExistingFile)
        ->group(scene);
    app.add_option("--heightmap-spacing", o.heightmap_spacing, "Metres from pixel to pixel (0.02)")
        ->check(number(1e-4, 1e4))
        ->group(scene);
    app.add_option("--heightmap-scale", o.heightmap_scale, "Metres for a full-scale pixel (1)")
        ->check(number(-1e6, 1e6))
        ->group(scene);
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
        ->check(number(0, 1e4))
        ->group(rig);
    app.add_option("--altitude", altitude, "Range: metres above the sea floor (3.5:5; a sonar's: 3:10)")->group(rig);
    app.add_option("--grazing", grazing, "Range: light above the sea floor, degrees (6)")->group(rig);
    app.add_option("--distance", distance, "Range: of the target from a sonar's track, in altitudes (2:9)")->group(rig);
    app.add_option("--beam", beam, "Range: width of a sonar's beam along the track, degrees (0.2:0.5)")->group(rig);
    app.add_option("--intensity", o.intensity, "Light on a surface that faces it (4)")
        ->check(number(0, 1e6))
        ->group(rig);
    app.add_option("--sky", o.sky, "Light from everywhere (0.05)")->check(number(0, 1e6))->group(rig);
    app.add_option("--reflectivity", o.reflectivity, "Of targets; seabeds have 0.4 to 0.6 (0.9)")
        ->check(number(0, 1e6))
        ->group(rig);

    const char* const look = "Look";
    app.add_option("--reference", o.references,
                   "Real image or folder of images to match histograms with; repeat for more")
        ->check(CLI::ExistingPath)
        ->group(look);
    app.add_option(
           "--match", o.match,
           "masked: shadows take the reference's darkest part, the rest the rest; whole: all pixels as one (masked)")
        ->check(CLI::IsMember({"masked", "whole"}))
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
        o.input_limit = input_limit << 20;
        if (!plan.empty()) take_plan(o, plan, given);
        if (o.is_sonar()) {
            // What only the other recipe has is refused, not left out in silence.
            for (const char* const name :
                 {"--demo", "--mesh",         "--heightmap", "--target-size", "--aspect",   "--tilt",    "--burial",
                  "--mode", "--chip",         "--altitude",  "--grazing",     "--distance", "--beam",    "--intensity",
                  "--sky",  "--reflectivity", "--reference", "--match",       "--noise",    "--colormap"})
                if (given(name))
                    throw CLI::ValidationError(name, "belongs to --recipe published; the recipe sonar draws its own");
            if (given("--seabeds") && !o.table)
                throw CLI::ValidationError("--seabeds", "belongs to --recipe published, or to a --plan");
            if (given("--aspects") && !o.table)
                throw CLI::ValidationError("--aspects", "belongs to --recipe published, or to a --plan");
            if (!given("--seabeds")) o.seabeds.clear();
            if (!given("--size")) o.size = 128;
            if (!given("--targets")) o.targets = {"ship", "plane"};
        } else {
            for (const char* const name : {"--empty", "--visible-share"})
                if (given(name)) throw CLI::ValidationError(name, "belongs to --recipe sonar");
            for (const std::string& target : o.targets)
                if (target != "cylinder" && target != "cube" && target != "cone" && target != "sphere")
                    throw CLI::ValidationError("--targets", "'" + target + "' belongs to --recipe sonar");
        }
        if (!o.is_sonar() && !o.is_overhead()) {
            if (!given("--size")) o.size = 128;
            if (o.chip == 0) o.chip = 5;
            if (!given("--noise")) o.noise = {"seabed"};
            o.altitude = {3, 10};
        }
        take_aspects(o, aspects);
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
        check_classes(o);
        check_counts(o);
        std::vector<std::string> formats;
        for (const char* const name : format_names)
            if (std::find(o.formats.begin(), o.formats.end(), name) != o.formats.end()) formats.push_back(name);
        o.formats = formats;
        if (o.preview && !shard.empty())
            throw CLI::ValidationError("--preview", "a shard is no whole set; merge it with tools/merge --preview");
        const bool needs_map = std::find(o.seabeds.begin(), o.seabeds.end(), "heightmap") != o.seabeds.end();
        if (needs_map && o.heightmap.empty())
            throw CLI::ValidationError("--seabeds", "heightmap needs --heightmap FILE");
        if (!o.heightmap.empty() && !needs_map && !(o.table && o.table->has("seabed"))) o.seabeds = {"heightmap"};
        if (o.table) count_plan(o, given);
        if (o.demo && !given("--count")) o.count = 24;
        if (!o.per_class.empty() && !given("--count")) {
            o.count = 0;
            for (const class_count& c : class_counts(o)) o.count += c.count;
        }
        if (o.first + o.count > most_images)
            throw CLI::ValidationError("--count", std::to_string(o.count) + " images from --first " +
                                                      std::to_string(o.first) + " on end above index " +
                                                      std::to_string(most_images - 1) + "; ids have nine digits");
        if (!shard.empty()) try {
                o.shard = parse_shard(shard);
            } catch (const std::invalid_argument& error) {
                throw CLI::ValidationError("--shard", error.what());
            }
        if (o.shard.of > o.count)
            throw CLI::ValidationError("--shard", std::to_string(o.shard.of) + " shards are more than --count " +
                                                      std::to_string(o.count) + "; take at most one for each image");
        check_geometry(o);
    } catch (const CLI::ParseError& error) {
        refuse(app, error);
        throw;
    }
    if (o.demo && app.get_option("--noise")->empty() && o.is_overhead()) o.noise = {"speckle:0.05"};
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
