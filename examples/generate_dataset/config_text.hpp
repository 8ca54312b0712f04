// Reader of --config files: lines of `option = value`. Anything else is refused; CLI11 would skip it silently.
#pragma once

#include <insonify/core/error.hpp>

#include <algorithm>
#include <sstream>
#include <string>

#include "../common/input_file.hpp"
#include <CLI/CLI.hpp>

namespace generator {

/// CLI11's TOML reader behind a stricter check.
class strict_config : public CLI::ConfigTOML {
  public:
    explicit strict_config(const CLI::App& app) : app_(app) {}

    std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
        std::ostringstream all;
        all << input.rdbuf();
        const std::string text = all.str();
        check(text);
        std::istringstream bare(without_comments(text));
        return CLI::ConfigTOML::from_config(bare);
    }

  private:
    [[noreturn]] void refuse(std::size_t line, const std::string& reason) const {
        const auto file = app_.get_config_ptr()->as<std::string>();
        throw CLI::ConfigError("--config: " + file + ": line " + std::to_string(line) + ": " + reason,
                               CLI::ExitCodes::ConfigError);
    }

    /// Refuses everything but `option = value`.
    void check(const std::string& text) const {
        std::istringstream lines(text);
        std::string line;
        bool in_array = false;
        std::size_t number = 0;
        while (std::getline(lines, line)) {
            ++number;
            if (std::any_of(line.begin(), line.end(), examples::is_control))
                refuse(number, "this is not a text file; write lines like `count = 24`");
            line = without_comment(line);
            if (in_array) {
                in_array = !line.ends_with(']');
                continue;
            }
            if (line.empty() || line[0] == ';') continue;
            const std::size_t equals = line.find('=');
            if (line[0] == '[') refuse(number, "'" + shortened(line) + "' is a section; options have none, remove it");
            if (equals == std::string::npos) refuse(number, "'" + shortened(line) + "' is not `option = value`");
            std::string name = CLI::detail::trim_copy(line.substr(0, equals)),
                        value = CLI::detail::trim_copy(line.substr(equals + 1));
            if (app_.get_option_no_throw("--" + name) == nullptr || name == "config" || name == "help")
                refuse(number, "'" + shortened(name) + "' is not an option; --help lists them");
            if (value.empty()) refuse(number, "'" + name + "' has no value");
            // CLI11 splits at blanks, and an option with one value would take the last part.
            if (app_.get_option("--" + name)->get_items_expected_max() == 1 &&
                value.find_first_of(" \t") != std::string::npos && value[0] != '"' && value[0] != '\'' &&
                value[0] != '[')
                refuse(number, "'" + name + "': put a value with blanks in quotes");
            if (value == "[") refuse(number, "'" + name + " = [': begin the list on this line");
            in_array = value.starts_with('[') && !value.ends_with(']');
        }
        if (in_array) refuse(number, "']' is missing");
    }

    /// The text without comments, which CLI11 takes for a part of the value after a list.
    static std::string without_comments(const std::string& text) {
        std::istringstream lines(text);
        std::string bare, line;
        while (std::getline(lines, line)) bare += without_comment(line) + "\n";
        return bare;
    }
    /// The text before a '#' that is not in quotes, trimmed.
    static std::string without_comment(const std::string& line) {
        char quote = 0;
        std::size_t end = 0;
        for (; end < line.size() && (quote != 0 || line[end] != '#'); ++end)
            if (quote != 0 ? line[end] == quote : line[end] == '"' || line[end] == '\'')
                quote = quote != 0 ? '\0' : line[end];
        return CLI::detail::trim_copy(line.substr(0, end));
    }

    static std::string shortened(const std::string& text) {
        return text.size() > 40 ? text.substr(0, 40) + "..." : text;
    }

    const CLI::App& app_;
};

/// Accepts a regular file of at most 1 MiB.
inline CLI::Validator config_file() {
    return CLI::Validator(
        [](std::string& path) -> std::string {
            try {
                examples::read_input(path, 1 << 20, "a configuration is shorter");
            } catch (const insonify::io_error& error) {
                return error.what();
            }
            return "";
        },
        "", "configuration");
}

}  // namespace generator
