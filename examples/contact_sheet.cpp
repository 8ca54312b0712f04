// One picture of a set of the recipe `published`: contact_sheet <data set> <out.png> [images per class]
//
// A row for each class; in it, plain images before those with the look of a reference, by seabed. Each tile has a scale
// bar.
#include <insonify/core/image.hpp>
#include <insonify/io/file.hpp>
#include <insonify/io/png.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "common/parse.hpp"
#include "common/pictures.hpp"
#include "common/scale_bar.hpp"
#include "common/text.hpp"
#include "common/usage.hpp"
#include "generate_dataset/csv.hpp"

namespace in = insonify;

namespace {

constexpr int tile = 256, gap = 8, caption = 20;

struct entry {
    std::string class_name, seabed, file;
    bool referenced;
    double metres;  ///< along a side
    auto order() const { return std::tie(referenced, seabed, file); }
};

/// The images of a data set by class, from its manifest.
std::map<std::string, std::vector<entry>> read_manifest(const std::string& folder) {
    const std::string path = folder + "/manifest.csv", text = in::read_file(path);
    generator::csv_reader table(path, text);
    std::vector<std::string> names, row;
    table.next(names);
    const auto column = [&](const char* name) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) throw in::io_error(path + ": has no column " + name);
        return static_cast<std::size_t>(found - names.begin());
    };
    const std::size_t file = column("file"), name = column("class"), seabed = column("seabed"),
                      look = column("reference"), pixels = column("size_px"), scale = column("metres_per_pixel");
    std::map<std::string, std::vector<entry>> classes;
    while (table.next(row)) {
        if (row.size() != names.size())
            throw in::io_error(path + ": line " + std::to_string(table.line()) + " is cut off");
        const double metres = std::atof(row[scale].c_str()) * std::atof(row[pixels].c_str());
        classes[row[name]].push_back({row[name], row[seabed], row[file], row[look] != "-1", metres});
    }
    for (auto& [key, entries] : classes)
        std::sort(entries.begin(), entries.end(), [](const entry& a, const entry& b) { return a.order() < b.order(); });
    return classes;
}

/// A picture shrunk to a tile, each pixel the mean of the pixels it covers.
in::image<float> shrink(const in::image<float>& picture) {
    in::image<float> thumbnail(tile, tile);
    for (int y = 0; y < tile; ++y)
        for (int x = 0; x < tile; ++x) {
            const auto span = [](int i, int pixels) {
                const int first = i * pixels / tile;
                return std::pair(first, (std::max)(first + 1, (i + 1) * pixels / tile));
            };
            const auto [x0, x1] = span(x, picture.width());
            const auto [y0, y1] = span(y, picture.height());
            float sum = 0;
            for (int v = y0; v < y1; ++v)
                for (int u = x0; u < x1; ++u) sum += picture(u, v);
            thumbnail(x, y) = sum / static_cast<float>((x1 - x0) * (y1 - y0));
        }
    return thumbnail;
}

}  // namespace

int main(int argc, char** argv) try {
    examples::check_arguments(argc, argv, 2, 3, "contact_sheet <data set> <out.png> [images per class]");
    const std::string folder = argv[1];
    const std::string_view number = argc > 3 ? argv[3] : "6";
    std::size_t per_class = 0;
    if (!examples::parse(number, per_class) || per_class == 0)
        throw in::invalid_input("images per class: '" + std::string(number) + "' is not a whole number of at least 1");
    const auto classes = read_manifest(folder);
    if (classes.empty()) throw in::io_error(folder + ": has no images to show");

    std::size_t columns = 0;
    for (const auto& [name, entries] : classes) columns = (std::max)(columns, (std::min)(per_class, entries.size()));
    in::image<float> sheet(static_cast<int>(columns) * (tile + gap) + gap,
                           caption + static_cast<int>(classes.size()) * (tile + gap + caption) + gap, 0.12f);
    examples::write_text(sheet, gap + 2, gap, "sound travels from left to right", 1.0f);
    int top = gap + caption;
    for (const auto& [name, entries] : classes) {
        for (std::size_t i = 0; i < (std::min)(per_class, entries.size()); ++i) {
            const int left = gap + static_cast<int>(i) * (tile + gap);
            const in::image<float> thumbnail = shrink(examples::read_gray(folder + "/" + entries[i].file));
            for (int y = 0; y < tile; ++y)
                std::copy_n(thumbnail.row(y).begin(), tile, sheet.row(top + y).begin() + left);
            examples::draw_scale_bar(sheet, left + tile, top + tile, tile, entries[i].metres, 1.0f, 0.12f);
            examples::write_text(
                sheet, left + 2, top + tile + 5,
                name + ", " + entries[i].seabed + (entries[i].referenced ? ", look of a reference" : ""), 1.0f);
        }
        top += tile + gap + caption;
    }
    in::write_png(argv[2], sheet);
} catch (const std::exception& error) {
    std::fprintf(stderr, "contact_sheet: %s\n", error.what());
    return 1;
}
