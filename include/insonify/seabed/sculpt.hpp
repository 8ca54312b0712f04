// A seabed worked by hand: raised, lowered, flattened, smoothed, ramped, stamped, scoured, heaped up; in order.
//
// An edit is a function of the position and of the height that earlier edits left there, so what is sculpted stays
// what recipes are: unbounded, and the same wherever it is asked from. Away from an edit not a bit changes.
#pragma once

#include <insonify/seabed/blend.hpp>
#include <insonify/seabed/detailed.hpp>
#include <insonify/seabed/edit.hpp>
#include <insonify/seabed/heightfield.hpp>
#include <insonify/seabed/mixed.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

template <preparable Ground>
class sculpt_sampler;

/// A ground and what is done to it. Types are the ground's.
///
/// `sculpted` holds any of the library's seabeds; spell out the template for recipes of your own.
template <preparable Ground>
struct basic_sculpted {
    Ground ground{};
    std::vector<edit> edits;  ///< the first is done first

    /// The sampler refers to a heightfield that is the ground, and owns everything else.
    /// @throws invalid_input for parameters out of their range
    sculpt_sampler<Ground> prepare() const { return sculpt_sampler<Ground>(*this); }
    float operator()(double x, double y) const { return at(prepare(), x, y).height; }
    type type_at(double x, double y) const { return at(prepare(), x, y).kind; }
};
using sculpted = basic_sculpted<std::variant<flat, ripples, mud, rock, blend, mixed, heightfield, detailed>>;

/// Evaluates `basic_sculpted`.
template <preparable Ground>
class sculpt_sampler {
    using ground_sampler = decltype(seabed::prepare(std::declval<const Ground&>()));

  public:
    explicit sculpt_sampler(const basic_sculpted<Ground>& s) : ground_(seabed::prepare(s.ground)) {
        for (const edit& e : s.edits)
            edits_.push_back({e, std::visit([](const auto& held) { return detail::box_of(held); }, e)});
    }

    void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        fill(edits_.size(), line, heights, types);
    }

    height_range range() const requires(bounded_sampler<ground_sampler>) {
        height_range all = ground_.range();
        for (const bounded_edit& e : edits_)
            all = std::visit([&](const auto& held) { return detail::worked_range(held, all); }, e.done);
        return all;
    }

  private:
    /// The ground after the first `count` edits.
    void fill(std::size_t count, const scanline& line, std::span<float> heights, std::span<type> types) const {
        if (count == 0) return ground_.row(line, heights, types);
        fill(count - 1, line, heights, types);
        const edit& done = edits_[count - 1].done;
        const detail::box& bounds = edits_[count - 1].bounds;
        if (line.y < bounds.low.y || line.y > bounds.high.y || heights.empty()) return;
        // Which samples it reaches.
        std::size_t begin = 0, end = heights.size();
        const auto reached = [&](std::size_t i) { return line.x(i) >= bounds.low.x && line.x(i) <= bounds.high.x; };
        if (line.spacing > 0) {
            const auto first = (bounds.low.x - line.x(0)) / line.spacing - 1;
            if (first > 0) begin = first < static_cast<double>(end) ? static_cast<std::size_t>(first) : end;
            const auto past = (bounds.high.x - line.x(0)) / line.spacing + 2;
            if (past < static_cast<double>(end)) end = past > 0 ? static_cast<std::size_t>(past) : 0;
        }
        while (begin < end && !reached(begin)) ++begin;
        while (begin < end && !reached(end - 1)) --end;
        if (begin >= end) return;

        const std::span<float> part = heights.subspan(begin, end - begin);
        const scanline there = line.from(begin);
        std::visit(
            [&](const auto& e) {
                if constexpr (std::is_same_v<std::remove_cvref_t<decltype(e)>, smooth>) {
                    detail::smooth_row(e, there, part, [&](const scanline& nodes, std::span<float> at_nodes) {
                        fill(count - 1, nodes, at_nodes, {});
                    });
                } else {
                    for (std::size_t i = 0; i < part.size(); ++i)
                        part[i] = detail::worked(e, {there.x(i), there.y}, part[i]);
                }
            },
            done);
    }

    struct bounded_edit {
        edit done;
        detail::box bounds;
    };
    ground_sampler ground_;
    std::vector<bounded_edit> edits_;
};

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
