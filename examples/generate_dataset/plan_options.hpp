// What a line of a plan says of the options: size, mode, look. A set's manifest.csv has all that decide a pixel.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "options.hpp"
#include <nlohmann/json.hpp>

namespace generator {

/// Whether the command line has an option.
using is_given = std::function<bool(const char* option)>;

// The three below throw CLI::ValidationError, or plan_error, for options that contradict the plan.

/// Reads `--plan`, and takes from it what the command line leaves open.
void take_plan(options& o, const std::string& path, const is_given& given);
/// @param text  of `--aspects`; empty: the paper's aspects for its camera, otherwise none
void take_aspects(options& o, const std::string& text);
/// As many images as the plan has, or those of them that `--first` and `--count` say.
void count_plan(options& o, const is_given& given);

/// Columns of the options that decide pixels, of this recipe.
nlohmann::ordered_json columns_of_options(const options& o);

/// The options of one image.
/// @throws plan_error that names line, column and value
options with_line(const options& o, const plan_row& row);

/// What the lines of a recipe's plans may say.
struct known_columns {
    nlohmann::ordered_json examples;                          ///< a value of each that is sampled
    std::map<std::string, std::vector<std::string>> choices;  ///< of those that are one of a list
    std::vector<std::string> classes;
};

/// @throws plan_error for a column that the recipe has none of, or a value that it can't be
void check_columns(const options& o, const known_columns& known);

/// The aspects of `first:step:last`, of a list, or of one number, degrees.
/// @throws std::invalid_argument with a text that says what to write instead
std::vector<double> parse_aspects(const std::string& text);

}  // namespace generator
