// A GeoTIFF of depths or heights as the bottom of a picture: import_geotiff <file> <out.png> [-1 for depths]
//
// GDAL reads the file (GeoTIFF and a hundred other formats). Gaps are filled by up to ten vertices from each side.
// The roughness of medium sand adds detail below the file's spacing.
#include <insonify/core/thread_pool.hpp>
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>
#include <insonify/seabed/bathymetry.hpp>
#include <insonify/seabed/detailed.hpp>
#include <insonify/sonar/side_scan/record_options.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/speckle.hpp>

#include <cmath>
#include <cstdio>
#include <memory>
#include <string_view>

#include "common/parse.hpp"
#include "common/usage.hpp"
#include <gdal_priv.h>

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

/// The first band, north up, in metres of the file's projection.
sb::heightfield read_raster(const char* path, float scale) {
    GDALAllRegister();
    const auto close = [](GDALDataset* d) { GDALClose(d); };
    const std::unique_ptr<GDALDataset, decltype(close)> file(static_cast<GDALDataset*>(GDALOpen(path, GA_ReadOnly)),
                                                             close);
    double place[6];
    if (!file || file->GetRasterCount() < 1)
        throw in::io_error(std::string(path) + ": GDAL cannot read this as a raster");
    if (file->GetGeoTransform(place) != CE_None || place[2] != 0 || place[4] != 0 ||
        !(std::abs(place[1] + place[5]) <= 1e-6 * place[1]))
        throw in::io_error(std::string(path) + ": is not north up with square pixels");
    if (const OGRSpatialReference* const reference = file->GetSpatialRef()) {
        if (reference->IsGeographic())
            throw in::io_error(
                std::string(path) +
                ": is in degrees; project it to metres first, as to UTM zone 32N by gdalwarp -t_srs EPSG:32632");
        for (double& p : place) p *= reference->GetLinearUnits();
    }
    GDALRasterBand& band = *file->GetRasterBand(1);
    in::image<float> picture(band.GetXSize(), band.GetYSize());
    if (band.RasterIO(GF_Read, 0, 0, picture.width(), picture.height(), picture.row(0).data(), picture.width(),
                      picture.height(), GDT_Float32, 0, 0) != CE_None)
        throw in::io_error(std::string(path) + ": cannot be read");
    int has_no_data = 0;
    const auto no_data = static_cast<float>(band.GetNoDataValue(&has_no_data));
    const auto unit = scale * static_cast<float>(band.GetScale()), datum = scale * static_cast<float>(band.GetOffset());
    sb::heightfield field =
        has_no_data != 0 ? sb::from_image(picture, place[1], unit, no_data) : sb::from_image(picture, place[1], unit);
    for (float& height : field.heights.pixels()) height += datum;
    field.origin = {place[0] + 0.5 * place[1], place[3] - (picture.height() - 0.5) * place[1]};
    return field;
}

/// The mean of the heights that are known.
double mean_height(const sb::heightfield& field) {
    double sum = 0, count = 0;
    for (const float h : field.heights.pixels())
        if (in::numeric::is_finite(h)) sum += static_cast<double>(h), count += 1;
    return count > 0 ? sum / count : 0;
}

}  // namespace

int main(int argc, char** argv) try {
    examples::check_arguments(argc, argv, 2, 3, "import_geotiff <file> <out.png> [-1 for depths]");
    double scale = 1;
    if (argc > 3) {
        const std::string_view text = argv[3];
        if (!examples::parse(text, scale) || !in::numeric::is_finite(static_cast<float>(scale)) || scale == 0)
            throw in::invalid_input("scale is '" + std::string(text) +
                                    "', expected a number of metres per unit, -1 for depths");
    }
    sb::heightfield survey = sb::fill_gaps(read_raster(argv[1], static_cast<float>(scale)), 10);

    // From the western edge, 15 m above the bottom there, which is moved to z = 0, where default gains take it to lie.
    const glm::dvec2 start = survey.origin;
    const double length = survey.spacing * (survey.heights.height() - 1);
    const double edge = static_cast<double>(survey.height_at(start.x, start.y + length / 2));
    const auto datum = static_cast<float>(in::numeric::is_finite(edge) ? edge : mean_height(survey));
    for (float& h : survey.heights.pixels()) h -= datum;

    const auto finer = sb::roughness_of(in::sediment::medium_sand, static_cast<float>(survey.spacing));
    in::scene scene;
    scene.seabed = sb::detailed{.field = survey, .surface = finer};

    const double width = (std::min)(survey.spacing * (survey.heights.width() - 1), 100.0);
    const in::ground_range rig{.position = start,
                               .altitude = 15,
                               .ping_spacing = 0.1f,
                               .pings = (std::min)(1000, static_cast<int>(length / 0.1) + 1),
                               .range = static_cast<float>(width),
                               .bins = 1000};
    in::thread_pool pool;
    const auto recorded = in::render(scene, rig, in::record_options<in::labels, in::lambert_backscatter>{}, pool);
    in::write_png(argv[2], in::with_speckle(recorded, {}, pool).image | in::display{.white = 1});
} catch (const std::exception& error) {
    std::fprintf(stderr, "import_geotiff: %s\n", error.what());
    return 1;
}
