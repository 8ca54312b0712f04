// Decodes the files of an image and compares masks with annotations.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace generator {

/// Why a file of a record does not decode or contradicts the annotations; empty if it is right.
std::optional<std::string> decode_fault(const std::string& bytes, const std::string& name,
                                        const nlohmann::ordered_json& record, const nlohmann::ordered_json& entry);

}  // namespace generator
