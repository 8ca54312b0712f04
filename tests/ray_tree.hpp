// Bounding-volume hierarchy over triangles in doubles: visits every triangle that a ray may meet. Used by the shadow
// oracle, and shares nothing with the library.
//
// Built from the top by the surface area heuristic over 16 bins (I. Wald. On fast Construction of SAH-based Bounding
// Volume Hierarchies. 2007). Boxes are padded, so that rounding loses no triangle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace shadow_oracle {

struct triangle {
    glm::dvec3 a, b, c;
};

inline bool is_finite(const triangle& t) {
    for (const glm::dvec3& p : {t.a, t.b, t.c})
        for (int i = 0; i < 3; ++i)
            if (!std::isfinite(p[i])) return false;
    return true;
}

class ray_tree {
  public:
    ray_tree() = default;

    /// @param unit  metres: the size of ordinary coordinates, to which rays' origins are rounded
    ray_tree(std::span<const triangle> triangles, double unit) {
        std::vector<item> items;
        items.reserve(triangles.size());
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            if (!is_finite(triangles[i])) continue;
            item one{box{}, static_cast<std::uint32_t>(i)};
            for (const glm::dvec3& p : {triangles[i].a, triangles[i].b, triangles[i].c}) one.bounds.include(p);
            for (int k = 0; k < 3; ++k) {
                const double size = std::max({std::abs(one.bounds.low[k]), std::abs(one.bounds.high[k]), unit});
                one.bounds.low[k] -= 1e-12 * size;
                one.bounds.high[k] += 1e-12 * size;
            }
            items.push_back(one);
        }
        if (items.empty()) return;
        nodes_.reserve(items.size());
        nodes_.emplace_back();
        build(items);
        ids_.reserve(items.size());
        for (const item& i : items) ids_.push_back(i.id);
    }

    /// Calls visit(id) for the triangles whose boxes the ray from + t along, 0 <= t <= end, meets, until it returns
    /// true.
    template <class Visit>
    void along(const glm::dvec3& from, const glm::dvec3& direction, double end, const Visit& visit) const {
        if (nodes_.empty()) return;
        glm::dvec3 inverse;
        for (int k = 0; k < 3; ++k) {
            const double d = std::abs(direction[k]) < 1e-300 ? 1e-300 : direction[k];
            inverse[k] = 1 / d;
        }
        std::array<std::uint32_t, 128> stack;
        int depth = 0;
        stack[static_cast<std::size_t>(depth++)] = 0;
        while (depth > 0) {
            const node& n = nodes_[stack[static_cast<std::size_t>(--depth)]];
            if (!meets(n.bounds, from, inverse, end)) continue;
            if (n.count == 0) {
                stack[static_cast<std::size_t>(depth++)] = n.first;
                stack[static_cast<std::size_t>(depth++)] = n.first + 1;
                continue;
            }
            for (std::uint32_t i = n.first; i < n.first + n.count; ++i)
                if (visit(ids_[i])) return;
        }
    }

  private:
    struct box {
        glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

        void include(const glm::dvec3& p) { include(box{p, p}); }
        void include(const box& b) {
            for (int k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], b.low[k]);
                high[k] = std::max(high[k], b.high[k]);
            }
        }
        double area() const {
            const glm::dvec3 size = high - low;
            return size.x * size.y + size.y * size.z + size.z * size.x;
        }
        double middle(int axis) const { return 0.5 * low[axis] + 0.5 * high[axis]; }
    };
    struct item {
        box bounds;
        std::uint32_t id;
    };
    /// A leaf's range of ids, or the first of two children if the count is 0.
    struct node {
        box bounds;
        std::uint32_t first = 0, count = 0;
    };
    static constexpr std::size_t leaf = 4;

    static bool meets(const box& b, const glm::dvec3& from, const glm::dvec3& inverse, double end) {
        double first = 0, last = end;
        for (int k = 0; k < 3; ++k) {
            const double low = (b.low[k] - from[k]) * inverse[k], high = (b.high[k] - from[k]) * inverse[k];
            first = std::max(first, std::min(low, high));
            last = std::min(last, std::max(low, high));
        }
        return first <= last * (1 + 1e-14);
    }

    void build(std::vector<item>& items) {
        struct task {
            std::size_t node, first, last, depth;
        };
        std::vector<task> tasks{{0, 0, items.size(), 0}};
        while (!tasks.empty()) {
            const task t = tasks.back();
            tasks.pop_back();
            const std::span<item> some = std::span(items).subspan(t.first, t.last - t.first);
            box all, centres;
            for (const item& i : some) {
                all.include(i.bounds);
                centres.include({i.bounds.middle(0), i.bounds.middle(1), i.bounds.middle(2)});
            }
            nodes_[t.node].bounds = all;
            if (some.size() <= leaf) {
                nodes_[t.node].first = static_cast<std::uint32_t>(t.first);
                nodes_[t.node].count = static_cast<std::uint32_t>(some.size());
                continue;
            }
            // A tree deeper than the stack of a visit allows is cut in halves from there on.
            const std::size_t cut = t.first + (t.depth < 64 ? split(some, centres) : some.size() / 2);
            const std::size_t child = nodes_.size();
            nodes_[t.node].first = static_cast<std::uint32_t>(child);
            nodes_.resize(child + 2);
            tasks.push_back({child, t.first, cut, t.depth + 1});
            tasks.push_back({child + 1, cut, t.last, t.depth + 1});
        }
    }

    /// Reorders the items and returns how many belong to the first child, neither none nor all.
    static std::size_t split(std::span<item> items, const box& centres) {
        constexpr std::size_t bins = 16;
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (centres.high[k] - centres.low[k] > centres.high[axis] - centres.low[axis]) axis = k;
        const double low = centres.low[axis], width = centres.high[axis] - low;
        if (!(width > 0)) return items.size() / 2;
        const auto bin_of = [&](const item& i) {
            const double at = (i.bounds.middle(axis) - low) / width * static_cast<double>(bins);
            return std::min(static_cast<std::size_t>(at), bins - 1);
        };
        struct bin {
            box bounds;
            std::size_t count = 0;
        };
        std::array<bin, bins> all;
        for (const item& i : items) {
            bin& b = all[bin_of(i)];
            b.bounds.include(i.bounds);
            ++b.count;
        }
        std::array<double, bins> cost{};
        const auto sweep = [&](auto bin_at, auto cost_at) {
            box sum;
            std::size_t count = 0;
            for (std::size_t i = 0; i + 1 < bins; ++i) {
                const bin& b = all[bin_at(i)];
                sum.include(b.bounds);
                count += b.count;
                cost[cost_at(i)] += count == 0 ? 0 : sum.area() * static_cast<double>(count);
            }
        };
        sweep([](std::size_t i) { return i; }, [](std::size_t i) { return i; });
        sweep([](std::size_t i) { return bins - 1 - i; }, [](std::size_t i) { return bins - 2 - i; });
        const auto best = std::min_element(cost.begin(), cost.end() - 1) - cost.begin();
        const auto middle = std::partition(items.begin(), items.end(),
                                           [&](const item& i) { return bin_of(i) <= static_cast<std::size_t>(best); });
        const auto count = static_cast<std::size_t>(middle - items.begin());
        return count == 0 || count == items.size() ? items.size() / 2 : count;
    }

    std::vector<node> nodes_;
    std::vector<std::uint32_t> ids_;
};

}  // namespace shadow_oracle
