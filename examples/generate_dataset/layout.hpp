// Where things lie in the folder of a data set.
//
//     config.json                                   what decides its bytes: recipe, seed, version, contents of inputs
//     images/<class>/<block>/<id>.png               a class folder holds all images of a class, at any depth
//     masks/<block>/<id>_{target,shadow,seabed}.png
//     records/<block>/<id>.json                     one for each image; written last, so that it vouches for the files
//     annotations.json  manifest.csv  SHA256SUMS    tables of all records, and their own checksums
//     shards.json                                   while the set is made by shards and is not joined yet
//     .partial/  .lock                              files in the making, and the lock of those that make them
//
// An id is the index of the image with nine digits, so that names sort as numbers; a block holds a thousand ids.
#pragma once

#include <cstdint>
#include <string>

namespace generator {

inline constexpr std::uint64_t most_images = 1'000'000'000;

inline std::string id_of(std::uint64_t index) {
    const std::string digits = std::to_string(index);
    return std::string(digits.size() < 9 ? 9 - digits.size() : 0, '0') + digits;
}
inline std::string block_of(std::uint64_t index) {
    return id_of(index).substr(0, 6);
}

// Paths within the folder.
inline std::string image_path(const std::string& class_name, std::uint64_t index) {
    return "images/" + class_name + "/" + block_of(index) + "/" + id_of(index) + ".png";
}
inline std::string mask_path(const std::string& of, std::uint64_t index) {
    return "masks/" + block_of(index) + "/" + id_of(index) + "_" + of + ".png";
}
inline std::string record_path(std::uint64_t index) {
    return "records/" + block_of(index) + "/" + id_of(index) + ".json";
}

/// A file that is yet to be written.
struct file {
    std::string path, bytes;
};

}  // namespace generator
