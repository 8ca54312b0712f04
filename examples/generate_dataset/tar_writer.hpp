// Tar files for WebDataset: a sample is the files of one image, named by its id.
#pragma once

#include <memory>
#include <string>

#include "staging.hpp"

namespace generator {

/// Writes a tar file. Times, owners and modes are constant, so that equal members give equal bytes.
class tar_writer {
  public:
    /// @param write  receives the bytes of the tar
    explicit tar_writer(std::function<void(std::string_view)> write);
    /// @throws io_error
    void add(const std::string& name, std::string_view bytes);
    /// Writes the end of the tar.
    void close();

  private:
    struct state;
    std::shared_ptr<state> state_;
};

}  // namespace generator
