// Applies filters for filters.py, which compares them with scikit-image and Octave: reads lines of "what kind source
// argument result" and applies them to netpbm files. PGM of 8 and 16 bits, PFM; colour only for gray.
#include <insonify/filter/colormap.hpp>
#include <insonify/filter/gray.hpp>
#include <insonify/filter/histogram.hpp>
#include <insonify/filter/match.hpp>
#include <insonify/filter/noise.hpp>
#include <insonify/filter/pipe.hpp>
#include <insonify/io/netpbm.hpp>

#include <cstdio>
#include <iostream>
#include <string>

namespace in = insonify;

namespace {

template <class Pixel>
void run(const std::string& what, const std::string& source, const std::string& argument, const std::string& result) {
    const auto picture = in::read_netpbm<Pixel>(source);
    const auto write = [&](const auto& filter) { in::write_netpbm(result, picture | filter); };
    if (what == "match") {
        write(in::match_histogram(in::read_netpbm<Pixel>(argument)));
    } else if (what == "bins") {
        // "<bins>:<reference>"
        const auto colon = argument.find(':');
        write(
            in::match_binned(in::read_netpbm<Pixel>(argument.substr(colon + 1)), std::stoi(argument.substr(0, colon))));
    } else if (what == "count") {
        const auto counts = in::histogram_of(picture, std::stoi(argument)).counts;
        in::image<float> row(static_cast<int>(counts.size()), 1);
        for (std::size_t i = 0; i < counts.size(); ++i) row.pixels()[i] = static_cast<float>(counts[i]);
        in::write_netpbm(result, row);
    } else if (what == "gaussian") {
        write(in::gaussian{.variance = std::stof(argument), .seed = 1});
    } else if (what == "gaussian_speckle") {
        write(in::gaussian_speckle{.variance = std::stof(argument), .seed = 1});
    } else if (what == "salt_and_pepper") {
        write(in::salt_and_pepper{.density = std::stof(argument), .seed = 1});
    } else {
        throw in::io_error("no such filter: " + what);
    }
}

void write_gray(const std::string& source, const std::string& weights, const std::string& result) {
    const auto picture = in::read_netpbm<in::rgb8>(source);
    const in::gray_weights by = weights == "rec709" ? in::rec709_weights : in::octave_weights;
    in::write_netpbm(result, picture | in::to_gray{by});
}

void write_table(const std::string& name, const std::string& result) {
    in::image<in::rgb8> row(256, 1);
    const in::color_table& table = name == "hot" ? in::colormap::hot : in::colormap::copper;
    for (std::size_t i = 0; i < 256; ++i) row.pixels()[i] = table.colors[i];
    in::write_netpbm(result, row);
}

}  // namespace

int main() try {
    std::string what, kind, source, argument, result;
    while (std::cin >> what >> kind >> source >> argument >> result) {
        if (what == "gray") {
            write_gray(source, argument, result);
        } else if (what == "table") {
            write_table(argument, result);
        } else if (kind == "8") {
            run<std::uint8_t>(what, source, argument, result);
        } else if (kind == "16") {
            run<std::uint16_t>(what, source, argument, result);
        } else {
            run<float>(what, source, argument, result);
        }
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "conformance_filters: %s\n", error.what());
    return 1;
}
