// recognize_real: trains on a generated set, tests on real side-scan images. See --help and tools/recognize --real DIR.
#include "../common/option_values.hpp"
#include "../common/refusal.hpp"
#include "real_report.hpp"
#include <CLI/CLI.hpp>

namespace {

using namespace recognition;

struct options {
    std::string out, real, generated;
    std::vector<std::size_t> counts{0, 20, 80, 320};
    std::size_t seeds = 10;
    int threads = 0;
};

options parse(int argc, char** argv) {
    options o;
    CLI::App app{
        "Trains a linear support vector machine and a forest of random trees on real images, with and without a\n"
        "generated set, and tests them on other real images: object or bare bottom, and plane, ship or bare bottom.",
        "recognize_real"};
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    app.add_option("--out", o.out, "Folder for real.md, roc.svg, curves.svg and three.svg; created if missing")
        ->required()
        ->check(examples::folder_to_fill());
    app.add_option("--real", o.real, "Folder with plane/, ship/ and seafloor/")->required();
    app.add_option("--generated", o.generated, "Set of generate_dataset with the classes plane, ship and empty");
    app.add_option("--counts", o.counts, "Numbers of real training images, half of them bare (0,20,80,320)")
        ->delimiter(',')
        ->check(examples::whole_number(0, 1'000'000));
    app.add_option("--seeds", o.seeds, "Number of random splits of the real images (10)")
        ->check(examples::whole_number(1, 1000));
    app.add_option("--threads", o.threads,
                   "Number of threads, 0 for one per hardware thread (0); does not change the figures")
        ->check(examples::whole_number(0, 1024));
    try {
        app.parse(argc, argv);
        std::sort(o.counts.begin(), o.counts.end());
        o.counts.erase(std::unique(o.counts.begin(), o.counts.end()), o.counts.end());
        for (const std::size_t count : o.counts)
            if (count % 2 != 0) throw CLI::ValidationError("--counts", std::to_string(count) + " is odd");
    } catch (const CLI::ParseError& error) {
        examples::exit_after(app, error);
    }
    return o;
}

collection read(const std::string& root, const std::array<std::string, 3>& folders) {
    collection all;
    for (std::size_t k = 0; k < 3; ++k) all.of_class[k] = chips_in(root + "/" + folders[k], real_classes[k]);
    return all;
}

}  // namespace

int main(int argc, char** argv) try {
    const options o = parse(argc, argv);
    cv::setNumThreads(1);
    const collection real = read(o.real, real_classes);
    const collection made =
        o.generated.empty() ? collection{} : read(o.generated + "/images", {"plane", "ship", "empty"});
    const std::size_t max_real = *std::max_element(o.counts.begin(), o.counts.end());
    const std::size_t bare = real.of_class[2].size();
    if (max_real / 2 >= real.objects() || max_real / 2 >= bare)
        throw insonify::io_error("--counts " + std::to_string(max_real) + ": " + o.real + " has " +
                                 std::to_string(real.objects()) + " objects and " + std::to_string(bare) +
                                 " bare bottoms, of which some must remain for testing");

    std::vector<std::pair<std::size_t, bool>> wanted;
    for (const std::size_t count : o.counts)
        for (const bool generated : {false, true})
            if (count > 0 ? !generated || !o.generated.empty() : generated && !o.generated.empty())
                wanted.emplace_back(count, generated);
    if (wanted.empty()) throw insonify::io_error("--counts 0: needs --generated, since no real image trains");
    std::vector<trial_result> results(wanted.size());
    insonify::thread_pool pool(o.threads);
    pool.bulk(wanted.size(), [&](std::size_t i) {
        results[i] = run_trial(real, made, wanted[i].first, wanted[i].second, max_real, o.seeds);
        std::printf("%s: %.3f\n", results[i].name().c_str(), spread(results[i].area[results[i].better()]).mean);
        std::fflush(stdout);
    });
    const double apart = o.generated.empty() ? -1 : separability(real.of_class[2], made.of_class[2]);

    const std::string report = real_markdown(results, o.seeds, real.objects() + bare - max_real, apart);
    std::filesystem::create_directories(o.out);
    insonify::write_file(o.out + "/real.md", report);
    insonify::write_file(o.out + "/roc.svg", roc_svg(results));
    insonify::write_file(o.out + "/curves.svg", curves_svg(results));
    insonify::write_file(o.out + "/three.svg", confusion_svg(results));
    std::printf("\n%s", report.c_str());
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "recognize_real: %s\n", error.what());
    return 1;
}
