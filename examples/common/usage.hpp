// Command lines of programs that take files by position.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace examples {

/// Prints the usage and ends the program: with 0 for --help, with 2 for an unknown option or a wrong number of
/// arguments.
/// @param usage  the arguments, and what the program does with them
inline void check_arguments(int argc, char** argv, int fewest, int most, const char* usage) {
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (word == "--help" || word == "-h") {
            std::printf("Usage: %s\n", usage);
            std::exit(0);
        }
        if (word.starts_with("--")) {
            std::fprintf(stderr, "'%s' is not an option. Usage: %s\n", argv[i], usage);
            std::exit(2);
        }
    }
    if (argc - 1 >= fewest && argc - 1 <= most) return;
    std::fprintf(stderr, "Too %s arguments: %d. Usage: %s\n", argc - 1 < fewest ? "few" : "many", argc - 1, usage);
    std::exit(2);
}

}  // namespace examples
