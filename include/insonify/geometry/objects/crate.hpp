// Wooden crates, whole or with boards missing.
#pragma once

#include <insonify/geometry/creases.hpp>
#include <insonify/geometry/objects/detail/solids.hpp>

#include <algorithm>
#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A hollow crate of boards on corner posts, standing on z = 0 while a side board is left. Long sides along x.
///
/// The default footprint is the pallet of 1.2 m by 0.8 m (ISO 6780, EN 13698-1) that transport cases are sized for.
struct crate {
    glm::vec3 size{1.2f, 0.8f, 0.8f};  ///< metres; the largest at most 50 times the least
    float board = 0.025f;              ///< thickness, metres, 1/1000 of the largest to 1/10 of the least size
    int boards = 5;                    ///< one above another on each side, 1 to 64
    float gap = 0.1f;                  ///< share of a board's width that is open between two, 0.01 to 0.9
    bool is_open = false;              ///< the lid is missing
    float damage = 0;                  ///< probability that a board of a side or of the lid is missing, 0 to 1
    std::uint64_t seed = 1;            ///< selects the missing ones
};

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value outside its range
inline void validate(const crate& c) {
    const float largest = (std::max)((std::max)(c.size.x, c.size.y), c.size.z);
    const float least = (std::min)((std::min)(c.size.x, c.size.y), c.size.z);
    for (int i = 0; i < 3; ++i) {
        detail::require_size("crate.size", c.size[i]);
        detail::require(50 * c.size[i] >= largest, "crate.size", c.size[i], "at least 1/50 of the largest");
    }
    detail::require(c.board >= 1e-3f * largest && c.board <= 0.1f * least, "crate.board", c.board,
                    "at least 1/1000 of the largest size, at most 1/10 of the least");
    detail::require_range("crate.boards", c.boards, 1, 64, "1 to 64");
    detail::require_range("crate.gap", c.gap, 0.01f, 0.9f, "0.01 to 0.9");
    detail::require_fraction("crate.damage", c.damage);
}

/// 12 triangles for each board and post: 6 boards + 4 of them when nothing is missing.
/// @throws invalid_input as `validate` does
inline mesh to_mesh(const crate& c) {
    validate(c);
    const glm::dvec3 half = glm::dvec3(c.size) * glm::dvec3(0.5, 0.5, 1);
    const double t = static_cast<double>(c.board);
    mesh body;
    random_sequence random(c.seed, 0x62726474);
    const auto stays = [&] { return random.uniform() >= static_cast<double>(c.damage); };
    // The extent of board i of a row that fills [low, high].
    struct extent {
        double low, high;
    };
    const auto part = [&](int i, double low, double high) {
        const double pitch = (high - low) / (c.boards - static_cast<double>(c.gap));
        return extent{low + pitch * i, low + pitch * (i + 1 - static_cast<double>(c.gap))};
    };

    // Boards of the short sides reach half way into those of the long sides; boards of lid and floor, half way into
    // those of the short sides.
    for (int i = 0; i < c.boards; ++i) {
        const auto [low, high] = part(i, 0, half.z);
        const double trim = (std::min)(0.05 * t, 0.1 * (high - low));
        const auto [left, right] = part(i, -half.y + 1.1 * t, half.y - 1.1 * t);
        for (const double side : {-1.0, 1.0}) {
            const double outer = side * half.y, inner = side * (half.y - t);
            if (stays())
                detail::append_box(body, {-half.x, (std::min)(outer, inner), low},
                                   {half.x, (std::max)(outer, inner), high});
            const double face = side * (half.x - 0.05 * t), back = side * (half.x - t);
            if (stays())
                detail::append_box(body, {(std::min)(face, back), -half.y + 0.5 * t, low + trim},
                                   {(std::max)(face, back), half.y - 0.5 * t, high - trim});
        }
        detail::append_box(body, {-half.x + 0.5 * t, left, 0.05 * t}, {half.x - 0.5 * t, right, t});
        if (stays() && !c.is_open)
            detail::append_box(body, {-half.x + 0.5 * t, left, half.z - t},
                               {half.x - 0.5 * t, right, half.z - 0.05 * t});
    }
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0}) {
            const glm::dvec3 a(x * (half.x - 0.5 * t), y * (half.y - 0.6 * t), 0.1 * t);
            const glm::dvec3 b(x * (half.x - 3.5 * t), y * (half.y - 3.5 * t), half.z - 0.5 * t);
            detail::append_box(body, {(std::min)(a.x, b.x), (std::min)(a.y, b.y), a.z},
                               {(std::max)(a.x, b.x), (std::max)(a.y, b.y), b.z});
        }
    return with_creases(body, 0);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
