// The training sets that are compared: each is a command line of generate_dataset, drawn by the same code.
#pragma once

#include <insonify/core/thread_pool.hpp>

#include <array>

#include "../generate_dataset/draw.hpp"

namespace recognition {

namespace in = insonify;

inline const std::array<std::string, 3> classes{"cylinder", "cube", "sphere"};
using class_counts = std::array<std::size_t, 3>;

/// The objects as options of generate_dataset. Only their sizes are known beforehand: these ranges include the
/// simulator's.
inline const std::array<std::vector<std::string>, 3> objects{
    {{"--targets", "cylinder", "--target-size", "0.4:0.6", "--aspect", "0.9:1.15"},
     {"--targets", "cube", "--target-size", "0.4:0.8", "--aspect", "1"},
     {"--targets", "sphere", "--target-size", "0.5:0.9", "--aspect", "1"}}};

/// A picture and its class.
struct example {
    in::image<std::uint8_t> picture;
    std::size_t kind;
};

struct recipe {
    std::string name, description;
    std::vector<std::string> arguments;  ///< of generate_dataset
    bool needs_references = false;
};

/// From the published recipe to the recommended one.
inline std::vector<recipe> recipes() {
    return {{"overhead",
             "(a) as published: camera and parallel light, mud, histograms matched, uniform speckle",
             {"--mode", "overhead", "--seabeds", "mud", "--noise", "speckle:0.1"},
             true},
            {"ground_range",
             "(b) ground range: the sonar's shadows on a map, three seabeds, uniform speckle",
             {"--mode", "ground_range", "--seabeds", "sand,mud,ripples", "--noise", "speckle:0.1"}},
            {"slant_range",
             "(c) slant range, three seabeds, speckle that depends on them",
             {"--mode", "slant_range", "--seabeds", "sand,mud,ripples", "--noise", "seabed"}}};
}

/// The options that generate_dataset reads from the recipe's command line, for one class.
/// @param references  folders of pictures to match histograms with, for recipes that do
inline generator::options options_of(const recipe& r, std::size_t kind, const std::vector<std::string>& references) {
    std::vector<std::string> words{
        "generate_dataset", "--recipe", "published", "--out", "-",        "--aspects", "random",
        "--chip",           "5",        "--pixels",  "128",   "--burial", "0:0.3"};
    words.insert(words.end(), objects[kind].begin(), objects[kind].end());
    words.insert(words.end(), r.arguments.begin(), r.arguments.end());
    if (r.needs_references && !references.empty()) {
        words.push_back("--reference");
        words.insert(words.end(), references.begin(), references.end());
    }
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    generator::options o = generator::parse(static_cast<int>(pointers.size()), pointers.data());
    if (o.colormap != "gray")
        throw in::invalid_input("--try: --colormap " + o.colormap + " has no gray values to recognise by");
    return o;
}

/// Draws sets of one recipe.
class set_renderer {
  public:
    set_renderer(const recipe& r, const std::vector<std::string>& references, in::thread_pool& pool)
        : pool_(pool), shared_(options_of(r, 0, references)) {
        for (std::size_t kind = 0; kind < classes.size(); ++kind) of_class_.push_back(options_of(r, kind, references));
    }

    /// Pictures of each class, on the seabeds in turn. Sets of different seeds share no picture.
    std::vector<example> draw_set(const class_counts& counts, std::uint64_t seed) const {
        std::vector<generator::options> of_class = of_class_;
        std::vector<std::pair<std::size_t, std::size_t>> wanted;  // class and number
        for (std::size_t kind = 0; kind < classes.size(); ++kind) {
            of_class[kind].seed = classes.size() * seed + kind;
            for (std::size_t i = 0; i < counts[kind]; ++i) wanted.emplace_back(kind, i);
        }
        std::vector<example> set(wanted.size());
        pool_.bulk(wanted.size(), [&](std::size_t i) {
            const auto [kind, number] = wanted[i];
            in::serial_executor alone;
            const generator::plan p = generator::plan_image(of_class[kind], number, shared_);
            set[i] = {generator::draw(of_class[kind], p, shared_, alone).gray, kind};
        });
        return set;
    }

  private:
    in::thread_pool& pool_;
    generator::shared_inputs shared_;
    std::vector<generator::options> of_class_;
};

/// The folders of a set's classes: images/<class>.
inline std::vector<std::string> class_folders(const std::string& root) {
    std::vector<std::string> folders;
    for (const std::string& name : classes) folders.push_back(root + "/images/" + name);
    return folders;
}

/// Reads a set that lies in images/<class>/<anything>.png.
/// @throws io_error for a class without a picture
inline std::vector<example> read_set(const std::string& root) {
    std::vector<example> set;
    const std::vector<std::string> folders = class_folders(root);
    for (std::size_t kind = 0; kind < classes.size(); ++kind) {
        std::vector<std::string> paths;
        if (std::filesystem::is_directory(folders[kind]))
            for (const auto& entry : std::filesystem::directory_iterator(folders[kind]))
                if (entry.path().extension() == ".png") paths.push_back(entry.path().string());
        if (paths.empty()) throw in::io_error(folders[kind] + ": holds no PNG");
        std::sort(paths.begin(), paths.end());
        for (const std::string& path : paths) set.push_back({examples::read_gray(path) | in::to_uint8, kind});
    }
    return set;
}

}  // namespace recognition
