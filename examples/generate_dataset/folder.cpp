#include "folder.hpp"

#include <insonify/core/error.hpp>

namespace generator {

namespace fs = std::filesystem;

fs::path folder_path(const std::string& out) {
    const fs::path path = fs::path(out).lexically_normal();
    return path.has_filename() || !path.has_parent_path() ? path : path.parent_path();
}

fs::path open_folder(const std::string& out) {
    const fs::path root = folder_path(out);
    std::error_code failed;
    fs::create_directories(root, failed);
    if (failed) throw insonify::io_error(out + ": can't make this folder: " + failed.message() + "; name another one");
    std::string foreign;
    for (const auto& entry : fs::directory_iterator(root)) {
        const std::string name = entry.path().filename().string();
        // A run that was killed before it wrote config.json leaves these.
        if (name != ".lock" && name != ".partial" && !name.starts_with(".nfs")) foreign = name;
    }
    // Checked in this order, since another process may start the set in between.
    if (!foreign.empty() && !fs::exists(root / "config.json"))
        throw insonify::io_error(out + ": is not empty and holds no data set (" + foreign + "); name another folder");
    return root;
}

}  // namespace generator
