// The input files of a data set. Each is read once, so that the bytes that are drawn are the bytes whose checksum is
// pinned.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "../common/pictures.hpp"
#include "checksum.hpp"
#include <nlohmann/json.hpp>

namespace generator {

/// An input as config.json pins it: by name and content, not by folder.
struct input {
    std::string option, name;  ///< `--mesh wreck`, `wreck.obj`
    std::uint64_t bytes;
    std::string sha256;
};

/// The name of a file as config.json and manifests hold it: bytes that are not UTF-8 are replaced.
inline std::string utf8_name(const std::string& path) {
    const std::string name = std::filesystem::path(path).filename().string();
    return nlohmann::json::parse(nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
        .get<std::string>();
}

/// Reads input files and lists them.
class input_reader {
  public:
    /// @param limit  maximum size of a file, bytes
    explicit input_reader(std::uint64_t limit) : limit_(limit) {}

    /// @throws io_error, with the option, for a file that can't be read
    std::string read(const std::string& option, const std::string& path) {
        std::string bytes;
        try {
            bytes = examples::read_input(path, limit_, "raise --input-limit");
        } catch (const insonify::io_error& error) {
            throw insonify::io_error(option + " " + error.what());
        }
        add(option, path, bytes);
        return bytes;
    }
    /// Lists a file that was read elsewhere.
    void add(const std::string& option, const std::string& path, const std::string& bytes) {
        list_.push_back({option, utf8_name(path), bytes.size(), sha256(bytes)});
    }

    insonify::image<float> read_picture(const std::string& option, const std::string& path) {
        return examples::parse_gray(read(option, path), option + " " + path, 6 * limit_);
    }

    std::vector<input> list() && { return std::move(list_); }

  private:
    std::uint64_t limit_;
    std::vector<input> list_;
};

/// The pictures that `--reference` names; those of a folder are sorted by name.
/// @throws io_error for a folder without pictures
inline std::vector<std::string> picture_paths(const std::vector<std::string>& references) {
    namespace fs = std::filesystem;
    std::vector<std::string> paths;
    for (const std::string& given : references) {
        if (!fs::is_directory(given)) {
            paths.push_back(given);
            continue;
        }
        std::vector<std::string> inside;
        for (const auto& entry : fs::directory_iterator(given)) {
            if (!entry.is_regular_file()) continue;
            char head[16] = {};
            const insonify::detail::file_handle file(entry.path().string(), "rb");
            if (file.get() == nullptr)
                insonify::detail::raise_io("--reference " + entry.path().string(), "can't open for reading", errno);
            const std::size_t size = std::fread(head, 1, sizeof head, file.get());
            if (examples::is_picture({head, size})) inside.push_back(entry.path().string());
        }
        if (inside.empty())
            throw insonify::io_error("--reference " + given + ": this folder holds no PNG, JPEG, BMP, PGM, PPM or PFM");
        std::sort(inside.begin(), inside.end());
        paths.insert(paths.end(), inside.begin(), inside.end());
    }
    return paths;
}

}  // namespace generator
