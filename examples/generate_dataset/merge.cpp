// merge_dataset: joins the shards of a data set, which are in one folder or in several. See --help and tools/merge.
#include <cstdio>

#include "../common/refusal.hpp"
#include "configuration.hpp"
#include "folder.hpp"
#include "lock.hpp"
#include "record.hpp"
#include "tables.hpp"
#include "writer.hpp"
#include <CLI/CLI.hpp>

namespace {

namespace fs = std::filesystem;
using generator::json;
using insonify::io_error;

/// The files of an image; the record is the last one.
/// @throws io_error if the image is not complete
std::vector<generator::file> read_image(const fs::path& from, std::uint64_t index, const json& config) {
    if (const auto fault = generator::fault_of(from, index, config, generator::depth::checksums))
        throw io_error(from.string() + "/" + *fault + "; run the shard again");
    const std::string path = generator::record_path(index), text = insonify::read_file((from / path).string());
    std::vector<generator::file> files;
    const json record = generator::parse_record(text, path);
    for (const json& entry : record.at("files")) {
        const std::string name = entry.at("path").get<std::string>();
        files.push_back({name, insonify::read_file((from / name).string())});
    }
    files.push_back({path, text});
    return files;
}

/// Copies the images that `root` lacks from another folder.
void copy_missing(const fs::path& root, const fs::path& from, generator::staging& into) {
    for (const char* const name : {"config.json", "shards.json"}) {
        const json theirs = generator::pinned(from, name);
        if (theirs.is_null() && generator::pinned(root, name).is_null()) continue;
        generator::pin(root, name, theirs, into);
    }
    const json config = generator::pinned(root, "config.json");
    generator::writer files(into);
    generator::for_each_record(from, [&](const std::string&, std::uint64_t index) {
        if (generator::fault_of(root, index, config, generator::depth::checksums))
            files.add(read_image(from, index, config));
    });
    files.finish();
}

/// @throws io_error that lists the shards with images that are missing or whose files differ from the recorded sizes
void check_complete(const fs::path& root, const json& config, const json& shards) {
    const auto first = shards.at("first").get<std::uint64_t>(), count = shards.at("count").get<std::uint64_t>(),
               of = shards.at("shards").get<std::uint64_t>();
    std::vector<std::uint64_t> ids;  // of a plan whose ids have gaps
    for (const json& run : shards.value("ids", json::array()))
        for (auto id = run.at(0).get<std::uint64_t>(); id <= run.at(1).get<std::uint64_t>() && ids.size() < count; ++id)
            ids.push_back(id);
    if (shards.contains("ids") && ids.size() != count) throw io_error(root.string() + "/shards.json: is damaged");
    std::uint64_t missing = 0;
    std::string text;
    for (std::uint64_t k = 0; k < of; ++k) {
        const generator::index_range range = generator::range_of(first, count, {k, of});
        std::uint64_t lacking = 0, example = 0;
        for (std::uint64_t i = range.first; i < range.last; ++i) {
            const std::uint64_t expected = ids.empty() ? i : ids[static_cast<std::size_t>(i - first)];
            if (generator::fault_of(root, expected, config, generator::depth::sizes) && lacking++ == 0)
                example = expected;
        }
        if (lacking > 0 && text.size() < 2000)
            text += "\n  shard " + std::to_string(k) + "/" + std::to_string(of) + " lacks " + std::to_string(lacking) +
                    " of its images, such as " + generator::id_of(example);
        else if (lacking > 0 && !text.ends_with("..."))
            text += "\n  ...";
        missing += lacking;
    }
    if (missing > 0)
        throw io_error(root.string() + ": " + std::to_string(missing) + " of " + std::to_string(count) +
                       " images are missing or damaged; run these shards again, then merge:" + text);
}

}  // namespace

int main(int argc, char** argv) try {
    std::string out;
    std::vector<std::string> folders;
    bool preview = false;
    CLI::App app{
        "Joins the shards of a data set: checks that all images are there, and writes the tables. Afterwards the "
        "folder has\nthe same bytes as one that was made without shards.",
        "merge_dataset"};
    app.add_option("out", out, "Folder of the joined set; that of the shards, if they all wrote to one")->required();
    app.add_flag("--preview", preview, "Write preview.html, a page to look through the set");
    app.add_option("folders", folders, "Folders of the shards, if they wrote to several");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        examples::exit_after(app, error);
    }

    if (folders.empty() && !fs::exists(generator::folder_path(out))) throw io_error(out + ": does not exist");
    for (const std::string& folder : folders)
        if (!fs::exists(generator::folder_path(folder) / "config.json")) throw io_error(folder + ": holds no data set");
    const fs::path root = generator::open_folder(out);
    const generator::folder_lock lock(root, -1);
    std::uint64_t images = 0;
    {
        generator::staging into(root, "all");
        for (const std::string& folder : folders) copy_missing(root, generator::folder_path(folder), into);
        const json config = generator::pinned(root, "config.json");
        if (config.is_null()) throw io_error(out + ": holds no data set; name the folders of its shards, too");
        if (const json shards = generator::pinned(root, "shards.json"); !shards.is_null())
            check_complete(root, config, shards);
        images = generator::write_tables(root, preview, into);
    }
    fs::remove(root / "shards.json");
    fs::remove_all(root / ".partial");
    generator::sync_folder(root);
    std::printf("%s: %llu images\n", out.c_str(), static_cast<unsigned long long>(images));
    return 0;
} catch (const json::exception&) {
    std::fprintf(stderr, "merge_dataset: config.json, shards.json or a record is damaged; run the shards again\n");
    return 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "merge_dataset: %s\n", error.what());
    return 1;
}
