// Sculpted seabeds: a base and a sequence of edits that raise, flatten, smooth, ramp, stamp, heap or dig
// scour moats.
//
// An edit is a function of the position and of the height after the edits before it, so that a sculpted seabed stays
// unbounded and independent of the grid. Outside an edit's bounds no bit changes.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/seabed/edit.hpp>
#include <insonify/seabed/flat.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

inline namespace INSONIFY_FLAGS {

class sculpt_sampler;

}  // namespace INSONIFY_FLAGS

/// A seabed and a list of edits. Labels are those of the seabed.
struct sculpted {
    any ground = flat{};
    std::vector<edit> edits;  ///< applied in this order

    /// @throws invalid_input for parameters out of their range
    INSONIFY_TAGGED sculpt_sampler prepare() const;
    INSONIFY_MEMBER std::optional<type> only_type() const { return ground.only_type(); }
    INSONIFY_MEMBER std::vector<type_properties> legend() const { return ground.legend(); }
};

inline namespace INSONIFY_FLAGS {

/// Evaluates `sculpted`.
class sculpt_sampler {
  public:
    explicit sculpt_sampler(const sculpted& s) : ground_(s.ground.prepare()) {
        for (const edit& e : s.edits)
            edits_.push_back({e, std::visit([](const auto& held) { return detail::ground_of(held); }, e)});
    }

    void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        fill(edits_.size(), line, heights, types);
    }

    height_range range() const {
        height_range all = ground_.range();
        for (const bounded_edit& e : edits_)
            all = std::visit([&](const auto& held) { return detail::range_after(held, all); }, e.applied);
        return all;
    }

  private:
    /// The ground after the first `count` edits.
    void fill(std::size_t count, const scanline& line, std::span<float> heights, std::span<type> types) const {
        ground_.row(line, heights, types);
        for (std::size_t i = 0; i < count; ++i) apply(i, line, heights);
    }
    void apply(std::size_t number, const scanline& line, std::span<float> heights) const {
        const edit& current = edits_[number].applied;
        const detail::ground_rect& bounds = edits_[number].bounds;
        if (line.y < bounds.lower.y || line.y > bounds.upper.y || heights.empty()) return;
        // The samples within its bounds.
        std::size_t begin = 0, end = heights.size();
        const auto reached = [&](std::size_t i) { return line.x(i) >= bounds.lower.x && line.x(i) <= bounds.upper.x; };
        if (line.spacing > 0) {
            const auto first = (bounds.lower.x - line.x(0)) / line.spacing - 1;
            if (first > 0) begin = first < static_cast<double>(end) ? static_cast<std::size_t>(first) : end;
            const auto past = (bounds.upper.x - line.x(0)) / line.spacing + 2;
            if (past < static_cast<double>(end)) end = past > 0 ? static_cast<std::size_t>(past) : 0;
        }
        while (begin < end && !reached(begin)) ++begin;
        while (begin < end && !reached(end - 1)) --end;
        if (begin >= end) return;

        const std::span<float> part = heights.subspan(begin, end - begin);
        const scanline there = line.from(begin);
        std::visit(
            [&](const auto& e) {
                if constexpr (std::is_same_v<std::remove_cvref_t<decltype(e)>, smooth>)
                    detail::smooth_row(e, there, part, [&](const scanline& nodes, std::span<float> at_nodes) {
                        fill(number, nodes, at_nodes, {});
                    });
                else
                    for (std::size_t i = 0; i < part.size(); ++i)
                        part[i] = detail::height_after(e, {there.x(i), there.y}, part[i]);
            },
            current);
    }

    struct bounded_edit {
        edit applied;
        detail::ground_rect bounds;
    };
    any_sampler ground_;
    detail::dynamic_array<bounded_edit> edits_;
};

}  // namespace INSONIFY_FLAGS

inline sculpt_sampler sculpted::prepare() const {
    return sculpt_sampler(*this);
}

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
