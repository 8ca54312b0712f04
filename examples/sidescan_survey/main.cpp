// sidescan_survey: a vehicle follows waypoints over a seabed with targets. Writes a waterfall of both sides, its
// labels, the navigation, a line per contact, and a map. See --help.
//
// Works in blocks of pings, of which only the current one is kept: memory does not grow with the track.
#include <insonify/core/thread_pool.hpp>

#include <filesystem>

#include "../common/progress.hpp"
#include "logbook.hpp"

int main(int argc, char** argv) try {
    namespace in = insonify;
    const survey::options o = survey::parse(argc, argv);
    std::filesystem::create_directories(o.out + "/pages");
    in::thread_pool pool(o.threads);
    const std::vector<glm::dvec2> waypoints =
        o.waypoints.empty() ? survey::lawnmower(o.length, o.width, o.between) : survey::read_waypoints(o.waypoints);
    const in::seabed::any seabed = survey::bottom_of(o);

    // A first pass along the track, without a sonar, finds the number of pings and the bounds of the map.
    std::int64_t total = 0;
    glm::dvec2 low(1e30), high(-1e30);
    survey::fix f{};
    survey::vehicle scout(o.driving, waypoints);
    for (; scout.ping(f); ++total) {
        low = {(std::min)(low.x, f.at.position.x), (std::min)(low.y, f.at.position.y)};
        high = {(std::max)(high.x, f.at.position.x), (std::max)(high.y, f.at.position.y)};
    }
    if (total == 0) throw in::io_error("the waypoints are too close together for a single ping");
    if (scout.missed() > 0)
        std::fprintf(stderr,
                     "sidescan_survey: %d of %zu waypoints lie within the turning circle and are not reached: lower "
                     "--speed, or raise --turn-rate or --between\n",
                     scout.missed(), waypoints.size());

    survey::vehicle vehicle(o.driving, waypoints);
    survey::sonar sonar(o, vehicle.spacing());
    survey::logbook log(o, seabed, total, survey::chart(seabed, low - o.range, high + o.range, 1200, pool));
    const survey::target_field field(seabed, 10, o.targets, o.seed);
    survey::lookout lookout;

    examples::progress bar(static_cast<std::size_t>(total));
    constexpr int block_size = 128;
    const int halo = sonar.halo();
    std::vector<survey::fix> window;  // the block, and the pings before and after it that its beam overlaps
    for (int before = 0;;) {
        while (static_cast<int>(window.size()) < before + block_size + halo && vehicle.ping(f)) window.push_back(f);
        const int count = (std::min)(block_size, static_cast<int>(window.size()) - before);
        if (count == 0) break;
        std::vector<in::ping> track;
        for (const survey::fix& w : window) track.push_back(w.at);
        const survey::sight in_sight = lookout.around(field, seabed, track, o.range);
        log.write(sonar.record_block(in_sight, window, before, count, pool), in_sight, sonar.rig());
        for (int i = 0; i < count; ++i) bar.finished_one();

        const int kept = (std::min)(halo, before + count);
        window.erase(window.begin(), window.begin() + before + count - kept);
        before = kept;
    }
    log.finish(total, sonar.rig());
    std::printf("%s: %lld pings, %.1f pings/s\n", o.out.c_str(), static_cast<long long>(total),
                static_cast<double>(total) / bar.elapsed());
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "sidescan_survey: %s\n", error.what());
    return 1;
}
