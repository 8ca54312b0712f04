// Boxes over a plane, and which of them lie over a point: a tree with eight branches at every node, all eight of which
// are compared at once.
//
// The boxes are sorted along Morton's curve and taken eight by eight, and the eights eight by eight again: a node's
// place says which its branches are, so there are no links. Sides are measured in mean boxes, because under grazing
// light boxes are long. What is found doesn't depend on the tree: it is every box that the point is in.
//
// Based on: Guy M. Morton. A Computer Oriented Geodetic Data Base and a New Technique in File Sequencing. IBM, 1966.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/core/lanes.hpp>
#include <insonify/core/numeric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::shadow {

/// Floats that aren't above and not below a double, for bounds.
inline float rounded_down(double value) {
    const auto nearest = static_cast<float>(value);
    const float size = nearest < 0 ? -nearest : nearest;
    return nearest - (size * 0x1p-23f + (std::numeric_limits<float>::min)());
}
inline float rounded_up(double value) {
    return -rounded_down(-value);
}

/// A rectangle of (u, v) under something that reaches up to `top`.
struct topped_box {
    float u_low, u_high, v_low, v_high, top;
    std::uint32_t name;  ///< the caller's
};

/// A point of the plane and a height over it, known to within a little.
struct point_range {
    float u_low = 0, u_high = 0, v_low = 0, v_high = 0, above = 0;

    point_range() = default;
    /// @param slack  how far u, v and the height may be off
    point_range(double u, double v, double height, double slack)
        : u_low(rounded_down(u - slack)),
          u_high(rounded_up(u + slack)),
          v_low(rounded_down(v - slack)),
          v_high(rounded_up(v + slack)),
          above(rounded_down(height - slack)) {}
};

/// Boxes sorted such that those over a point are found in a few steps.
class box_tree {
  public:
    static constexpr std::size_t branches = 8;

    box_tree() = default;

    /// @param boxes  finite, below 2^32 of them
    template <executor E>
    box_tree(const std::vector<topped_box>& boxes, E& ex) {
        if (boxes.empty()) return;
        const std::vector<std::uint64_t> order = sorted(boxes, ex);
        names_ = std::make_unique_for_overwrite<std::uint32_t[]>(boxes.size());
        count_ = boxes.size();
        for (std::size_t nodes = up(count_);; nodes = up(nodes)) {
            starts_[levels_++] = nodes_.size();
            nodes_.resize(nodes_.size() + nodes);
            if (nodes == 1) break;
        }
        bulk_ranges(ex, up(count_), 4096, [&](std::size_t first, std::size_t last) {
            for (std::size_t n = first; n < last; ++n)
                for (std::size_t k = 0; k < branches && branches * n + k < count_; ++k) {
                    const topped_box& b = boxes[static_cast<std::uint32_t>(order[branches * n + k])];
                    nodes_[n].set(k, b);
                    names_[branches * n + k] = b.name;
                }
        });
        for (std::size_t level = 1; level < levels_; ++level)
            for (std::size_t n = starts_[level - 1]; n < starts_[level]; ++n) {
                const std::size_t at = n - starts_[level - 1];
                nodes_[starts_[level] + at / branches].set(at % branches, nodes_[n].around());
            }
    }

    bool empty() const { return count_ == 0; }

    /// Asks about every pair of a point and a box that it is in and that reaches above it.
    /// @param points  whose bits are set, of at[0] to at[N - 1]: they should be neighbours, as they go down the tree
    ///                together
    /// @param ask     ask(name, k): whether the box settles it for point k, which is then asked about no more
    /// @returns which points are settled
    template <int N, class Ask>
    INSONIFY_INLINE unsigned find(const point_range* at, unsigned points, const Ask& ask) const {
        if (empty() || points == 0) return 0;
        const point_lanes<N> each(at);
        unsigned open = points;
        point_range all = around(at, open);
        // Seven branches a level can wait, below 2^32 boxes and hence in eleven levels.
        std::array<waiting, 80> stack;
        std::size_t height = 0;
        stack[height++] = {static_cast<std::uint32_t>(levels_ - 1), 0};
        while (height > 0) {
            const waiting now = stack[--height];
            const node& here = nodes_[starts_[now.level] + now.node];
            for (unsigned over = here.template over<N>(all); over != 0; over &= over - 1) {
                const int k = std::countr_zero(over);
                const std::uint32_t branch = static_cast<std::uint32_t>(branches) * now.node + static_cast<unsigned>(k);
                if (now.level > 0) {
                    stack[height++] = {now.level - 1, branch};
                    continue;
                }
                for (unsigned in = each.in(here, k) & open; in != 0; in &= in - 1) {
                    const int point = std::countr_zero(in);
                    if (!ask(names_[branch], point)) continue;
                    open &= ~(1u << point);
                    if (open == 0) return points;
                    all = around(at, open);
                }
            }
        }
        return points & ~open;
    }

  private:
    /// Eight boxes; none where there are fewer.
    struct alignas(32) node {
        float u_low[branches], u_high[branches], v_low[branches], v_high[branches], top[branches];

        node() {
            constexpr float nowhere = std::numeric_limits<float>::infinity();
            for (std::size_t k = 0; k < branches; ++k) {
                u_low[k] = v_low[k] = nowhere;
                u_high[k] = v_high[k] = top[k] = -nowhere;
            }
        }
        void set(std::size_t k, const topped_box& b) {
            u_low[k] = b.u_low;
            u_high[k] = b.u_high;
            v_low[k] = b.v_low;
            v_high[k] = b.v_high;
            top[k] = b.top;
        }
        topped_box around() const {
            topped_box all{u_low[0], u_high[0], v_low[0], v_high[0], top[0], 0};
            for (std::size_t k = 1; k < branches; ++k) {
                all.u_low = (std::min)(all.u_low, u_low[k]);
                all.u_high = (std::max)(all.u_high, u_high[k]);
                all.v_low = (std::min)(all.v_low, v_low[k]);
                all.v_high = (std::max)(all.v_high, v_high[k]);
                all.top = (std::max)(all.top, top[k]);
            }
            return all;
        }
        /// Bit k: branch k may hold one of the points within and reach above it.
        template <int N>
        INSONIFY_INLINE unsigned over(const point_range& at) const {
            using namespace insonify::detail;
            using floats = lanes<float, N>;
            using ints = lanes<std::int32_t, N>;
            unsigned bits = 0;
            for (int first = 0; first < static_cast<int>(branches); first += N) {
                floats a, b, c, d, e;
                load(a, u_low + first);
                load(b, u_high + first);
                load(c, v_low + first);
                load(d, v_high + first);
                load(e, top + first);
                const ints held = ints(a <= at.u_high) & ints(b >= at.u_low) & ints(c <= at.v_high) &
                                  ints(d >= at.v_low) & ints(e > at.above);
                bits |= set_lanes<N>(held) << first;
            }
            return bits;
        }
    };
    /// The points as lanes, to compare all with one box.
    template <int N>
    struct point_lanes {
        insonify::detail::lanes<float, N> u_low, u_high, v_low, v_high, above;

        INSONIFY_INLINE explicit point_lanes(const point_range* at) {
            using insonify::detail::gather;
            gather<N>(u_low, [&](int k) { return at[k].u_low; });
            gather<N>(u_high, [&](int k) { return at[k].u_high; });
            gather<N>(v_low, [&](int k) { return at[k].v_low; });
            gather<N>(v_high, [&](int k) { return at[k].v_high; });
            gather<N>(above, [&](int k) { return at[k].above; });
        }
        /// Bit k: point k is in box `b` of a node and below its top.
        INSONIFY_INLINE unsigned in(const node& n, int b) const {
            using ints = insonify::detail::lanes<std::int32_t, N>;
            return insonify::detail::set_lanes<N>(ints(n.u_low[b] <= u_high) & ints(n.u_high[b] >= u_low) &
                                                  ints(n.v_low[b] <= v_high) & ints(n.v_high[b] >= v_low) &
                                                  ints(n.top[b] > above));
        }
    };
    /// The range that holds several points.
    static point_range around(const point_range* at, unsigned points) {
        point_range all = at[std::countr_zero(points)];
        for (points &= points - 1; points != 0; points &= points - 1) {
            const point_range& p = at[std::countr_zero(points)];
            all.u_low = (std::min)(all.u_low, p.u_low);
            all.u_high = (std::max)(all.u_high, p.u_high);
            all.v_low = (std::min)(all.v_low, p.v_low);
            all.v_high = (std::max)(all.v_high, p.v_high);
            all.above = (std::min)(all.above, p.above);
        }
        return all;
    }

    struct waiting {
        std::uint32_t level, node;
    };

    static std::size_t up(std::size_t count) { return (count + branches - 1) / branches; }

    /// Sixteen bits, each followed by a zero.
    static std::uint32_t spread(std::uint32_t v) {
        v = (v | v << 8) & 0x00FF00FFu;
        v = (v | v << 4) & 0x0F0F0F0Fu;
        v = (v | v << 2) & 0x33333333u;
        return (v | v << 1) & 0x55555555u;
    }

    /// Place on Morton's curve in the upper half, index in the lower, sorted.
    template <executor E>
    static std::vector<std::uint64_t> sorted(const std::vector<topped_box>& boxes, E& ex) {
        constexpr std::size_t grain = 65536;
        struct summary {
            double u = std::numeric_limits<double>::infinity(), v = u;  // lowest centres, doubled
            double u_end = -u, v_end = -u;                              // highest
            double width = 0, length = 0;                               // summed
        };
        const auto centre = [](float low, float high) { return static_cast<double>(low) + static_cast<double>(high); };
        const auto side = [](float low, float high) { return static_cast<double>(high) - static_cast<double>(low); };
        std::vector<summary> parts((boxes.size() + grain - 1) / grain);
        bulk_ranges(ex, boxes.size(), grain, [&](std::size_t first, std::size_t last) {
            summary s;
            for (std::size_t i = first; i < last; ++i) {
                const topped_box& b = boxes[i];
                const double u = centre(b.u_low, b.u_high), v = centre(b.v_low, b.v_high);
                s.u = (std::min)(s.u, u);
                s.v = (std::min)(s.v, v);
                s.u_end = (std::max)(s.u_end, u);
                s.v_end = (std::max)(s.v_end, v);
                s.width += side(b.u_low, b.u_high);
                s.length += side(b.v_low, b.v_high);
            }
            parts[first / grain] = s;
        });
        summary all;
        for (const summary& s : parts) {
            all = {(std::min)(all.u, s.u),         (std::min)(all.v, s.v), (std::max)(all.u_end, s.u_end),
                   (std::max)(all.v_end, s.v_end), all.width + s.width,    all.length + s.length};
        }
        // As many steps of the curve to a mean box along u as along v, and 2^16 to the longer way.
        const double u_boxes = (all.u_end - all.u) / all.width, v_boxes = (all.v_end - all.v) / all.length;
        const double steps = 65535 / (std::max)((std::max)(u_boxes, v_boxes), 1e-300);
        const double u_scale = steps / all.width, v_scale = steps / all.length;

        std::vector<std::uint64_t> keys(boxes.size()), other(boxes.size());
        bulk_ranges(ex, boxes.size(), grain, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const topped_box& b = boxes[i];
                // In this order, because boxes that all have one centre make a NaN, which is not less than anything.
                const auto step = [](double s) { return static_cast<std::uint32_t>((std::min)(65535.0, s)); };
                const std::uint32_t u = step((centre(b.u_low, b.u_high) - all.u) * u_scale);
                const std::uint32_t v = step((centre(b.v_low, b.v_high) - all.v) * v_scale);
                keys[i] = std::uint64_t{spread(u) | spread(v) << 1} << 32 | i;
            }
        });
        for (const int shift : {32, 43, 54}) {
            pass(keys, other, shift, ex);
            keys.swap(other);
        }
        return keys;
    }

    /// A stable counting sort by eleven bits: each run of keys counts its own, and knows from the others' counts where
    /// its first of every kind goes.
    template <executor E>
    static void pass(const std::vector<std::uint64_t>& from, std::vector<std::uint64_t>& to, int shift, E& ex) {
        constexpr std::size_t grain = 131072, kinds = 2048;
        const auto kind = [shift](std::uint64_t key) { return static_cast<std::size_t>(key >> shift) % kinds; };
        std::vector<std::array<std::uint32_t, kinds>> next((from.size() + grain - 1) / grain);
        bulk_ranges(ex, from.size(), grain, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) ++next[first / grain][kind(from[i])];
        });
        std::uint32_t sum = 0;
        for (std::size_t k = 0; k < kinds; ++k)
            for (auto& run : next) sum += std::exchange(run[k], sum);
        bulk_ranges(ex, from.size(), grain, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) to[next[first / grain][kind(from[i])]++] = from[i];
        });
    }

    std::size_t count_ = 0, levels_ = 0;
    std::array<std::size_t, 12> starts_{};  ///< of the levels in nodes_, boxes' own first
    std::vector<node> nodes_;
    std::unique_ptr<std::uint32_t[]> names_;
};

}  // namespace insonify::inline INSONIFY_ABI::shadow

INSONIFY_ARITHMETIC_END
