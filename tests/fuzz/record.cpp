// Records of a data set on any JSON, with a valid checksum: parsed, or refused by the reader's own error; and pinned
// files.
#include "../../examples/generate_dataset/record.hpp"

#include "../../examples/generate_dataset/checksum.hpp"
#include "../../examples/generate_dataset/csv.hpp"
#include "../../examples/generate_dataset/formats.hpp"
#include "fuzz.hpp"

namespace in = insonify;
using fuzzing::demand;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    for (const bool sealed : {false, true}) {
        try {
            const std::string whole = sealed ? text + ",\"sha256\":\"" + generator::sha256(text) + "\"}\n" : text;
            const auto record = generator::parse_record(whole, "record");
            demand(record.is_object(), "a record is an object");
            for (const auto& entry : record.value("files", generator::json::array()))
                demand(entry.at("path").get<std::string>().find("..") == std::string::npos,
                       "a path stays in its folder");
        } catch (const in::io_error&) {  // anything else that is thrown ends the program
        }
    }
    for (const char* const of : {"png16", "npy", "pfm"}) try {
            (void)generator::format_fault(of, text, 8);
        } catch (const in::io_error&) {
        }
    if (std::none_of(text.begin(), text.end(), examples::is_control)) {
        std::vector<std::string> cells;
        const std::string line = "x," + generator::csv_cell(text) + "\n";
        generator::csv_reader reader("t.csv", line);
        demand(reader.next(cells) && cells == std::vector<std::string>{"x", text}, "a cell holds its text");
    }
    return 0;
}
