#include "tables.hpp"

#include <insonify/io/file.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <sstream>

#include "card.hpp"
#include "checksum.hpp"
#include "configuration.hpp"
#include "csv.hpp"
#include "preview.hpp"
#include "record.hpp"
#include "tar_writer.hpp"

namespace generator {

namespace fs = std::filesystem;

namespace {

/// A table being written, with its checksum.
class table {
  public:
    table(staging& into, std::string name) : into_(into), name_(std::move(name)), file_(into.open(name_)) {}

    void write(std::string_view bytes) {
        file_.write(bytes);
        sum_.add(bytes);
    }
    /// Moves the table into place. @returns its line of SHA256SUMS
    std::string close() {
        into_.put(file_, name_);
        return sum_.digits() + "  " + name_ + "\n";
    }

  private:
    staging& into_;
    std::string name_;
    staged_file file_;
    sha256_sum sum_;
};

std::string cell_of(const json& value) {
    return value.is_null() ? "" : value.is_string() ? csv_cell(value.get<std::string>()) : value.dump();
}

/// The columns of a record in manifest.csv: names, or values.
std::string line_of(const json& record, bool names) {
    std::string line = names ? "index" : record.at("id").dump();
    bool image = true;
    const auto add = [&](const std::string& name, const json& value) {
        line += "," + (names ? csv_cell(name) : cell_of(value));
    };
    const auto add_file = [&](const std::string& name, const json& entry) {
        add(name, entry.at("path"));
        add(name + "_bytes", entry.at("bytes"));
        add(name + "_sha256", entry.at("sha256"));
    };
    add_file("file", record.at("files").at(0));
    for (const auto& [name, value] : record.at("parameters").items()) add(name, value);
    for (const json& entry : record.at("files")) {
        if (!image) add_file(entry.at("of").get<std::string>(), entry);
        image = false;
    }
    return line + "\r\n";
}

/// The tar files of a set: one for each block of a thousand ids.
class webdataset_writer {
  public:
    webdataset_writer(const fs::path& root, staging& into) : root_(root), into_(into) {}

    void add(std::uint64_t index, const std::string& text, const json& record, std::size_t category) {
        if (block_ != block_of(index)) close();
        if (!tar_) {
            block_ = block_of(index);
            table_ = std::make_unique<table>(into_, "webdataset/" + block_ + ".tar");
            tar_ = std::make_unique<tar_writer>([this](std::string_view bytes) { table_->write(bytes); });
        }
        const std::string id = id_of(index);
        bool image = true;
        for (const json& entry : record.at("files")) {
            const std::string path = entry.at("path").get<std::string>(), of = entry.at("of").get<std::string>();
            const std::string bytes = insonify::read_file((root_ / path).string());
            if (sha256(bytes) != entry.at("sha256").get<std::string>())
                throw insonify::io_error((root_ / path).string() + ": is damaged; run the command again");
            // WebDataset splits names at the first dot: 000000007.target_mask.png
            const std::string extension = path.substr(path.rfind('.'));
            tar_->add(id + (image || extension != ".png" ? extension : "." + of + extension), bytes);
            if (image) tar_->add(id + ".cls", std::to_string(category));
            image = false;
        }
        tar_->add(id + ".json", text);
    }
    /// Moves the last tar into place. @returns lines of SHA256SUMS
    std::string close() {
        if (tar_) {
            tar_->close();
            sums_ += table_->close();
        }
        tar_.reset(), table_.reset();
        return sums_;
    }

  private:
    const fs::path& root_;
    staging& into_;
    std::string block_, sums_;
    std::unique_ptr<table> table_;
    std::unique_ptr<tar_writer> tar_;
};

std::uint64_t write_once(const fs::path& root, bool preview, staging& into) {
    const json config = pinned(root, "config.json");
    const auto formats = config.value("formats", std::vector<std::string>());
    const bool packs = std::find(formats.begin(), formats.end(), "webdataset") != formats.end();
    table coco(into, "annotations.json"), manifest(into, "manifest.csv"), readme(into, "README.md");
    webdataset_writer samples(root, into);
    data_card card;
    preview_page page;
    json categories = json::array();
    std::map<std::string, std::size_t> category_ids;
    const auto add_category = [&](const std::string& name, const char* kind) {
        category_ids[name] = category_ids.size() + 1;
        categories.push_back({{"id", category_ids[name]}, {"name", name}, {"supercategory", kind}});
    };
    for (const auto& name : config.at("categories").get<std::vector<std::string>>()) add_category(name, "target");
    add_category("shadow", "shadow");

    // COCO lists all images before all annotations: annotations go to a temporary file, so that each record is read
    // once.
    staged_file annotations = into.open("annotations.json");
    std::uint64_t images = 0, annotation_id = 0;
    coco.write(R"({"info":{"description":"synthetic side-scan sonar"},"categories":)" + categories.dump() +
               ",\"images\":[\n");
    for_each_record(root, [&](const std::string& path, std::uint64_t index) {
        const std::string name = (root / path).string();
        const std::string text = insonify::read_file(name);
        const json record = parse_record(text, name);
        if (record.at("id") != index)
            throw insonify::io_error(name + ": is the record of image " + record.at("id").dump() + "; remove it");
        if (const std::string other = differing_parameters(record, config); !other.empty())
            throw insonify::io_error(name + ": is of another set, with " + other + "; remove it");
        if (images == 0) manifest.write(line_of(record, true));
        manifest.write(line_of(record, false));
        card.add(record);
        if (preview) page.add(record);
        if (packs) {
            // The category of the target; 0 without one.
            const std::string image = record.at("files").at(0).at("path").get<std::string>();
            const auto category = category_ids.find(image.substr(7, image.find('/', 7) - 7));
            samples.add(index, text, record, category == category_ids.end() ? 0 : category->second);
        }
        coco.write((images == 0 ? "" : ",\n") + json{{"id", record.at("id")},
                                                     {"file_name", record.at("files").at(0).at("path")},
                                                     {"width", record.at("size")},
                                                     {"height", record.at("size")}}
                                                    .dump());
        ++images;
        for (const json& a : record.at("annotations")) {
            if (a.at("area") == 0) continue;
            annotations.write((annotation_id == 0 ? "" : ",\n") +
                              json{{"id", annotation_id + 1},
                                   {"image_id", record.at("id")},
                                   {"category_id", category_ids.at(a.at("category").get<std::string>())},
                                   {"bbox", a.at("bbox")},
                                   {"area", a.at("area")},
                                   {"iscrowd", 0},
                                   {"segmentation", a.at("segmentation")}}
                                  .dump());
            ++annotation_id;
        }
    });
    if (images == 0) throw insonify::io_error(root.string() + ": holds no images yet");
    coco.write("\n],\"annotations\":[\n");
    annotations.read_back([&](std::string_view bytes) { coco.write(bytes); });
    coco.write("\n]}\n");
    readme.write(card.text(config));

    std::string sums = readme.close() + coco.close();
    sums += sha256(insonify::read_file((root / "config.json").string())) + "  config.json\n";
    sums += manifest.close();
    sums += samples.close();
    // The page is optional and not listed in SHA256SUMS.
    if (preview) into.put({{{"preview.html", page.text(root.filename().string())}}});
    into.put({{{"SHA256SUMS", sums}}});
    return images;
}

}  // namespace

std::uint64_t write_tables(const fs::path& root, bool preview, staging& into) {
    std::uint64_t images = 0;
    into.retry_lost([&] { images = write_once(root, preview, into); });
    return images;
}

std::vector<std::string> table_faults(const fs::path& root) {
    std::vector<std::string> faults;
    if (!fs::exists(root / "SHA256SUMS")) return {"SHA256SUMS: is missing"};
    std::istringstream lines(insonify::read_file((root / "SHA256SUMS").string()));
    std::set<std::string> missing{"README.md", "annotations.json", "config.json", "manifest.csv"};
    const std::string config = pinned(root, "config.json").value("formats", json()).dump();
    if (config.find("webdataset") != std::string::npos && fs::is_directory(root / "records"))
        for (const auto& block : fs::directory_iterator(root / "records"))
            missing.insert("webdataset/" + block.path().filename().string() + ".tar");
    for (std::string sum, name; lines >> sum >> name;) {
        missing.erase(name);
        std::FILE* const file = std::fopen((root / name).string().c_str(), "rb");
        sha256_sum found;
        std::vector<char> bytes(1 << 20);
        while (file != nullptr) {
            const std::size_t size = std::fread(bytes.data(), 1, bytes.size(), file);
            if (size == 0) break;
            found.add({bytes.data(), size});
        }
        if (file == nullptr)
            faults.push_back(name + ": is missing");
        else if (const std::string digits = found.digits(); digits != sum)
            faults.push_back(name + ": SHA-256 is " + digits + ", was " + sum);
        if (file != nullptr) std::fclose(file);
    }
    for (const std::string& name : missing) faults.push_back("SHA256SUMS: does not name " + name);
    return faults;
}

}  // namespace generator
