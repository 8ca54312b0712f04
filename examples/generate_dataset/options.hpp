// The options of a data set, from the command line or a config file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "../common/input_file.hpp"
#include "object_kinds.hpp"
#include "plan_table.hpp"
#include "shard.hpp"

namespace generator {

/// The seabeds of the recipe `published`.
inline constexpr const char* seabed_names[] = {"ripples", "mud", "rock", "sand", "mixed", "heightmap"};

/// Bounds of a value that is drawn uniformly for each image; a constant has low == high.
struct range {
    double low, high;
};

struct options {
    // Output: these do not change any image.
    std::string out;
    std::uint64_t first = 0, count = 24;
    generator::shard shard;
    bool verify = false, preview = false, dry_run = false;
    int threads = 0;
    std::uint64_t input_limit = examples::usual_input_limit;  ///< bytes

    // Content: these decide the pixels and are pinned in config.json.

    std::string recipe = "sonar";             ///< or "published"
    std::shared_ptr<const plan_table> table;  ///< `--plan`; null without one
    std::vector<double> aspects;              ///< shown of each target, degrees; empty: random
    std::string place;                        ///< of targets: "third", "anywhere" or empty (decided by the recipe)
    std::uint64_t seed = 1;
    int size = 2048;
    double visible_share = 0.1;          ///< lower bound, share of a target's outline; recipe sonar
    double empty = 0.4;                  ///< share of images without a target, recipe sonar
    std::vector<std::string> per_class;  ///< class=count
    std::vector<std::string> targets = primitive_names();
    std::vector<std::string> meshes;  ///< class=path
    std::string mesh_up = "y";
    std::vector<std::string> seabeds{"ripples", "mud", "rock"};
    std::string heightmap;
    double heightmap_spacing = 0.02, heightmap_scale = 1;
    range target_size{0.4, 0.8}, aspect{0.8, 1.25}, tilt{-3, 3}, burial{0.1, 0.3};
    std::string mode = "overhead";
    double chip = 0;       ///< metres a side; 0: the field of view
    range altitude{0, 0};  ///< metres
    std::vector<std::string> noise;
    std::set<std::string> given;  ///< of these three; the mode decides the others
    range grazing{6, 6}, distance{2, 9}, beam{0.2, 0.5};
    double reflectivity = 0.9, intensity = 4, sky = 0.05;
    std::vector<std::string> references;
    std::string match = "masked";
    std::string colormap = "gray";
    std::string display;                        ///< amplitude, power, decibels, or empty (decided by the recipe)
    std::optional<range> white, display_range;  ///< intensity shown white, decibels; null: the recipe's
    std::vector<std::string> formats;           ///< in addition to 8-bit PNG, in the order of `format_names`
    bool demo = false;

    bool is_overhead() const { return mode == "overhead"; }
    bool is_sonar() const { return recipe == "sonar"; }
};

/// One step of the noise chain: a kind and its strength.
struct noise_step {
    std::string kind;
    double strength;
};

/// Sets what the mode decides: chip, altitude and noise, where they are not given.
void take_mode_defaults(options& o);

/// The noise chain of valid options.
std::vector<noise_step> noise_steps(const options& o);

/// Parses the command line. On --help or an error, prints and exits.
options parse(int argc, const char* const* argv);

/// Parses the command line without printing or exiting.
/// @throws invalid_input for an invalid command line and for --help
options parse_quietly(int argc, const char* const* argv);

}  // namespace generator
