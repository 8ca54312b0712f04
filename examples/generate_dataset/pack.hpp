// Tar files for WebDataset: a sample is the files of one image, named by its id.
#pragma once

#include <memory>
#include <string>

#include "staging.hpp"

namespace generator {

/// A tar in the making. The same members are the same bytes: times, owners and modes are constant.
class tar_pack {
  public:
    /// @param write  takes the tar's bytes
    explicit tar_pack(std::function<void(std::string_view)> write);
    /// @throws io_error
    void add(const std::string& name, std::string_view bytes);
    /// Writes the end of the tar.
    void close();

  private:
    struct state;
    std::shared_ptr<state> state_;
};

}  // namespace generator
