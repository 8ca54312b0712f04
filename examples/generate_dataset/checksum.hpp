// SHA-256 as lower-case hexadecimal digits, as `sha256sum` prints it.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace generator {

/// SHA-256 of bytes added in pieces.
class sha256_sum {
  public:
    sha256_sum();
    void add(std::string_view bytes);
    /// The digits. Call once, at the end.
    std::string digits();

  private:
    std::unique_ptr<void, void (*)(void*)> context_;
};

std::string sha256(std::string_view bytes);

}  // namespace generator
