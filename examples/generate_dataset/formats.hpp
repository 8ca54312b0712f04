// File formats in addition to 8-bit PNG: 16 bits, or floats.
#pragma once

#include <insonify/core/image.hpp>

#include <string>
#include <vector>

#include "layout.hpp"
#include <nlohmann/json.hpp>

namespace generator {

/// Values of --format: the first three add a file per image, the last one packs the whole set.
inline constexpr const char* format_names[] = {"png16", "npy", "pfm", "webdataset"};

/// Appends the files of `formats`, and their entries in the record.
/// @param values  the image before quantization to 8 bits and colour
void add_formats(const std::vector<std::string>& formats, std::uint64_t index, const insonify::image<float>& values,
                 std::vector<file>& files, nlohmann::ordered_json& record);

/// Why a file of these formats does not decode; empty if it does.
std::string format_fault(const std::string& of, const std::string& bytes, int size);

}  // namespace generator
