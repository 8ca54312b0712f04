// Counts the wrong pixels of the shadow policies on imported meshes, by an independent oracle. See --help.
#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <tuple>
#include <vector>

#include "../foreign_scenes.hpp"
#include "../shadow_oracle.hpp"

namespace {

namespace in = insonify;
namespace judge = shadow_oracle;

/// The policies that can be selected.
template <class Policy>
struct named_policy {
    const char* name;
    Policy policy;
};
const std::tuple policies{named_policy<in::shadow::exact>{"exact", {}},  //
                          named_policy<in::shadow::map>{"map", {}}};

/// Policies that support point lights.
template <class Policy>
constexpr bool takes_point_light = std::is_same_v<Policy, in::shadow::exact>;

struct options {
    std::vector<std::string> policies, scenes, objs;
    std::vector<double> sizes{64, 128, 256, 512}, elevations{0.5, 2, 6, 20, 33, 45, 70, 89}, azimuths{0, 23.7, 160};
    double distance = 0;
    int threads = 2, bits = 0;
    bool each = false, builtin = true;
};

constexpr const char* help =
    "shadow_accuracy [options]: wrong pixels of shadow policies, a line for each policy and scene\n"
    "  --policy a,b        of exact, map (all)\n"
    "  --scene a,b         only scenes whose names contain one of these\n"
    "  --obj file          an OBJ file beside the built-in scenes; may be given several times\n"
    "  --no-builtin        only OBJ files\n"
    "  --sizes a,b         of the pictures, pixels a side (64,128,256,512)\n"
    "  --elevations a,b    of the light, degrees (0.5,2,6,20,33,45,70,89)\n"
    "  --azimuths a,b      degrees (0,23.7,160)\n"
    "  --distance d        of the light, metres; 0: infinitely far (0)\n"
    "  --bits n            sub-pixel bits, 4 to 16; 0: the policy's own (0)\n"
    "  --each              a line for each picture with a wrong pixel, too\n"
    "  --threads n         number of threads (2)\n"
    "wrong: false shadows and light leaks, where the pixel's centre lies in the triangle shown;\n"
    "beside: pixels whose centre misses the triangle shown, and how many of those are wrong; not in the first\n"
    "share, but in the second.\n";

std::vector<std::string> words(const std::string& list) {
    std::vector<std::string> all;
    for (std::size_t at = 0; at <= list.size();) {
        const std::size_t end = std::min(list.find(',', at), list.size());
        if (end > at) all.push_back(list.substr(at, end - at));
        at = end + 1;
    }
    return all;
}

std::vector<double> numbers(const std::string& list) {
    std::vector<double> all;
    for (const std::string& word : words(list)) {
        char* end = nullptr;
        all.push_back(std::strtod(word.c_str(), &end));
        if (*end != '\0') {
            std::fprintf(stderr, "'%s' is not a number\n", word.c_str());
            std::exit(2);
        }
    }
    return all;
}

options parse(int argc, char** argv) {
    options o;
    for (int i = 1; i < argc; ++i) {
        const std::string name = argv[i];
        if (name == "--help") std::exit(std::fputs(help, stdout) < 0);
        if (name == "--each") {
            o.each = true;
            continue;
        }
        if (name == "--no-builtin") {
            o.builtin = false;
            continue;
        }
        const std::string value = i + 1 < argc ? argv[++i] : "";
        if (name == "--policy") {
            o.policies = words(value);
        } else if (name == "--scene") {
            o.scenes = words(value);
        } else if (name == "--obj") {
            o.objs.push_back(value);
        } else if (name == "--sizes") {
            o.sizes = numbers(value);
        } else if (name == "--elevations") {
            o.elevations = numbers(value);
        } else if (name == "--azimuths") {
            o.azimuths = numbers(value);
        } else if (name == "--distance") {
            o.distance = numbers(value).at(0);
        } else if (name == "--bits") {
            o.bits = static_cast<int>(numbers(value).at(0));
        } else if (name == "--threads") {
            o.threads = static_cast<int>(numbers(value).at(0));
        } else {
            std::fprintf(stderr, "%s is not an option\n%s", name.c_str(), help);
            std::exit(2);
        }
    }
    return o;
}

bool is_chosen(const std::vector<std::string>& choices, const std::string& name) {
    return choices.empty() || std::any_of(choices.begin(), choices.end(), [&](const std::string& choice) {
               return name.find(choice) != std::string::npos;
           });
}

std::vector<foreign_scenes::foreign_scene> scenes_of(const options& o) {
    std::vector<foreign_scenes::foreign_scene> scenes;
    if (o.builtin)
        for (auto& s : foreign_scenes::all())
            if (is_chosen(o.scenes, s.name)) scenes.push_back(std::move(s));
    for (const std::string& path : o.objs) {
        std::ifstream file(path, std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        const std::size_t slash = path.find_last_of('/');
        const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
        scenes.push_back({name, foreign_scenes::standing(in::read_obj(text, name))});
    }
    return scenes;
}

void print_line(const char* policy, const std::string& scene, const judge::tally& t) {
    std::printf("%-8s %-24s %10lld %9lld %9lld %9lld %9lld %8lld  %.2e  %.2e\n", policy, scene.c_str(),
                static_cast<long long>(t.shown), static_cast<long long>(t.false_dark),
                static_cast<long long>(t.false_lit), static_cast<long long>(t.undecided),
                static_cast<long long>(t.beside), static_cast<long long>(t.beside_wrong), t.share(),
                t.share_with_beside());
    std::fflush(stdout);
}

/// One policy in all pictures of one scene.
template <class Policy>
judge::tally measure(const named_policy<Policy>& p, const foreign_scenes::foreign_scene& s, const judge::oracle& truth,
                     const options& o, in::thread_pool& pool) {
    judge::tally all;
    for (const double size : o.sizes)
        for (const double elevation : o.elevations)
            for (const double azimuth : o.azimuths) {
                in::overhead rig = foreign_scenes::rig(azimuth, elevation, static_cast<int>(size));
                if (o.distance > 0) rig.light_distance = static_cast<float>(o.distance);
                in::render_options<Policy> how{.shadow = p.policy};
                if (o.bits > 0) how.subpixel_bits = o.bits;
                const auto frame = in::render(s.scene, rig, how, pool);
                const auto shown = in::visible_triangles(s.scene, rig, how, pool);
                if (!(shown.instance == frame.labels.instance)) {
                    std::fprintf(stderr, "%s: the replayed visibility differs from the picture's\n", s.name.c_str());
                    std::exit(1);
                }
                const judge::tally t = judge::compare(truth.judge(rig, shown, pool), frame.labels);
                if (o.each && t.wrong() + t.beside_wrong > 0) {
                    char where[64];
                    std::snprintf(where, sizeof where, " %g px, %g, %g deg", size, elevation, azimuth);
                    print_line(p.name, s.name + where, t);
                }
                all += t;
            }
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    const options o = parse(argc, argv);
    in::thread_pool pool(o.threads);
    const auto scenes = scenes_of(o);
    std::printf("%-8s %-24s %10s %9s %9s %9s %9s %8s  %s  %s\n", "policy", "scene", "pixels", "not lit", "not dark",
                "undecided", "beside", "wrong", "share   ", "with beside");
    const auto start = std::chrono::steady_clock::now();
    std::vector<judge::tally> totals(std::tuple_size_v<decltype(policies)>);
    for (const auto& s : scenes) {
        const judge::oracle truth(s.scene, foreign_scenes::rig(0, 45, 64));
        std::size_t at = 0;
        const auto run = [&]<class Policy>(const named_policy<Policy>& p) {
            judge::tally& total = totals[at++];
            if (!is_chosen(o.policies, p.name) || (o.distance > 0 && !takes_point_light<Policy>)) return;
            const judge::tally t = measure(p, s, truth, o, pool);
            print_line(p.name, s.name, t);
            total += t;
        };
        std::apply([&](const auto&... p) { (run(p), ...); }, policies);
    }
    std::size_t at = 0;
    const auto sum = [&](const auto& p) {
        if (totals[at].shown > 0) print_line(p.name, "all", totals[at]);
        ++at;
    };
    std::apply([&](const auto&... p) { (sum(p), ...); }, policies);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    std::fprintf(stderr, "%.1f s\n", took.count());
}
