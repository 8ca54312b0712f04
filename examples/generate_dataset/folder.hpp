// The folder of a data set: locked, pinned to one configuration, and whole at any moment.
//
// An image counts once its record is in records/; the record is written last. Tables are made of records alone, so
// whatever interrupts a run, what they list is there.
#pragma once

#include <set>

#include "../common/png_bytes.hpp"
#include "draw.hpp"

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#endif

namespace generator {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

/// Keeps a second generator out of a folder for as long as this lives, however it ends.
class folder_lock {
  public:
    /// @throws io_error if somebody else holds it
    explicit folder_lock(const fs::path& folder) {
#if defined(__unix__) || defined(__APPLE__)
        const std::string path = (folder / ".lock").string();
        handle_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
        if (handle_ < 0 || ::flock(handle_, LOCK_EX | LOCK_NB) != 0)
            throw in::io_error(folder.string() + ": another generator is at work in this folder");
#else
        static_cast<void>(folder);
#endif
    }
    ~folder_lock() {
#if defined(__unix__) || defined(__APPLE__)
        if (handle_ >= 0) ::close(handle_);
#endif
    }
    folder_lock(const folder_lock&) = delete;
    folder_lock& operator=(const folder_lock&) = delete;

  private:
    int handle_ = -1;
};

/// Run lengths of a mask in COCO's order: down the columns, beginning with zeros. Nothing is set outside of the box.
inline std::vector<std::int64_t> run_lengths(const in::image<std::uint8_t>& mask, const in::label_box& box) {
    std::vector<std::int64_t> runs;
    bool inside = false;
    std::int64_t run = 0;
    const auto append = [&](bool is_set, std::int64_t pixels) {
        if (is_set != inside && pixels > 0) {
            runs.push_back(run);
            run = 0;
            inside = is_set;
        }
        run += pixels;
    };
    const std::int64_t height = mask.height();
    append(false, box.x * height);
    for (int x = box.x; x < box.x + box.width; ++x) {
        append(false, box.y);
        for (int y = box.y; y < box.y + box.height; ++y) append(mask(x, y) != 0, 1);
        append(false, height - box.y - box.height);
    }
    append(false, (mask.width() - box.x - box.width) * height);
    runs.push_back(run);
    return runs;
}

/// A file that is yet to be written.
struct file {
    std::string path, bytes;
};

class dataset_folder {
  public:
    /// Opens or makes the folder.
    /// @throws io_error if it holds something else, or was made with another configuration
    explicit dataset_folder(const options& o) : root_(o.out), classes_(class_names(o)), lock_(prepared(o.out)) {
        const json now = pinned(o);
        const fs::path config = root_ / "config.json";
        if (fs::exists(config)) {
            refuse_differences(json::parse(in::read_file(config.string())), now);
        } else {
            for (const auto& entry : fs::directory_iterator(root_))
                if (entry.path().filename() != ".lock")
                    throw in::io_error(o.out + ": is not empty and holds no data set; name another folder");
            in::write_file(config.string(), now.dump(2) + "\n");
        }
        for (const std::string& name : classes_) fs::create_directories(root_ / "images" / name);
        fs::create_directories(root_ / "masks");
        fs::create_directories(root_ / "records");
        remove_leftovers();
    }

    bool has(const plan& p) const { return fs::exists(record_path(p.id())); }

    /// An image's masks, the image, and last its record: to be written in this order.
    std::vector<file> files_of(const options& o, const plan& p, const drawn& d) const {
        const std::string picture = "images/" + p.class_name + "/" + p.id() + ".png";
        const in::target_label& label = d.labels.targets.front();
        const auto target = in::target_mask(d.labels, label.instance);
        const auto shadow = in::shadow_mask(d.labels, label.instance);
        const auto mask_path = [&](const char* of) { return (root_ / "masks" / (p.id() + of)).string(); };
        std::vector<file> files{
            {mask_path("_target.png"), examples::png_bytes(target)},
            {mask_path("_shadow.png"), examples::png_bytes(shadow)},
            {mask_path("_seabed.png"), examples::png_bytes(d.labels.seabed)},
            {(root_ / picture).string(), d.gray.empty() ? examples::png_bytes(d.color) : examples::png_bytes(d.gray)}};

        const double metres = d.known.metres_per_pixel;
        const auto annotation = [&](const std::string& category, const in::label_box& box, std::int64_t area,
                                    const auto& mask) {
            return json{{"category", category},
                        {"bbox", {box.x, box.y, box.width, box.height}},
                        {"bbox_m", {box.x * metres, box.y * metres, box.width * metres, box.height * metres}},
                        {"area", area},
                        {"segmentation", {{"size", {o.size, o.size}}, {"counts", run_lengths(mask, box)}}}};
        };
        const auto degrees = [](double radians) { return in::numeric::to_degrees(radians); };
        json record{{"id", p.index}, {"file", picture}, {"size", o.size}};
        record["annotations"] = {annotation(p.class_name, label.box, label.area, target),
                                 annotation("shadow", label.shadow_box, label.shadow_area, shadow)};
        record["parameters"] = {{"class", p.class_name},
                                {"seabed", p.seabed},
                                {"seed", o.seed},
                                {"reference", p.referenced ? static_cast<int>(p.reference) : -1},
                                {"target_size_m", p.size},
                                {"aspect", p.aspect},
                                {"target_x_m", d.placement.position.x},
                                {"target_y_m", d.placement.position.y},
                                {"target_z_m", d.placement.position.z},
                                {"yaw_deg", degrees(p.yaw)},
                                {"pitch_deg", degrees(p.pitch)},
                                {"roll_deg", degrees(p.roll)},
                                {"burial_m", static_cast<double>(d.placement.burial)},
                                {"rig_x_m", p.place_x},
                                {"rig_y_m", p.place_y},
                                {"rig_yaw_deg", degrees(p.rig_yaw)},
                                {"altitude_m", p.altitude},
                                {"mode", o.mode},
                                {"metres_per_pixel", metres},
                                {"left_edge_m", d.known.left_edge},
                                {"ground_range_m", d.known.ground_range},
                                {"slant_range_m", d.known.slant_range},
                                {"grazing_deg", degrees(d.known.grazing)},
                                {"aspect_deg", degrees(d.known.aspect)},
                                {"target_height_m", d.known.height},
                                {"shadow_m", d.known.shadow},
                                {"shadow_measured_m", d.known.shadow_measured},
                                {"shadow_is_cut", d.known.shadow_is_cut},
                                {"seabed_seed", p.seabed_seed},
                                {"noise_seed", p.noise_seed},
                                {"target_area_px", label.area},
                                {"shadow_area_px", label.shadow_area}};
        files.push_back({record_path(p.id()).string(), record.dump() + "\n"});
        return files;
    }

    /// Makes annotations.json and manifest.csv of all records. @returns how many there are
    std::size_t write_tables() const {
        std::set<fs::path> records;
        for (const auto& entry : fs::directory_iterator(root_ / "records"))
            if (entry.path().extension() == ".json") records.insert(entry.path());

        json coco{{"info", {{"description", "synthetic side-scan sonar"}}},
                  {"images", json::array()},
                  {"annotations", json::array()},
                  {"categories", json::array()}};
        std::map<std::string, std::size_t> category_ids;
        for (const std::string& name : classes_) add_category(coco, category_ids, name, "target");
        add_category(coco, category_ids, "shadow", "shadow");

        std::string manifest;
        for (const fs::path& path : records) {
            const json record = json::parse(in::read_file(path.string()));
            coco["images"].push_back({{"id", record["id"]},
                                      {"file_name", record["file"]},
                                      {"width", record["size"]},
                                      {"height", record["size"]}});
            for (const json& a : record["annotations"]) {
                if (a["area"] == 0) continue;
                coco["annotations"].push_back({{"id", coco["annotations"].size() + 1},
                                               {"image_id", record["id"]},
                                               {"category_id", category_ids.at(a["category"])},
                                               {"bbox", a["bbox"]},
                                               {"area", a["area"]},
                                               {"iscrowd", 0},
                                               {"segmentation", a["segmentation"]}});
            }
            const json& parameters = record["parameters"];
            if (manifest.empty()) {
                manifest = "index,file";
                for (const auto& [name, value] : parameters.items()) manifest += "," + name;
                manifest += "\r\n";
            }
            manifest += record["id"].dump() + "," + record["file"].get<std::string>();
            for (const auto& [name, value] : parameters.items())
                manifest += "," + (value.is_string() ? value.get<std::string>() : value.dump());
            manifest += "\r\n";
        }
        in::write_file((root_ / "annotations.json").string(), coco.dump() + "\n");
        in::write_file((root_ / "manifest.csv").string(), manifest);
        return records.size();
    }

  private:
    static fs::path prepared(const std::string& out) {
        std::error_code failed;
        fs::create_directories(out, failed);
        if (failed) throw in::io_error(out + ": can't make this folder: " + failed.message());
        return out;
    }

    void refuse_differences(const json& before, const json& now) const {
        std::string differences;
        for (const auto& [name, value] : now.items())
            if (!before.contains(name) || before[name] != value)
                differences += "\n  " + name + " was " + (before.contains(name) ? before[name].dump() : "unknown") +
                               ", is " + value.dump();
        if (!differences.empty())
            throw in::io_error(root_.string() + ": holds a data set of another configuration:" + differences +
                               "\nName another folder, or ask for the same again to go on.");
    }

    /// What a killed run left half-written; nobody else can be writing here.
    void remove_leftovers() const {
        for (const auto& entry : fs::recursive_directory_iterator(root_))
            if (entry.is_regular_file() && entry.path().extension().string().starts_with(".tmp"))
                fs::remove(entry.path());
    }

    static void add_category(json& coco, std::map<std::string, std::size_t>& ids, const std::string& name,
                             const char* kind) {
        const std::size_t id = ids.size() + 1;
        ids[name] = id;
        coco["categories"].push_back({{"id", id}, {"name", name}, {"supercategory", kind}});
    }

    fs::path record_path(const std::string& id) const { return root_ / "records" / (id + ".json"); }

    fs::path root_;
    std::vector<std::string> classes_;
    folder_lock lock_;
};

}  // namespace generator
