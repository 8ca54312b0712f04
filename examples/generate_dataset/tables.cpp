#include "tables.hpp"

#include <insonify/io/file.hpp>

#include <map>
#include <sstream>

#include "checksum.hpp"
#include "record.hpp"

namespace generator {

namespace fs = std::filesystem;

namespace {

/// A table in the making, with the checksum of what was written.
class table {
  public:
    table(staging& into, std::string name) : into_(into), name_(std::move(name)), file_(into.open(name_)) {}

    void write(std::string_view bytes) {
        file_.write(bytes);
        sum_.add(bytes);
    }
    /// Puts the table in its place. @returns its line of SHA256SUMS
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

}  // namespace

std::string csv_cell(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + '"';
}

namespace {

std::uint64_t write_once(const fs::path& root, const std::vector<std::string>& classes, staging& into) {
    table coco(into, "annotations.json"), manifest(into, "manifest.csv");
    json categories = json::array();
    std::map<std::string, std::size_t> category_ids;
    const auto add_category = [&](const std::string& name, const char* kind) {
        category_ids[name] = category_ids.size() + 1;
        categories.push_back({{"id", category_ids[name]}, {"name", name}, {"supercategory", kind}});
    };
    for (const std::string& name : classes) add_category(name, "target");
    add_category("shadow", "shadow");

    // The images come first and the annotations after all of them, but each record is read once.
    staged_file annotations = into.open("annotations.json");
    std::uint64_t images = 0, annotation_id = 0;
    coco.write(R"({"info":{"description":"synthetic side-scan sonar"},"categories":)" + categories.dump() +
               ",\"images\":[\n");
    for_each_record(root, [&](const std::string& path, std::uint64_t index) {
        const std::string name = (root / path).string();
        const json record = parse_record(insonify::read_file(name), name);
        if (record.at("id") != index)
            throw insonify::io_error(name + ": is the record of image " + record.at("id").dump() + "; remove it");
        if (images == 0) manifest.write(line_of(record, true));
        manifest.write(line_of(record, false));
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
    coco.write("\n],\"annotations\":[\n");
    annotations.read_back([&](std::string_view bytes) { coco.write(bytes); });
    coco.write("\n]}\n");

    std::string sums = coco.close();
    sums += sha256(insonify::read_file((root / "config.json").string())) + "  config.json\n";
    sums += manifest.close();
    into.put({{{"SHA256SUMS", sums}}});
    return images;
}

}  // namespace

std::uint64_t write_tables(const fs::path& root, const std::vector<std::string>& classes, staging& into) {
    std::uint64_t images = 0;
    into.until_kept([&] { images = write_once(root, classes, into); });
    return images;
}

std::vector<std::string> table_faults(const fs::path& root) {
    std::vector<std::string> faults;
    if (!fs::exists(root / "SHA256SUMS")) return {"SHA256SUMS: is missing"};
    std::istringstream lines(insonify::read_file((root / "SHA256SUMS").string()));
    std::size_t checked = 0;
    for (std::string sum, name; lines >> sum >> name; ++checked) {
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
    if (checked != 3) faults.push_back("SHA256SUMS: names " + std::to_string(checked) + " files, expected 3");
    return faults;
}

}  // namespace generator
