// Compound targets: several meshes, each with its own reflectivity.
#pragma once

#include <insonify/geometry/objects/detail/solids.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A part of a compound.
struct compound_part {
    mesh shape;  ///< with or without normals
    pose placement;
    float reflectivity = 1;  ///< relative to the target's material, >= 0: 1 for steel plating, less for rubber or wood
};

/// A list of parts that moves and is labelled as one target. Built from primitives, imported meshes and other objects.
struct compound {
    std::vector<compound_part> parts;

    /// Adds a mesh, or anything that has a `to_mesh`.
    template <class Shape>
    INSONIFY_TAGGED compound& add(const Shape& shape, const pose& placement = {}, float reflectivity = 1) {
        if constexpr (requires { shape.triangles; })
            parts.push_back({shape, placement, reflectivity});
        else
            parts.push_back({to_mesh(shape), placement, reflectivity});
        return *this;
    }
};

/// A compound's parts in one mesh, and which triangle came from which part.
struct merged_compound {
    mesh shape;                           ///< with normals if every part has them
    std::vector<std::uint16_t> part_ids;  ///< by triangle: an index of `reflectivities`
    std::vector<float> reflectivities;    ///< by part
};

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a part without matching indices or normals, a reflectivity that is negative or not finite,
///         or more than 65535 parts
inline void validate(const compound& c) {
    detail::require(c.parts.size() <= 65535, "compound.parts.size()", c.parts.size(), "at most 65535");
    for (const compound_part& p : c.parts) {
        validate(p.shape);
        detail::require_not_negative("compound_part.reflectivity", p.reflectivity);
    }
}

/// The parts, placed, in one mesh. It is solid if every part is and no two parts share an edge.
/// @throws invalid_input as `validate` and `to_world` do
inline merged_compound merge(const compound& c) {
    validate(c);
    merged_compound out;
    bool has_normals = true;
    for (const compound_part& p : c.parts) has_normals = has_normals && !p.shape.normals.empty();
    for (std::size_t i = 0; i < c.parts.size(); ++i) {
        detail::append(out.shape, c.parts[i].shape, to_world(c.parts[i].placement));
        out.part_ids.resize(out.shape.triangles.size(), static_cast<std::uint16_t>(i));
        out.reflectivities.push_back(c.parts[i].reflectivity);
    }
    if (!has_normals) out.shape.normals.clear();
    return out;
}

/// The parts as one mesh, without their reflectivities.
/// @throws invalid_input as `merge` does
inline mesh to_mesh(const compound& c) {
    return merge(c).shape;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
