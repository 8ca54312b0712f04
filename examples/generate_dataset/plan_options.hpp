// Options that a line of a plan overrides: size, mode, look. The manifest.csv of a set has every option that decides a
// pixel.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "options.hpp"
#include <nlohmann/json.hpp>

namespace generator {

/// Returns whether the command line has an option.
using is_given = std::function<bool(const char* option)>;

// The three below throw CLI::ValidationError, or plan_error, for options that contradict the plan.

/// Reads `--plan`, and takes recipe, mode, formats and seabeds from it unless the command line gives them.
void apply_plan(options& o, const std::string& path, const is_given& given);
/// Parses `--aspects`. Empty text means the paper's aspects for its camera, and random ones otherwise.
void apply_aspects(options& o, const std::string& text);
/// Sets the number of images from the plan, or checks `--first` and `--count` against it.
void apply_plan_count(options& o, const is_given& given);

/// The options of this recipe that decide pixels, by column.
nlohmann::ordered_json columns_of_options(const options& o);

/// The options of one image.
/// @throws plan_error that names line, column and value
options with_line(const options& o, const plan_row& row);

/// The columns that plans of a recipe may have.
struct known_columns {
    nlohmann::ordered_json examples;                          ///< a value of each sampled column
    std::map<std::string, std::vector<std::string>> choices;  ///< allowed values of columns that name one of a list
    std::vector<std::string> classes;
};

/// @throws plan_error for a column that the recipe does not have, or a value outside its range or list
void check_columns(const options& o, const known_columns& known);

/// The aspects of `first:step:last`, of a list, or of one number, degrees.
/// @throws std::invalid_argument whose text shows the expected form
std::vector<double> parse_aspects(const std::string& text);

}  // namespace generator
