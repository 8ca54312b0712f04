// Reports an invalid command line of a program that parses its options with CLI11.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace examples {

/// Number of insertions, deletions and replacements that turn one word into another (Levenshtein distance).
inline std::size_t edits_between(const std::string& from, const std::string& to) {
    std::vector<std::size_t> row(to.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < from.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < to.size(); ++j) {
            const std::size_t replaced = diagonal + (from[i] != to[j]);
            diagonal = row[j + 1];
            row[j + 1] = (std::min)({replaced, diagonal + 1, row[j] + 1});
        }
    }
    return row[to.size()];
}

/// The option whose name is closest to a word, empty if none is within two edits. Ties go to the longer common prefix.
inline std::string similar_option(const CLI::App& app, const std::string& word) {
    std::string best;
    std::pair least{std::size_t{2}, std::ptrdiff_t{1}};  // edits, and minus the characters in common
    for (const CLI::Option* const option : app.get_options())
        for (const std::string& name : option->get_lnames()) {
            const std::string candidate = "--" + name;
            const auto differs = std::mismatch(word.begin(), word.end(), candidate.begin(), candidate.end()).first;
            if (const std::pair rank{edits_between(word, candidate), word.begin() - differs}; rank < least) {
                least = rank;
                best = candidate;
            }
        }
    return best;
}

/// Prints the help or the error and ends the program: with 0 after --help, otherwise with 2. For an unknown option,
/// suggests the one with the most similar name.
[[noreturn]] inline void exit_after(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) std::exit(app.exit(error));
    bool is_unknown = false;
    for (const std::string& word : app.remaining()) {
        if (!word.starts_with("--")) continue;
        const std::string name = word.substr(0, word.find('=')), similar = similar_option(app, name);
        std::fprintf(stderr, "%s is not an option%s\n", name.c_str(),
                     similar.empty() ? "" : ("; did you mean " + similar + "?").c_str());
        is_unknown = true;
    }
    const std::string what = error.what();
    const bool lacks_value = what.find(": 1 required ") != std::string::npos;
    if (lacks_value) std::fprintf(stderr, "%s: its value is missing\n", what.substr(0, what.find(':')).c_str());
    if (is_unknown || lacks_value)
        std::fputs("Run with --help for more information.\n", stderr);
    else
        app.exit(error);
    std::exit(2);
}

}  // namespace examples
