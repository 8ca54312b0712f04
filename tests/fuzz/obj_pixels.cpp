// A mesh from any text, through to pixels and labels of both sonars: finite, or refused by the library's own error.
#include <insonify/all.hpp>

#include <string_view>

#include "fuzz.hpp"

namespace in = insonify;
using fuzzing::demand;

namespace {

void check(const in::image<float>& picture, const in::labels& labels) {
    for (const float value : picture.pixels()) demand(in::numeric::is_finite(value) && value >= 0, "pixels are finite");
    demand(labels.targets.size() == 1, "there is one target");
    const auto mask = in::target_mask(labels, labels.targets[0].instance);
    std::int64_t area = 0;
    for (const std::uint8_t value : mask.pixels()) area += value != 0;
    demand(area == labels.targets[0].area, "a mask has the area of its label");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 4096) return 0;
    try {
        const in::mesh shape = in::read_obj({reinterpret_cast<const char*>(data), size}, "mesh");
        in::scene scene;
        scene.seabed = in::seabed::flat{};
        scene.add(shape, in::pose{.position = {0, 0, 0.2f}}, "mesh");
        const auto frame = in::render(scene, in::overhead{.altitude = 4, .size = {16, 16}, .grazing = 0.3f});
        check(frame.image, frame.labels);
        in::side_scan_rig<in::across_track::slant_range> rig{
            .altitude = 4, .ping_spacing = 0.2f, .pings = 12, .first_range = 4, .range = 8, .bins = 12};
        rig.position = {-4, -1};
        const auto recording = in::render(scene, rig);
        check(recording.image, recording.labels);
    } catch (const in::io_error&) {  // anything else that is thrown ends the program
    } catch (const in::invalid_input&) {
    }
    return 0;
}
