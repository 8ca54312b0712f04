// Tables of plans on any text: lines within the reader's limits, or a refusal that says where.
#include "../../examples/generate_dataset/csv.hpp"
#include "../../examples/generate_dataset/plan_options.hpp"
#include "../../examples/generate_dataset/plan_table.hpp"
#include "fuzz.hpp"

using fuzzing::demand;
using generator::plan_row;

namespace {

/// The text of a table.
std::string written(const generator::plan_table& table) {
    std::string text, line;
    for (const auto& [column, cell] : table.row(0).cells)
        text += (text.empty() ? "" : ",") + generator::csv_cell(column);
    for (std::size_t i = 0; i < table.size(); ++i) {
        line.clear();
        const plan_row row = table.row(i);
        for (const auto& [column, cell] : row.cells) line += (line.empty() ? "\r\n" : ",") + generator::csv_cell(cell);
        text += line;
    }
    return text;
}

/// A table that is written is read again, with the same cells.
void check_written(const generator::plan_table& table) try {
    const generator::plan_table other("again.csv", written(table));
    demand(other.size() == table.size(), "a table that is written holds as many lines");
    for (std::size_t i = 0; i < table.size(); ++i)
        demand(other.row(i).cells == table.row(i).cells, "a table that is written holds the same");
} catch (const insonify::io_error&) {
    demand(false, "a table that is written is read again");
}

void read_options(const generator::plan_table& table) {
    for (const char* const recipe : {"sonar", "published"}) {
        generator::options o;
        o.recipe = recipe;
        for (std::size_t i = 0; i < table.size(); ++i) try {
                const generator::options own = generator::with_line(o, table.row(i));
                demand(own.size >= 16 && own.size <= 16384, "size is that of an image");
                demand(own.chip >= 0 && own.chip <= 1e4 && (own.is_overhead() || own.chip > 0 || own.is_sonar()),
                       "a chip has a size");
            } catch (const generator::plan_error& error) {
                demand(std::string(error.what()).find(": line ") != std::string::npos, "a refusal names the line");
            }
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        const generator::plan_table table("t.csv", text);
        demand(table.size() > 0, "a plan has a line");
        for (std::size_t i = 0; i < table.size(); ++i) {
            const plan_row row = table.row(i);
            demand(row.find("class") != nullptr, "a line has a class");
            demand(i == 0 || table.id(i - 1) < table.id(i), "ids increase");
        }
        read_options(table);
        check_written(table);
    } catch (const insonify::io_error& error) {  // anything else that is thrown ends the program
        demand(std::string(error.what()).find("t.csv") != std::string::npos, "a refusal names the table");
    }
    try {
        for (const double aspect : generator::parse_aspects(text.substr(0, 64)))
            demand(aspect >= -360 && aspect <= 360 + 1e-6, "an aspect is an angle");
    } catch (const std::invalid_argument&) {
    }
    return 0;
}
