// The readers of surveys on any bytes: a heightfield that the rest of the library can use, or their own error.
#include <insonify/seabed/bathymetry.hpp>
#include <insonify/seabed/tessellate.hpp>

#include <optional>
#include <string_view>

#include "fuzz.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;
using fuzzing::demand;

namespace {

template <class Read>
std::optional<sb::heightfield> parsed(const Read& read) {
    try {
        return read();
    } catch (const in::io_error&) {  // anything else that is thrown ends the program
        return std::nullopt;
    }
}

void check(const std::optional<sb::heightfield>& field) {
    if (!field || field->heights.size() > 1 << 16) return;
    sb::validate(*field);
    for (const float h : field->heights.pixels())
        demand(!in::numeric::is_finite(h) || (h >= -1e6f && h <= 1e6f), "heights are metres, or missing");
    const in::mesh drawn = sb::tessellate(*field), closed = sb::tessellate(sb::fill_gaps(*field, 2));
    demand(drawn.triangles.size() <= closed.triangles.size(), "closing gaps loses no triangle");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const auto grid = parsed([&] { return sb::parse_esri_grid(bytes); });
    demand(!grid || grid->heights.size() <= bytes.size(), "a grid has not more heights than its text has characters");
    check(grid);
    check(parsed([&] { return sb::parse_xyz(bytes, 1); }));
    return 0;
}
