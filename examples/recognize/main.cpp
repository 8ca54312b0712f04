// recognize: trains on synthetic pictures, tests on the ping simulator's. See --help.
//
// tools/recognize runs the whole experiment: builds this and ping_simulator, makes the simulator's sets, and writes the
// figures of docs/recognition.md to out/recognize.
#include "../common/option_values.hpp"
#include "../common/refusal.hpp"
#include "classifier.hpp"
#include "report.hpp"
#include <CLI/CLI.hpp>

namespace {

using namespace recognition;

struct options {
    std::string out, test, own, references;
    std::vector<std::string> recipes, tried;
    std::vector<std::size_t> sizes{80, 390};
    std::size_t seeds = 10;
    std::vector<std::size_t> synthetic{206, 191, 193};
    int threads = 0;
};

options parse(int argc, char** argv) {
    options o;
    CLI::App app{
        "Trains a support vector machine on histograms of oriented gradients of pictures that the library draws, and\n"
        "tests it on pictures of the same recipe and on those of an independent simulator. See tools/recognize.",
        "recognize"};
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    app.add_option("--out", o.out, "Folder for report.md and confusion.svg; created if missing")
        ->required()
        ->check(examples::folder_to_fill());
    app.add_option("--test", o.test, "The simulator's test set: images/<class>/*.png")->required();
    app.add_option("--own", o.own, "Another set of the simulator, which trains the upper bound `ceiling`");
    app.add_option("--references", o.references,
                   "A third set of the simulator, whose histograms recipe overhead matches; required by it");
    app.add_option("--recipes", o.recipes, "Of overhead, ground_range, slant_range; none beside --try (all)")
        ->delimiter(',')
        ->check(CLI::IsMember({"none", "overhead", "ground_range", "slant_range"}));
    app.add_option("--try", o.tried, "Another recipe: options of generate_dataset, as one word; repeat for more")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--sizes", o.sizes, "Numbers of training pictures, at least 10 (80,390)")
        ->delimiter(',')
        ->check(examples::whole_number(10, 1'000'000));
    app.add_option("--seeds", o.seeds, "Number of trainings of each kind (10)")->check(examples::whole_number(1, 1000));
    app.add_option("--synthetic-test", o.synthetic,
                   "Test pictures of each class by a recipe itself; a third of the published numbers (206,191,193)")
        ->delimiter(',')
        ->check(examples::whole_number(1, 1'000'000))
        ->expected(static_cast<int>(classes.size()));
    app.add_option("--threads", o.threads,
                   "Number of threads, 0 for one per hardware thread (0); does not change the figures")
        ->check(examples::whole_number(0, 1024));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        examples::exit_after(app, error);
    }
    return o;
}

/// Numbers of each class, in the published proportions: 21 cylinders, 27 cubes and 32 spheres of 80.
class_counts counts_of(std::size_t images) {
    class_counts c{(images * 21 + 40) / 80, (images * 27 + 40) / 80, 0};
    for (std::size_t k = 0; k < 2; ++k) c[k] = (std::max)(c[k], std::size_t{1});
    c[2] = (std::max)(images, c[0] + c[1] + 1) - c[0] - c[1];
    return c;
}

/// Numbers of each class in a set that holds those of all sizes.
class_counts counts_of_all(const std::vector<std::size_t>& sizes) {
    class_counts all{};
    for (const std::size_t images : sizes)
        for (std::size_t k = 0; k < 3; ++k) all[k] = (std::max)(all[k], counts_of(images)[k]);
    return all;
}

/// A given number of rows of each class, beginning at `from`, cyclically.
features some_of(const features& f, const class_counts& counts, const class_counts& from = {}) {
    std::array<std::vector<std::size_t>, 3> of_class;
    for (std::size_t i = 0; i < f.kinds.size(); ++i) of_class[f.kinds[i]].push_back(i);
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < counts[k]; ++i) numbers.push_back(of_class[k][(from[k] + i) % of_class[k].size()]);
    }
    return subset(f, numbers);
}

class_counts counted(const features& f) {
    class_counts c{};
    for (const std::size_t kind : f.kinds) ++c[kind];
    return c;
}

/// The experiment: trains on each set at each size with each seed, and tests on the simulator's test set.
class experiment {
  public:
    /// Reads all sets and options, so that what is wrong is refused before anything is trained.
    experiment(const options& o, std::vector<recipe> recipes)
        : options_(o),
          pool_(o.threads),
          recipes_(std::move(recipes)),
          needed_(counts_of_all(o.sizes)),
          test_(features_of(read_set(o.test))),
          simulators_(o.own.empty() ? features{} : features_of(read_set(o.own))) {
        const auto references = o.references.empty() ? std::vector<std::string>{} : class_folders(o.references);
        for (const recipe& r : recipes_) renderers_.emplace_back(r, references, pool_);
        if (o.own.empty()) return;
        const class_counts there = counted(simulators_);
        for (std::size_t k = 0; k < 3; ++k)
            if (needed_[k] > there[k])
                throw in::invalid_input("--sizes: --own has " + std::to_string(there[k]) + " of class " + classes[k] +
                                        ", " + std::to_string(needed_[k]) + " are needed");
    }

    void run() {
        for (std::size_t i = 0; i < recipes_.size(); ++i) learn_from(recipes_[i], renderers_[i]);
        if (!options_.own.empty()) learn_from_simulator();
    }

    const std::vector<outcome>& outcomes() const { return outcomes_; }
    class_counts tested() const { return counted(test_); }

  private:
    /// Trains on a recipe's pictures. A set of another seed tests it on pictures of the same recipe.
    void learn_from(const recipe& r, const set_renderer& renderer) {
        const class_counts tested{options_.synthetic[0], options_.synthetic[1], options_.synthetic[2]};
        const features own = features_of(renderer.draw_set(tested, options_.seeds + 1));
        std::vector<features> sets;
        for (std::size_t seed = 1; seed <= options_.seeds; ++seed)
            sets.push_back(features_of(renderer.draw_set(needed_, seed)));
        learn(
            r.name, r.description,
            [&](std::size_t seed, std::size_t images) { return some_of(sets[seed], counts_of(images)); }, &own);
    }

    /// Trains on the simulator's own pictures, of another seed than the test set's: an upper bound for synthetic ones.
    void learn_from_simulator() {
        const class_counts there = counted(simulators_);
        learn(
            "ceiling", "the simulator's own, from sets that overlap",
            [&](std::size_t seed, std::size_t images) {
                class_counts from;
                for (std::size_t k = 0; k < 3; ++k) from[k] = seed * there[k] / options_.seeds;
                return some_of(simulators_, counts_of(images), from);
            },
            nullptr);
    }

    template <class SetOf>
    void learn(const std::string& name, const std::string& description, const SetOf& set_of, const features* own) {
        for (const std::size_t images : options_.sizes) {
            outcome o{name, description, images, std::vector<confusion<3>>(options_.seeds), {}};
            if (own != nullptr) o.own.resize(options_.seeds);
            pool_.bulk(options_.seeds, [&](std::size_t seed) {
                const classifier machine(set_of(seed, images));
                o.transfer[seed] = {test_.kinds, machine(test_)};
                if (own != nullptr) o.own[seed] = {own->kinds, machine(*own)};
            });
            std::printf("%s, %zu: balanced accuracy %.3f\n", name.c_str(), images, balanced(o.transfer).mean);
            std::fflush(stdout);
            outcomes_.push_back(std::move(o));
        }
    }

    options options_;
    in::thread_pool pool_;
    std::vector<recipe> recipes_;
    std::vector<set_renderer> renderers_;  ///< one for each recipe
    class_counts needed_;                  ///< for the training set of any of the sizes
    features test_, simulators_;
    std::vector<outcome> outcomes_;
};

/// The requested recipes: those of the table, then those of the command line.
std::vector<recipe> chosen(const options& o) {
    std::vector<recipe> all;
    for (const recipe& r : recipes())
        if (o.recipes.empty() || std::find(o.recipes.begin(), o.recipes.end(), r.name) != o.recipes.end())
            all.push_back(r);
    for (std::size_t i = 0; i < o.tried.size(); ++i)
        all.push_back({"tried " + std::to_string(i + 1), o.tried[i], CLI::detail::split_up(o.tried[i]), false});
    return all;
}

/// @throws invalid_input for a set that is missing, and for one that is the test set, too
void check_sets(const options& o, const std::vector<recipe>& recipes) {
    if (recipes.empty() && o.own.empty()) throw in::invalid_input("--recipes none: needs --try or --own");
    for (const recipe& r : recipes)
        if (r.needs_references && o.references.empty())
            throw in::invalid_input("--recipes " + r.name + ": needs --references, whose histograms it matches");
    for (const auto& [name, folder] : {std::pair{"--own", o.own}, {"--references", o.references}})
        if (std::error_code missing; !folder.empty() && std::filesystem::equivalent(o.test, folder, missing))
            throw in::invalid_input(std::string(name) + " '" + folder + "' is the test set");
}

}  // namespace

int main(int argc, char** argv) try {
    const options o = parse(argc, argv);
    cv::setNumThreads(1);
    const std::vector<recipe> recipes = chosen(o);
    check_sets(o, recipes);
    std::filesystem::create_directories(o.out);
    experiment e(o, recipes);
    e.run();

    const std::string report = markdown(e.outcomes(), e.tested());
    in::write_file(o.out + "/report.md", report);
    in::write_file(o.out + "/confusion.svg", svg(e.outcomes()));
    std::printf("\n%s", report.c_str());
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "recognize: %s\n", error.what());
    return 1;
}
