// What is written of an image beside its PNG of 8 bits: 16 bits, or floats.
#pragma once

#include <insonify/core/image.hpp>

#include <string>
#include <vector>

#include "layout.hpp"
#include <nlohmann/json.hpp>

namespace generator {

/// Names that --format takes: the first three are files of each image, the last one packs all of a set.
inline constexpr const char* format_names[] = {"png16", "npy", "pfm", "webdataset"};

/// A PNG of 16 bits, gray. 1 is 65535, to the nearest.
std::string png16_bytes(const insonify::image<float>& picture);

/// An array of NumPy: float32, little endian, rows from the top.
std::string npy_bytes(const insonify::image<float>& picture);

/// Adds the files of `formats` and their entries in the record.
/// @param values  of the image before its last step to 8 bits and colour
void add_formats(const std::vector<std::string>& formats, std::uint64_t index, const insonify::image<float>& values,
                 std::vector<file>& files, nlohmann::ordered_json& record);

/// What is wrong with a file of these formats; nothing if it decodes.
std::string format_fault(const std::string& of, const std::string& bytes, int size);

}  // namespace generator
