// The generator's command line and configuration file on any text: options within their ranges, or a refusal.
#include "../../examples/generate_dataset/options.hpp"

#include <string>
#include <string_view>
#include <vector>

#include "fuzz.hpp"
#include <sys/mman.h>
#include <unistd.h>

using fuzzing::demand;

namespace {

void check(const generator::options& o) {
    const auto within = [](const generator::range& r, double low, double high) {
        demand(low <= r.low && r.low <= r.high && r.high <= high, "a range lies within its limits");
    };
    within(o.target_size, 1e-3, 1e3), within(o.aspect, 1e-2, 1e2), within(o.tilt, -90, 90), within(o.burial, 0, 0.95);
    within(o.altitude, 1e-2, 1e4), within(o.grazing, 0.01, 90), within(o.distance, 0, 1e3), within(o.beam, 1e-3, 20);
    demand(o.count >= 1 && o.first + o.count <= 1'000'000'000, "ids have nine digits");
    demand(o.size >= 16 && o.size <= 16384, "size is that of an image");
    demand(!o.targets.empty() || !o.meshes.empty(), "there is a class");
    demand(o.shard.number < o.shard.of && o.shard.of <= o.count, "a shard is one of its shards");
    demand(o.formats.size() <= 4, "a format is named once");
    for (const generator::noise_step& step : generator::noise_steps(o))
        demand(step.strength >= 0, "noise has a strength");
}

/// @param text  a command line, an argument a line; after a line `---`, the text of its configuration file
void run(std::string_view text) {
    std::vector<std::string> words{"generate_dataset", "--out", "a"};
    const std::size_t cut = text.find("\n---\n");
    const bool configured = cut != std::string_view::npos;
    std::string_view line = configured ? text.substr(0, cut) : text;
    while (!line.empty()) {
        const std::size_t end = (std::min)(line.find('\n'), line.size());
        const std::string word(line.substr(0, end));
        // This test does not read files of the machine.
        if (word.find('/') != std::string::npos || word.find("--config") == 0) return;
        words.push_back(word.substr(0, word.find('\0')));
        line.remove_prefix((std::min)(end + 1, line.size()));
    }
    const int file = configured ? ::memfd_create("configuration", 0) : -1;
    if (configured) {
        const std::string_view rest = text.substr(cut + 5);
        demand(::write(file, rest.data(), rest.size()) == static_cast<ssize_t>(rest.size()), "memory takes the file");
        words.push_back("--config=/proc/self/fd/" + std::to_string(file));
    }
    std::vector<const char*> arguments;
    for (const std::string& word : words) arguments.push_back(word.c_str());
    try {
        check(generator::parse_quietly(static_cast<int>(arguments.size()), arguments.data()));
    } catch (const insonify::invalid_input&) {  // anything else that is thrown ends the program
    }
    if (configured) ::close(file);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    run({reinterpret_cast<const char*>(data), size});
    return 0;
}
