#include "record.hpp"

#include <insonify/io/file.hpp>

#include <algorithm>
#include <charconv>
#include <vector>

#include "checksum.hpp"
#include "decode.hpp"

namespace generator {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view checksum_prefix = R"(,"sha256":")", checksum_suffix = "\"}\n";
constexpr std::size_t checksum_digits = 64;

/// Why one file of a record is missing or altered; empty if it is not.
std::optional<std::string> file_fault(const fs::path& root, const json& record, const json& entry, depth checked) {
    const std::string name = entry.at("path").get<std::string>();
    const std::string path = (root / name).string();
    std::error_code failed;
    const std::uint64_t size = fs::file_size(path, failed);
    if (failed) return name + ": is missing (" + failed.message() + ")";
    const auto expected = entry.at("bytes").get<std::uint64_t>();
    if (size != expected) return name + ": has " + std::to_string(size) + " bytes, had " + std::to_string(expected);
    if (checked == depth::sizes) return std::nullopt;
    const std::string bytes = insonify::read_file(path);
    const std::string sum = sha256(bytes);
    if (sum != entry.at("sha256").get<std::string>())
        return name + ": SHA-256 is " + sum + ", was " + entry.at("sha256").get<std::string>();
    if (checked == depth::pixels) return decode_fault(bytes, name, record, entry);
    return std::nullopt;
}

/// Sorted names in a folder.
std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    if (fs::is_directory(folder))
        for (const auto& entry : fs::directory_iterator(folder)) {
            const std::string name = entry.path().filename().string();
            if (!name.starts_with('.')) names.push_back(name);
        }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

json entry_of(const std::string& of, const file& f) {
    return {{"of", of}, {"path", f.path}, {"bytes", f.bytes.size()}, {"sha256", sha256(f.bytes)}};
}

std::string record_text(const json& record) {
    // File names need not be UTF-8.
    std::string text = record.dump(-1, ' ', false, json::error_handler_t::replace);
    text.pop_back();  // the closing brace
    const std::string sum = sha256(text);
    text += checksum_prefix;
    text += sum;
    text += checksum_suffix;
    return text;
}

json parse_record(const std::string& text, const std::string& name) {
    const std::size_t end = checksum_prefix.size() + checksum_digits + checksum_suffix.size();
    const bool whole = text.size() > end && text.ends_with(checksum_suffix) &&
                       text.compare(text.size() - end, checksum_prefix.size(), checksum_prefix) == 0 &&
                       text.compare(text.size() - end + checksum_prefix.size(), checksum_digits,
                                    sha256(std::string_view(text).substr(0, text.size() - end))) == 0;
    json record = whole ? json::parse(text, nullptr, false) : json();
    if (!record.is_object())
        throw insonify::io_error(name + ": is truncated or altered; run the command again to repair it");
    // A hostile record could name a path outside of its folder.
    for (const json& entry : record.contains("files") ? record["files"] : json::array()) {
        const bool named = entry.is_object() && entry.contains("path") && entry["path"].is_string();
        const std::string path = named ? entry["path"].get<std::string>() : "";
        if (!(path.starts_with("images/") || path.starts_with("masks/") || path.starts_with("values/")) ||
            path.find("..") != std::string::npos)
            throw insonify::io_error(name + ": names the file '" + path +
                                     "', which is not a path of a data set; remove it");
    }
    return record;
}

std::string differing_parameters(const json& record, const json& config) {
    for (const auto& [name, facts] : config.at("inputs").items())
        if (name.find(" --plan ") != std::string::npos) return "";
    std::string text;
    for (const auto& [parameter, option] : {std::pair("recipe", "recipe"), {"seed", "seed"}, {"size_px", "size"}}) {
        const json& parameters = record.at("parameters");
        if (!parameters.contains(parameter) || parameters.at(parameter) == config.at(option)) continue;
        text += std::string(text.empty() ? "" : ", ") + option + " " + parameters.at(parameter).dump() +
                " instead of " + config.at(option).dump();
    }
    return text;
}

std::optional<std::string> fault_of(const fs::path& root, std::uint64_t index, const json& config, depth checked) {
    const std::string name = record_path(index);
    const std::string path = (root / name).string();
    try {
        if (!fs::exists(path)) return name + ": is missing";
        const json record = parse_record(insonify::read_file(path), name);
        if (record.at("id") != index) return name + ": is the record of image " + record.at("id").dump();
        if (const std::string other = differing_parameters(record, config); !other.empty())
            return name + ": is of another set, with " + other;
        for (const json& entry : record.at("files"))
            if (auto fault = file_fault(root, record, entry, checked)) return fault;
    } catch (const std::exception& error) {
        return error.what();
    }
    return std::nullopt;
}

void for_each_record(const fs::path& root, const std::function<void(const std::string&, std::uint64_t)>& visit) {
    for (const std::string& block : names_in(root / "records"))
        for (const std::string& name : names_in(root / "records" / block)) {
            std::uint64_t index = 0;
            std::from_chars(name.data(), name.data() + name.size(), index);
            const std::string path = "records/" + block + "/" + name;
            if (path != record_path(index))
                throw insonify::io_error((root / path).string() + ": is not a record; remove it");
            visit(path, index);
        }
}

}  // namespace generator
