// SHA-256, as lower-case hexadecimal digits: what `sha256sum` prints.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace generator {

/// Of bytes that come in pieces.
class sha256_sum {
  public:
    sha256_sum();
    void add(std::string_view bytes);
    /// To be called once, at the end.
    std::string digits();

  private:
    std::unique_ptr<void, void (*)(void*)> context_;
};

std::string sha256(std::string_view bytes);

}  // namespace generator
