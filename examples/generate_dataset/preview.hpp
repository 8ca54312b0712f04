// preview.html: a page to browse a data set offline.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace generator {

using json = nlohmann::ordered_json;

/// Collects the images of the page. Of a large set it keeps every 2nd, 4th, 8th ... image, at most 20 000 of them,
/// which a browser can hold.
class preview_page {
  public:
    void add(const json& record);
    std::string text(const std::string& title) const;

  private:
    static constexpr std::size_t max_rows = 20'000;
    std::uint64_t images_ = 0, step_ = 1;
    std::vector<std::string> names_;  ///< of the parameters
    std::vector<std::string> rows_;
};

}  // namespace generator
