// Options of a survey, from the command line.
#pragma once

#include <insonify/insonify.hpp>
#include <insonify/seabed/blend.hpp>

#include "../common/option_values.hpp"
#include "../common/refusal.hpp"
#include "vehicle.hpp"
#include <CLI/CLI.hpp>

namespace survey {

struct options {
    std::string out, waypoints, bottom = "ripples+mud";
    double length = 60, width = 80, between = 40;
    handling driving{};
    double range = 30, beam = 0.3, targets = 0.5;
    int bins = 1024, page = 1024, threads = 0;
    std::uint64_t seed = 1;
};

inline options parse(int argc, char** argv) {
    options o;
    CLI::App app{"Runs a side-scan survey and writes its waterfall, labels, navigation, contacts and map.",
                 "sidescan_survey"};
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    app.add_option("--out", o.out, "Folder of the output; created if missing")
        ->required()
        ->check(examples::folder_to_fill());
    app.add_option("--waypoints", o.waypoints,
                   "File of lines x,y in metres (parallel legs of --length, --width, --between)");
    app.add_option("--length", o.length, "Length of a leg, metres (60)")->check(examples::number(1.0, 1e6));
    app.add_option("--width", o.width, "Width of the surveyed area, metres (80)")->check(examples::number(0.0, 1e6));
    app.add_option("--between", o.between, "Distance between legs, metres (40)")->check(examples::number(1.0, 1e6));
    app.add_option("--speed", o.driving.speed, "Speed, metres per second (1.5)")->check(examples::number(0.01, 100.0));
    app.add_option("--ping-rate", o.driving.ping_rate, "Pings per second (15)")->check(examples::number(0.1, 1000.0));
    app.add_option("--turn-rate", o.driving.turn_rate, "Maximum turn rate, degrees per second (6)")
        ->check(examples::number(0.1, 360.0));
    app.add_option("--altitude", o.driving.altitude, "Mean altitude over the datum, metres (6)")
        ->check(examples::number(0.1, 1000.0));
    app.add_option("--altitude-change", o.driving.altitude_change,
                   "Amplitude of slow changes of altitude, metres (1.5)")
        ->check(examples::number(0, 1000));
    app.add_option("--heave", o.driving.heave, "Amplitude of the heave by the swell, metres (0.15)")
        ->check(examples::number(0, 100));
    app.add_option("--range", o.range, "Range of each side, metres (30)")->check(examples::number(1.0, 1e4));
    app.add_option("--bins", o.bins, "Bins of each side (1024)")->check(examples::whole_number(8, 65536));
    app.add_option("--beam", o.beam, "Along-track beamwidth, degrees (0.3)")->check(examples::number(1e-3, 20.0));
    app.add_option("--targets", o.targets, "Targets per 10 m x 10 m (0.5)")->check(examples::number(0.0, 1.0));
    app.add_option("--bottom", o.bottom, "ripples+mud, ripples+sand, sand+rock or mud+rock (ripples+mud)")
        ->check(CLI::IsMember({"ripples+mud", "ripples+sand", "sand+rock", "mud+rock"}));
    app.add_option("--page", o.page, "Rows of a page of the waterfall (1024)")
        ->check(examples::whole_number(16, 16384));
    app.add_option("--seed", o.seed, "Seed of the seabed and the targets (1)")
        ->check(examples::whole_number(0, UINT64_MAX));
    app.add_option("--threads", o.threads,
                   "Number of threads, 0 for one per hardware thread (0); does not change the output")
        ->check(examples::whole_number(0, 1024));
    try {
        app.parse(argc, argv);
        if (o.driving.altitude_change + o.driving.heave >= o.driving.altitude)
            throw CLI::ValidationError("--altitude", CLI::detail::to_string(o.driving.altitude) +
                                                         " m does not exceed --altitude-change and --heave together");
        if (std::int64_t{6} * o.bins * o.page > std::int64_t{1} << 29)
            throw CLI::ValidationError("--page", std::to_string(o.page) + " rows of 2 x " + std::to_string(o.bins) +
                                                     " bins are more than a PNG of 2^29 bytes holds");
    } catch (const CLI::ParseError& error) {
        examples::exit_after(app, error);
    }
    return o;
}

/// The seabed of the options.
inline in::seabed::any bottom_of(const options& o) {
    const auto kind = [&](const std::string& name) -> in::seabed::any {
        if (name == "ripples") return in::seabed::ripples{.wavelength = 0.7f, .steepness = 0.07f, .seed = o.seed};
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

}  // namespace survey
