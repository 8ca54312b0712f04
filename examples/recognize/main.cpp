// recognize: how well is recognised what was learnt from synthetic pictures? See --help.
//
// ./tools/recognize runs all of it: it builds this and ping_simulator, makes the simulator's sets, and writes the
// figures of docs/recognition.md to out/recognize.
#include "../common/progress.hpp"
#include "classifier.hpp"
#include "report.hpp"
#include <CLI/CLI.hpp>

namespace {

using namespace recognition;

struct options {
    std::string out, test, own, references;
    std::vector<std::string> recipes;
    std::vector<std::size_t> sizes{80, 390};
    std::size_t seeds = 10;
    double synthetic_share = 1;
    int threads = 0;
};

options parse(int argc, char** argv) {
    options o;
    CLI::App app{
        "Trains histograms of oriented gradients and a support vector machine on pictures that the library draws, and\n"
        "tries them on pictures of the same recipe and on those of an independent simulator. See tools/recognize.",
        "recognize"};
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    app.add_option("--out", o.out, "Folder for report.md, confusion.svg and runs.csv; made if need be")->required();
    app.add_option("--test", o.test, "The simulator's test set: images/<class>/*.png")->required();
    app.add_option("--own", o.own, "Another set of the simulator, to train the ceiling on");
    app.add_option("--references", o.references, "A third one, to match histograms with where a recipe does");
    app.add_option("--recipes", o.recipes, "Of overhead, ground_range, slant_range (all)")->delimiter(',');
    app.add_option("--sizes", o.sizes, "How many training pictures, 3 at least (80,390)")->delimiter(',');
    app.add_option("--seeds", o.seeds, "Trainings of each kind (10)")->check(CLI::Range(1, 1000));
    app.add_option("--synthetic-share", o.synthetic_share, "Of the published 619, 573 and 578 test pictures (1)")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--threads", o.threads, "0: one for each hardware thread; never changes a figure");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::exit(app.exit(error) == 0 ? 0 : 2);
    }
    return o;
}

/// So many of each class, in the published proportions: 21 cylinders, 27 cubes and 32 spheres of 80.
class_counts shares(std::size_t images) {
    class_counts c{(images * 21 + 40) / 80, (images * 27 + 40) / 80, 0};
    for (std::size_t k = 0; k < 2; ++k) c[k] = (std::max)(c[k], std::size_t{1});
    c[2] = (std::max)(images, c[0] + c[1] + 1) - c[0] - c[1];
    return c;
}

/// The first so many rows of each class, from a start that wraps around.
std::vector<std::size_t> first_of(const features& f, const class_counts& counts, const class_counts& starts) {
    std::array<std::vector<std::size_t>, 3> of_class;
    for (std::size_t i = 0; i < f.kinds.size(); ++i) of_class[f.kinds[i]].push_back(i);
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < counts[k]; ++i)
            numbers.push_back(of_class[k][(starts[k] + i) % of_class[k].size()]);
    return numbers;
}

/// Trains at every size and tries each machine on its own kind and on the simulator's.
void learn(const options& o, const features& training, const class_counts& starts, const features* own,
           const features& test, std::vector<outcome>& outcomes) {
    for (std::size_t s = 0; s < o.sizes.size(); ++s) {
        const classifier machine(subset(training, first_of(training, shares(o.sizes[s]), starts)));
        outcomes[s].transfer.emplace_back(test.kinds, machine(test));
        if (own != nullptr) outcomes[s].own.emplace_back(own->kinds, machine(*own));
    }
}

std::vector<outcome> blank(const options& o, const std::string& name, const std::string& description) {
    std::vector<outcome> outcomes;
    for (const std::size_t size : o.sizes) outcomes.push_back({name, description, size, {}, {}});
    return outcomes;
}

class_counts counted(const features& f) {
    class_counts c{};
    for (const std::size_t kind : f.kinds) ++c[kind];
    return c;
}

}  // namespace

int main(int argc, char** argv) try {
    const options o = parse(argc, argv);
    cv::setNumThreads(1);
    in::thread_pool pool(o.threads);
    const features test = features_of(read_set(o.test));
    const std::size_t most = *std::max_element(o.sizes.begin(), o.sizes.end());

    std::vector<outcome> outcomes;
    for (const recipe& r : recipes()) {
        if (!o.recipes.empty() && std::find(o.recipes.begin(), o.recipes.end(), r.name) == o.recipes.end()) continue;
        const generator::options drawing =
            options_of(r, o.references.empty() ? std::vector<std::string>{} : class_folders(o.references));
        const generator::stock shared(drawing);
        const auto of = [&](double n) { return static_cast<std::size_t>(n * o.synthetic_share + 0.5); };
        const features own = features_of(draw_set(drawing, shared, {of(619), of(573), of(578)}, o.seeds + 1, pool));
        std::vector<outcome> of_recipe = blank(o, r.name, r.description);
        std::vector<std::vector<outcome>> runs(o.seeds, of_recipe);
        std::vector<features> sets;
        for (std::size_t seed = 1; seed <= o.seeds; ++seed)
            sets.push_back(features_of(draw_set(drawing, shared, shares(most), seed, pool)));
        pool.bulk(o.seeds, [&](std::size_t i) { learn(o, sets[i], {}, &own, test, runs[i]); });
        for (const auto& run : runs)
            for (std::size_t s = 0; s < run.size(); ++s) {
                of_recipe[s].transfer.push_back(run[s].transfer.front());
                of_recipe[s].own.push_back(run[s].own.front());
            }
        outcomes.insert(outcomes.end(), of_recipe.begin(), of_recipe.end());
        for (const outcome& out : of_recipe)
            std::printf("%-13s %4zu: %.3f own, %.3f simulator's\n", out.name.c_str(), out.images,
                        balanced(out.own).mean, balanced(out.transfer).mean);
        std::fflush(stdout);
    }
    (void)counted;
    const std::string report = markdown(outcomes, counted(test));
    std::puts(report.c_str());
    std::filesystem::create_directories(o.out);
    in::write_file(o.out + "/report.md", report);
    in::write_file(o.out + "/confusion.svg", svg(outcomes));
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "recognize: %s\n", error.what());
    return 1;
}
