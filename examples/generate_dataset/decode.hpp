// Looks into the files of an image: whether they decode, and show what the annotations say.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace generator {

/// What is wrong with the bytes of a PNG that belongs to a record.
std::optional<std::string> decode_fault(const std::string& bytes, const std::string& name,
                                        const nlohmann::ordered_json& record, const nlohmann::ordered_json& entry);

}  // namespace generator
