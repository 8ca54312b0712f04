// The seabed along a track: heights and slopes in square tiles, sampled only where pings need them.
//
// Tiles lie on a lattice of the world, so that a position has the same samples whatever track passes over it.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/seabed/detail/central_difference.hpp>
#include <insonify/sonar/side_scan/side_scan.hpp>

#include <memory>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The seabed at a vertex, or interpolated between vertices.
struct bottom_vertex {
    float height;            ///< metres above the datum; NaN without seabed
    float slope_x, slope_y;  ///< rise per metre, by central differences
    std::uint32_t type;
};

class bottom_tiles {
  public:
    static constexpr int cells = 64;  ///< along a tile's side

    /// @param spacing  metres between vertices, rounded by `rounded_cell`
    bottom_tiles(const seabed::any& source, double spacing)
        : is_empty_(source.empty()),
          prepared_(source.prepare()),
          labels_(source.legend()),
          range_(prepared_.range()),
          spacing_(rounded_cell(spacing)),
          scale_(1 / spacing_) {}

    /// Rounds a length so that its multiples are exact: a vertex has the same coordinates in every row.
    static double rounded_cell(double length) {
        require(length > 1e-9 && length < 1e9, "cell", length, "above 10^-9 and below 10^9 metres");
        return numeric::rounded_to_eight_bits(length);
    }

    /// Samples the seabed below some pings, and discards all other tiles.
    /// @param from, reach  metres across the track from each ping, on its side
    template <executor E>
    void cover(std::span<const ping_frame> pings, double from, double reach, E& ex) {
        if (is_empty_) return;
        const fan_steps steps(from, reach, side());
        lay_out(pings, steps);
        mark(pings, steps);
        const dynamic_array<tile_run> runs = number_marked();
        const std::size_t tiles = runs.empty() ? 0 : std::size_t{runs.back().slot} + runs.back().count;
        require(tiles < max_tiles, "seabed tiles", tiles, "below 2^18 (17 GB); use larger cells");
        vertices_.reset(new bottom_vertex[tiles * tile_size]);
        ex.bulk(runs.size(), [&](std::size_t i) { sample(runs[i]); });
        sampled_ += tiles * tile_size;
    }

    /// The seabed at a world position, which must be covered: bilinear in the cell, with the type of the nearest
    /// vertex.
    bottom_vertex at(double x, double y) const {
        if (is_empty_) return {std::numeric_limits<float>::quiet_NaN(), 0, 0, 0};
        const double u = x * scale_, v = y * scale_;  // as in tile_of: marked tiles are those looked up
        const std::int64_t cell_x = numeric::floor_to_int(u), cell_y = numeric::floor_to_int(v);
        const auto right = static_cast<float>(u - static_cast<double>(cell_x));
        const auto up = static_cast<float>(v - static_cast<double>(cell_y));
        const std::int64_t tile_x = cell_x >> shift, tile_y = cell_y >> shift;
        const std::size_t slot = slots_[slot_of(tile_x, tile_y)];
        INSONIFY_ASSERT(slot != absent);
        const bottom_vertex* const a =
            &vertices_[slot * tile_size + static_cast<std::size_t>(cell_y & (cells - 1)) * stride +
                       static_cast<std::size_t>(cell_x & (cells - 1))];
        const bottom_vertex &b = a[1], &c = a[stride], &d = a[stride + 1];
        const float wa = (1 - right) * (1 - up), wb = right * (1 - up), wc = (1 - right) * up, wd = right * up;
        const bottom_vertex& nearest = up < 0.5f ? (right < 0.5f ? *a : b) : (right < 0.5f ? c : d);
        const bottom_vertex mean{wa * a->height + wb * b.height + wc * c.height + wd * d.height,
                                 wa * a->slope_x + wb * b.slope_x + wc * c.slope_x + wd * d.slope_x,
                                 wa * a->slope_y + wb * b.slope_y + wc * c.slope_y + wd * d.slope_y, nearest.type};
        return mean.height == mean.height ? mean : beside_gap(mean, a, right, up);
    }

    /// Bounds of the seabed's depth along a pitched fan; 0 for level ones, which do not need them.
    struct depth_range {
        double shallowest, deepest;
    };
    /// @throws invalid_input for pitched pings over a seabed that does not state its heights
    depth_range depths(const ping_frame& p) const {
        if (p.is_level() || range_.empty()) return {0, 0};
        seabed::detail::require_finite(range_);
        const seabed::height_range heights = seabed::detail::with_rounding(range_);
        return {(p.position().z - heights.highest) / p.cosine_pitch(),
                (p.position().z - heights.lowest) / p.cosine_pitch()};
    }

    /// Vertices evaluated so far.
    std::uint64_t sampled() const { return sampled_; }

  private:
    static constexpr int shift = 6;
    static constexpr std::size_t stride = cells + 1;  // with the first vertices of the next tile
    static constexpr std::size_t tile_size = stride * stride;
    static constexpr std::size_t max_tiles = 1 << 18;
    static constexpr std::uint32_t absent = 0xFFFFFFFFu;
    static_assert(1 << shift == cells);

    /// Steps of at most half a tile along a ping's fan. The rectangles around them contain every tile that the fan
    /// touches.
    struct fan_steps {
        double from, width;
        int count;

        fan_steps(double first, double reach, double side)
            : from(first), width(reach - first), count(static_cast<int>(numeric::floor_to_int(2 * width / side)) + 1) {}
        double operator[](int i) const { return from + width * i / count; }
    };

    double side() const { return cells * spacing_; }

    std::pair<std::int64_t, std::int64_t> tile_of(const glm::dvec2& p) const {
        require(p.x > -1e9 && p.x < 1e9, "ping.position.x", p.x, "within 1e9 metres, with its swath");
        require(p.y > -1e9 && p.y < 1e9, "ping.position.y", p.y, "within 1e9 metres, with its swath");
        return {numeric::floor_to_int(p.x * scale_) >> shift, numeric::floor_to_int(p.y * scale_) >> shift};
    }

    /// Clears the slots of the rectangle of tiles around all fans.
    void lay_out(std::span<const ping_frame> pings, const fan_steps& steps) {
        std::int64_t last_x = -(std::int64_t{1} << 60), last_y = last_x;
        first_x_ = first_y_ = -last_x;
        for (const ping_frame& p : pings) {
            const auto [shallowest, deepest] = depths(p);
            for (const double x : {steps.from, steps[steps.count + 1]})
                for (const double down : {shallowest, deepest}) {
                    const auto [tile_x, tile_y] = tile_of(p.below(x, down));
                    first_x_ = (std::min)(first_x_, tile_x), first_y_ = (std::min)(first_y_, tile_y);
                    last_x = (std::max)(last_x, tile_x), last_y = (std::max)(last_y, tile_y);
                }
        }
        columns_ = last_x - first_x_ + 1;
        rows_ = last_y - first_y_ + 1;
        const std::int64_t upper_bound = 1 << 26;
        require(columns_ < upper_bound && rows_ < upper_bound && columns_ * rows_ < upper_bound, "seabed tiles",
                static_cast<double>(columns_) * static_cast<double>(rows_), "below 2^26: take larger cells");
        slots_.assign(static_cast<std::size_t>(columns_ * rows_), absent);
    }

    /// Marks the tiles that the fans touch.
    void mark(std::span<const ping_frame> pings, const fan_steps& steps) {
        for (const ping_frame& p : pings) {
            const auto [shallowest, deepest] = depths(p);
            for (int i = 0; i < steps.count; ++i) {
                auto [ax, ay] = tile_of(p.below(steps[i], shallowest));
                std::int64_t bx = ax, by = ay;
                for (const auto& [x, y] :
                     {tile_of(p.below(steps[i + 1], shallowest)), tile_of(p.below(steps[i], deepest)),
                      tile_of(p.below(steps[i + 1], deepest))}) {
                    ax = (std::min)(ax, x), ay = (std::min)(ay, y);
                    bx = (std::max)(bx, x), by = (std::max)(by, y);
                }
                for (std::int64_t y = ay; y <= by; ++y)
                    for (std::int64_t x = ax; x <= bx; ++x) slots_[slot_of(x, y)] = 0;
            }
        }
    }

    std::size_t slot_of(std::int64_t x, std::int64_t y) const {
        return static_cast<std::size_t>((y - first_y_) * columns_ + (x - first_x_));
    }

    /// Adjacent tiles along x, sampled together: long rows cost less per sample.
    struct tile_run {
        std::int64_t x, y;
        std::uint32_t slot, count;
    };
    static constexpr std::uint32_t longest_run = 8;

    /// Numbers the marked tiles.
    /// @returns their runs, in the order of the numbers
    dynamic_array<tile_run> number_marked() {
        dynamic_array<tile_run> runs;
        std::uint32_t next = 0;
        for (std::int64_t y = 0; y < rows_; ++y)
            for (std::int64_t x = 0; x < columns_; ++x) {
                std::uint32_t& slot = slots_[static_cast<std::size_t>(y * columns_ + x)];
                if (slot == absent) continue;
                slot = next++;
                const bool continues = !runs.empty() && runs.back().count < longest_run && x > 0 &&
                                       slots_[static_cast<std::size_t>(y * columns_ + x - 1)] != absent;
                if (continues)
                    ++runs.back().count;
                else
                    runs.push_back({first_x_ + x, first_y_ + y, slot, 1});
            }
        return runs;
    }

    /// Interpolates a cell that has a NaN vertex. Vertices of weight 0 are left out, so that the border of a gap has
    /// heights.
    INSONIFY_RARE static bottom_vertex beside_gap(bottom_vertex mean, const bottom_vertex* corner, float right,
                                                  float up) {
        const auto between = [](float t, float from, float to) {
            return (t < 1 ? (1 - t) * from : 0.0f) + (t > 0 ? t * to : 0.0f);
        };
        mean.height = between(up, between(right, corner[0].height, corner[1].height),
                              between(right, corner[stride].height, corner[stride + 1].height));
        return mean;
    }

    /// Samples a run, with a margin of one vertex for the slopes.
    void sample(const tile_run& run) const {
        const std::size_t width = run.count * cells + 3, height = stride + 2;
        dynamic_array<float> heights(width * height);
        dynamic_array<seabed::type> types(width * height);
        for (std::size_t j = 0; j < height; ++j) {
            const auto vertex = [&](std::int64_t tile, std::size_t i) {
                return static_cast<double>(tile * cells + static_cast<std::int64_t>(i) - 1) * spacing_;
            };
            prepared_.row(
                {.y = vertex(run.y, j), .origin = vertex(run.x, 0), .spacing = spacing_, .grid_spacing = spacing_},
                std::span(heights).subspan(j * width, width), std::span(types).subspan(j * width, width));
        }
        require_stated(heights, types);
        const auto scale = static_cast<float>(0.5 * scale_);
        const auto slope = [&](float before, float at, float after) {
            const float central = scale * (after - before);  // finite, unless beside a gap
            return numeric::is_finite(central) ? central
                                               : scale * seabed::detail::central_difference(before, at, after);
        };
        for (std::size_t tile = 0; tile < run.count; ++tile) {
            bottom_vertex* out = &vertices_[(run.slot + tile) * tile_size];
            for (std::size_t j = 0; j < stride; ++j) {
                const std::size_t start = (j + 1) * width + tile * cells + 1;
                for (std::size_t i = start; i < start + stride; ++i)
                    *out++ = {heights[i], slope(heights[i - 1], heights[i], heights[i + 1]),
                              slope(heights[i - width], heights[i], heights[i + width]),
                              static_cast<std::uint32_t>(types[i])};
            }
        }
    }

    /// @throws invalid_input for heights beyond the seabed's range, and for labels that its legend lacks
    void require_stated(std::span<const float> heights, std::span<const seabed::type> types) const {
        float lowest = std::numeric_limits<float>::infinity(), highest = -lowest;
        for (const float height : heights) {
            if (height < lowest) lowest = height;  // not where it is NaN
            if (height > highest) highest = height;
        }
        seabed::detail::require_within(range_, static_cast<double>(lowest), static_cast<double>(highest));
        labels_.require_all(types);
    }

    bool is_empty_;
    seabed::any_sampler prepared_;
    seabed::detail::known_labels labels_;
    seabed::height_range range_;
    double spacing_, scale_;
    std::int64_t first_x_ = 0, first_y_ = 0, columns_ = 0, rows_ = 0;
    dynamic_array<std::uint32_t> slots_;
    std::unique_ptr<bottom_vertex[]> vertices_;
    std::uint64_t sampled_ = 0;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
