// A temporary folder for tests that write files.
#pragma once

#include <filesystem>
#include <set>
#include <string>

/// A new folder, removed at the end of the test.
struct scratch_folder {
    std::filesystem::path path;
    scratch_folder() {
        for (int i = 0; path.empty() || !std::filesystem::create_directory(path); ++i)
            path = std::filesystem::temp_directory_path() / ("insonify_test_" + std::to_string(i));
    }
    scratch_folder(const scratch_folder&) = delete;
    scratch_folder& operator=(const scratch_folder&) = delete;
    ~scratch_folder() { std::filesystem::remove_all(path); }

    std::string operator/(const std::string& name) const { return (path / name).string(); }
    std::set<std::string> names() const {
        std::set<std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(path))
            found.insert(entry.path().filename().string());
        return found;
    }
};
