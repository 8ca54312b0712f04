// preview.html: one page to look through a data set, without a server or a network.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace generator {

using json = nlohmann::ordered_json;

/// Collects what the page shows. Of a large set, that is every second, fourth, ... image, so that a browser can hold
/// it.
class preview_page {
  public:
    void add(const json& record);
    std::string text(const std::string& title) const;

  private:
    static constexpr std::size_t most_rows = 20'000;
    std::uint64_t images_ = 0, step_ = 1;
    std::vector<std::string> names_;  ///< of the parameters
    std::vector<std::string> rows_;
};

}  // namespace generator
