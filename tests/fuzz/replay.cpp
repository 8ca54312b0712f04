// Runs a fuzz target over files, for compilers without a fuzzer: replay_<target> <folder or file>...
#include <insonify/io/file.hpp>

#include <filesystem>

#include "fuzz.hpp"

namespace {

int replayed = 0;

void replay(const std::filesystem::path& path) {
    // Printed first: if the target aborts, the last line names the input.
    std::printf("%s\n", path.string().c_str());
    std::fflush(stdout);
    const std::string bytes = insonify::read_file(path.string());
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    ++replayed;
}

}  // namespace

int main(int count, char** arguments) {
    for (const std::filesystem::path path : std::span(arguments, static_cast<std::size_t>(count)).subspan(1)) {
        if (std::filesystem::is_directory(path))
            for (const auto& entry : std::filesystem::directory_iterator(path)) replay(entry.path());
        else
            replay(path);
    }
    std::printf("%d inputs\n", replayed);
    return replayed > 0 ? 0 : 1;
}
