// Waypoints from any text: finite positions that a vehicle reaches or passes, or the reader's own error.
#include "../../examples/sidescan_survey/vehicle.hpp"
#include "fuzz.hpp"

namespace in = insonify;
using fuzzing::demand;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const auto points = survey::parse_waypoints({reinterpret_cast<const char*>(data), size}, "waypoints");
        demand(points.size() >= 2 && points.size() <= size, "a point takes characters");
        for (const glm::dvec2& p : points)
            demand(in::numeric::is_finite(p.x) && in::numeric::is_finite(p.y), "waypoints are finite");
        survey::vehicle boat({}, points);
        survey::fix f{};
        for (int i = 0; i < 1000 && boat.ping(f); ++i)
            demand(in::numeric::is_finite(f.at.position.x) && in::numeric::is_finite(f.at.yaw), "a fix is finite");
    } catch (const in::io_error&) {  // anything else that is thrown ends the program
    }
    return 0;
}
