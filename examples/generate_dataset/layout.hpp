// Paths in the folder of a data set.
//
//     config.json                                   recipe, seed, version and input checksums; decides every byte
//     images/<class>/<block>/<id>.png               all images of a class
//     masks/<block>/<id>_{target,shadow,seabed}.png
//     values/<block>/<id>{_16.png,.npy,.pfm}         with --format png16, npy or pfm
//     records/<block>/<id>.json                     one per image; written last, so that its files are complete
//     annotations.json  manifest.csv  README.md     tables of all records, and a data card
//     webdataset/<block>.tar                        with --format webdataset
//     SHA256SUMS                                    of the tables
//     preview.html                                  with --preview
//     shards.json                                   present until the shards are merged
//     .partial/  .lock                              unfinished files, and the lock of running generators
//
// An id is the image's index padded to nine digits, so that names sort numerically. A block holds a thousand ids.
#pragma once

#include <cstdint>
#include <string>

namespace generator {

inline constexpr std::uint64_t max_images = 1'000'000'000;

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

/// Path and contents of a file to write.
struct file {
    std::string path, bytes;
};

}  // namespace generator
