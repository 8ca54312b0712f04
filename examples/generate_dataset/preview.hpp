// preview.html: a page to browse a data set offline.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace generator {

using json = nlohmann::ordered_json;

/// Collects the images of the page. Of a large set it keeps a half, a quarter, an eighth ... at random, at most 20 000
/// images, which a browser can hold. Every second one would leave out classes that take turns.
class preview_page {
  public:
    void add(const json& record);
    std::string text(const std::string& title) const;

  private:
    static constexpr std::size_t max_rows = 20'000;
    std::uint64_t images_ = 0, step_ = 1;
    std::vector<std::string> names_;  ///< of the parameters
    struct row {
        std::uint32_t lot;  ///< kept while it is a multiple of step_
        std::string text;
    };
    std::vector<row> rows_;
};

}  // namespace generator
