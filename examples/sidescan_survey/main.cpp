// sidescan_survey: a vehicle runs along way-points over a seabed with targets and leaves a waterfall of both sides, its
// labels, its navigation, a line per contact, and a map. See --help.
//
// It works in blocks of pings and keeps nothing but the block: a track of any length takes the same memory.
#include <insonify/core/thread_pool.hpp>
#include <insonify/insonify.hpp>

#include <filesystem>

#include "../common/progress.hpp"
#include "chart.hpp"
#include "logbook.hpp"
#include "vehicle.hpp"
#include <CLI/CLI.hpp>

namespace {

namespace in = insonify;

struct options {
    std::string out, waypoints, bottom = "ripples+mud";
    double length = 60, width = 80, between = 40;
    survey::handling handling{};
    double range = 30, beam = 0.3, targets = 0.5;
    int bins = 1024, page = 1024, threads = 0;
    std::uint64_t seed = 1;
};

options parse(int argc, char** argv) {
    options o;
    CLI::App app{"Runs a side-scan survey and writes its waterfall, labels, navigation, contacts and map.",
                 "sidescan_survey"};
    app.add_option("--out", o.out, "Folder; made if need be")->required();
    app.add_option("--waypoints", o.waypoints, "File of lines x,y in metres; otherwise legs to and fro");
    app.add_option("--length", o.length, "Of a leg, metres (60)")->check(CLI::Range(1.0, 1e6));
    app.add_option("--width", o.width, "Of the surveyed area, metres (80)")->check(CLI::Range(0.0, 1e6));
    app.add_option("--between", o.between, "From leg to leg, metres (40)")->check(CLI::Range(1.0, 1e6));
    app.add_option("--speed", o.handling.speed, "Metres per second (1.5)")->check(CLI::Range(0.01, 100.0));
    app.add_option("--ping-rate", o.handling.ping_rate, "Per second (15)")->check(CLI::Range(0.1, 1000.0));
    app.add_option("--turn-rate", o.handling.turn_rate, "Degrees per second at most (6)")
        ->check(CLI::Range(0.1, 360.0));
    app.add_option("--altitude", o.handling.altitude, "Metres (6)")->check(CLI::Range(0.1, 1000.0));
    app.add_option("--altitude-change", o.handling.altitude_change, "Slow rise and fall, metres (1.5)");
    app.add_option("--heave", o.handling.heave, "Rise and fall with the swell, metres (0.15)");
    app.add_option("--range", o.range, "Of each side, metres (30)")->check(CLI::Range(1.0, 1e4));
    app.add_option("--bins", o.bins, "Of each side (1024)")->check(CLI::Range(8, 65536));
    app.add_option("--beam", o.beam, "Width along the track, degrees (0.3)")->check(CLI::Range(1e-3, 20.0));
    app.add_option("--targets", o.targets, "How many, per square of 10 m (0.5)")->check(CLI::Range(0.0, 1.0));
    app.add_option("--bottom", o.bottom, "ripples+mud, ripples+sand, sand+rock or mud+rock (ripples+mud)")
        ->check(CLI::IsMember({"ripples+mud", "ripples+sand", "sand+rock", "mud+rock"}));
    app.add_option("--page", o.page, "Rows of a page (1024)")->check(CLI::Range(16, 16384));
    app.add_option("--seed", o.seed, "Another seed is another seabed, with other targets (1)");
    app.add_option("--threads", o.threads, "0: one for each hardware thread; never changes a byte");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::exit(app.exit(error) == 0 ? 0 : 2);
    }
    return o;
}

in::seabed::any bottom_of(const options& o) {
    const auto kind = [&](const std::string& name) -> in::seabed::simple {
        if (name == "ripples") return in::seabed::ripples{.wavelength = 0.7f, .height = 0.05f, .seed = o.seed};
        if (name == "mud") return in::seabed::mud{.seed = o.seed};
        if (name == "rock") return in::seabed::rock{.seed = o.seed};
        return in::seabed::flat{.seed = o.seed};
    };
    const std::size_t plus = o.bottom.find('+');
    return in::seabed::blend{.first = kind(o.bottom.substr(0, plus)),
                             .second = kind(o.bottom.substr(plus + 1)),
                             .patch = 18,
                             .seed = o.seed};
}

/// One side of a block: gray values and labels, a row per ping.
struct channel {
    in::image<std::uint8_t> gray;
    in::labels labels;
};

template <class T>
in::image<T> rows(const in::image<T>& all, int first, int count) {
    return in::image<T>(all.view().part(0, first, all.width(), count));
}

}  // namespace

int main(int argc, char** argv) try {
    const options o = parse(argc, argv);
    std::filesystem::create_directories(o.out + "/pages");
    in::thread_pool pool(o.threads);
    const std::vector<glm::dvec2> waypoints =
        o.waypoints.empty() ? survey::lawnmower(o.length, o.width, o.between) : survey::read_waypoints(o.waypoints);
    const in::seabed::any seabed = bottom_of(o);
    const survey::target_field field(seabed, 10, o.targets, o.seed);

    // Once along the track without a sonar: how many pings there will be, and what the map shows.
    std::int64_t total = 0;
    glm::dvec2 low(1e30), high(-1e30);
    survey::fix f{};
    for (survey::vehicle scout(o.handling, waypoints); scout.ping(f); ++total) {
        low = {(std::min)(low.x, f.at.position.x), (std::min)(low.y, f.at.position.y)};
        high = {(std::max)(high.x, f.at.position.x), (std::max)(high.y, f.at.position.y)};
    }
    if (total == 0) throw in::io_error("the way-points leave no room for a ping");
    survey::chart map(seabed, low - o.range, high + o.range, 1200, pool);

    survey::vehicle vehicle(o.handling, waypoints);
    in::side_scan rig{.altitude = static_cast<float>(o.handling.altitude),
                      .ping_spacing = static_cast<float>(vehicle.spacing()),
                      .range = static_cast<float>(o.range),
                      .bins = o.bins};
    const in::horizontal_beam beam{static_cast<float>(in::numeric::to_radians(o.beam))};
    const in::sonar_equation equation{
        in::transmission_loss{},   in::absorption{}, in::vertical_beam{.side_lobes = 0.01f}, beam, in::pulse{},
        in::noise_floor{2.5e-13f}, in::level_gain{}};
    using all = in::record_options<in::labels, in::lambert_backscatter, std::remove_const_t<decltype(equation)>>;
    const in::seabed_speckle speckle{.seed = o.seed};
    const in::display display{.white = 6};
    const int halo = in::detail::beam_reach(beam, rig);

    survey::pgm_stream waterfall(o.out + "/waterfall.pgm", 2 * o.bins, total, 255);
    survey::pgm_stream instances(o.out + "/targets.pgm", 2 * o.bins, total, 65535);
    survey::pgm_stream shadows(o.out + "/shadows.pgm", 2 * o.bins, total, 65535);
    survey::pgm_stream types(o.out + "/seabed.pgm", 2 * o.bins, total, 255);
    survey::pages pages(o.out + "/pages", 2 * o.bins, o.page);
    survey::csv_stream navigation(o.out + "/navigation.csv",
                                  "ping,time_s,x_m,y_m,altitude_over_datum_m,altitude_over_bottom_m,heading_deg");
    survey::contact_list contacts(o.out + "/contacts.csv");
    const auto bottom = in::seabed::prepare(seabed);

    examples::progress bar(static_cast<std::size_t>(total));
    constexpr int block = 128;
    std::vector<survey::fix> window;  // the block, with the pings before and after it that its beam hears
    int before = 0;
    std::map<survey::square, std::uint16_t> numbers;  // of the targets in sight
    std::uint16_t next_number = 1;
    for (std::int64_t done = 0; done < total;) {
        while (static_cast<int>(window.size()) < before + block + halo && vehicle.ping(f)) window.push_back(f);
        const int count = (std::min)(block, static_cast<int>(window.size()) - before);
        std::vector<in::ping> track;
        for (const survey::fix& w : window) track.push_back(w.at);

        // What is in sight keeps its number for as long as it is.
        in::scene scene;
        scene.seabed = seabed;
        std::vector<std::uint16_t> number_of{0};
        std::map<survey::square, std::uint16_t> still;
        for (const survey::square& s : field.around(track, o.range)) {
            if (!field.add_to(scene, s)) continue;
            const auto known = numbers.find(s);
            still[s] = known != numbers.end() ? known->second : next_number;
            if (known == numbers.end()) next_number = next_number == 65000 ? 1 : next_number + 1;
            number_of.push_back(still[s]);
            map.mark(glm::dvec2(scene.targets.back().placement.position), {220, 30, 30}, 2);
        }
        numbers = std::move(still);

        channel sides[2];
        for (const auto side : {in::side::port, in::side::starboard}) {
            rig.side = side;
            const auto heard =
                in::record(scene, std::span<const in::ping>(track), rig, all{.equation = equation}, pool);
            channel& c = sides[static_cast<int>(side)];
            c.labels.instance = rows(heard.labels.instance, before, count);
            c.labels.shadow = rows(heard.labels.shadow, before, count);
            c.labels.seabed = rows(heard.labels.seabed, before, count);
            const auto mean = rows(heard.image, before, count);
            const auto noisy = in::with_speckle(mean.view(), c.labels.seabed.view(), speckle,
                                                {window[static_cast<std::size_t>(before)].number, 1, side}, pool);
            c.gray = in::apply(in::apply(noisy, display, pool), in::to_uint8, pool);
        }

        const auto global = [&](std::uint16_t i) { return i == in::labels::by_seabed ? i : number_of[i]; };
        for (int row = 0; row < count; ++row) {
            const survey::fix& at = window[static_cast<std::size_t>(before + row)];
            for (const auto side : {in::side::port, in::side::starboard}) {
                in::labels& l = sides[static_cast<int>(side)].labels;
                for (int b = 0; b < o.bins; ++b) {
                    const std::uint16_t instance = l.instance(b, row), shadow = l.shadow(b, row);
                    const bool is_shadow = instance == 0 && shadow != 0 && shadow != in::labels::by_seabed;
                    if (instance != 0 || is_shadow) {
                        const std::uint16_t local = instance != 0 ? instance : shadow;
                        const bool is_new = !contacts.knows(number_of[local], side);
                        survey::contact& c = contacts.of(number_of[local], side);
                        const in::target& t = scene.targets[local - 1u];
                        if (is_new) {
                            const in::affine place = in::to_world(t.placement);
                            double top = -1e30;
                            for (const glm::vec3& v : t.shape.positions)
                                top = (std::max)(top, in::transform_point(place, v).z);
                            c = {t.class_name, side,     t.placement.position, static_cast<double>(t.placement.yaw),
                                 top,          at.number};
                        }
                        c.last_ping = at.number;
                        (instance != 0 ? c.area : c.shadow_area) += 1;
                        if (instance != 0) {
                            c.first_bin = (std::min)(c.first_bin, b);
                            c.last_bin = (std::max)(c.last_bin, b);
                        } else {
                            c.shadow_end = (std::max)(c.shadow_end, b);
                        }
                        const double along = in::ping_frame(at.at, side)(c.position).y;
                        if (along * along < c.closest_along) c.closest_along = along * along, c.closest = at;
                    }
                    l.instance(b, row) = global(instance);
                    l.shadow(b, row) = global(shadow);
                }
            }
            const auto heading = 360 - in::numeric::to_degrees(at.at.yaw);
            const double over = at.at.position.z -
                                static_cast<double>(in::seabed::at(bottom, at.at.position.x, at.at.position.y).height);
            navigation.line(
                std::to_string(at.number) +
                survey::format(",%.4f,%.3f,%.3f,%.3f,%.3f,%.3f", at.time, at.at.position.x, at.at.position.y,
                               at.at.position.z, over,
                               heading - 360 * static_cast<double>(in::numeric::floor_to_int(heading / 360))));
            map.mark(glm::dvec2(at.at.position), {20, 40, 160}, 1);
        }

        const auto joined = [&](auto member) { return in::beside(in::mirrored(member(sides[0])), member(sides[1])); };
        const auto gray = joined([](const channel& c) { return c.gray; });
        const auto instance = joined([](const channel& c) { return c.labels.instance; });
        const auto shadow = joined([](const channel& c) { return c.labels.shadow; });
        const auto type = joined([](const channel& c) { return c.labels.seabed; });
        for (int row = 0; row < count; ++row) {
            waterfall.row(gray.row(row));
            instances.row(instance.row(row));
            shadows.row(shadow.row(row));
            types.row(type.row(row));
            pages.row(gray.row(row));
            bar.finished_one();
        }
        contacts.close(window[static_cast<std::size_t>(before)].number, rig);
        done += count;
        const int keep = (std::min)(halo, before + count);
        window.erase(window.begin(), window.begin() + before + count - keep);
        before = keep;
    }
    contacts.close(total, rig);
    pages.finish();
    in::write_png(o.out + "/map.png", map.picture());
    std::printf("%s: %lld pings, %.1f pings/s\n", o.out.c_str(), static_cast<long long>(total),
                static_cast<double>(total) / bar.elapsed());
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "sidescan_survey: %s\n", error.what());
    return 1;
}
