// README.md of a data set: what it holds and how to make it again.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace generator {

using json = nlohmann::ordered_json;

/// Statistics of a data set as a page in Markdown: `add` takes the record of each image, `text` the configuration.
class data_card {
  public:
    void add(const json& record);
    std::string text(const json& config) const;

  private:
    struct column {
        std::uint64_t count = 0;
        double lowest = 0, highest = 0, sum = 0;
        json first;
        bool is_constant = true;
        std::map<std::string, std::uint64_t> words;  ///< counts of the first 50 distinct values
        bool has_more_words = false;
    };
    std::uint64_t images_ = 0, bytes_ = 0, files_ = 0;
    std::vector<std::string> names_;  ///< of columns, in the order of the records
    std::map<std::string, column> columns_;
    std::map<std::string, std::string> samples_;  ///< first image of each class
};

}  // namespace generator
