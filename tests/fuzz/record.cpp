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
    const std::string cell = generator::csv_cell(text);
    if (cell.starts_with('"')) {
        std::string plain;
        for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
            plain += cell[i];
            if (cell[i] == '"') demand(cell[++i] == '"', "a quote within a cell is doubled");
        }
        demand(plain == text || cell == text, "a cell holds its text");
    }
    return 0;
}
