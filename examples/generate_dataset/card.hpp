// README.md of a data set: what it holds and how to make it again, for a person who finds the folder.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace generator {

using json = nlohmann::ordered_json;

class data_card {
  public:
    void add(const json& record);
    std::string text(const json& config) const;

  private:
    struct column {
        std::uint64_t count = 0;
        double lowest = 0, highest = 0, sum = 0;
        std::map<std::string, std::uint64_t> words;  ///< the first 50 and how often they are there
    };
    std::uint64_t images_ = 0, bytes_ = 0, files_ = 0;
    std::vector<std::string> names_;  ///< of columns, as records have them
    std::map<std::string, column> columns_;
    std::map<std::string, std::string> samples_;  ///< by class: the first image
};

}  // namespace generator
