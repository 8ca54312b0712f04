// The pixel loop: one tile, its triangles in order, coverage and depth several pixels at a time.
//
// A tile resolves visibility in buffers of its own that stay in the first-level cache; who won is known before anything
// is shaded, and shading happens once per pixel.
#pragma once

#include <insonify/core/dispatch.hpp>
#include <insonify/core/image_view.hpp>
#include <insonify/core/lanes.hpp>
#include <insonify/raster/binning.hpp>
#include <insonify/raster/depth.hpp>
#include <insonify/raster/small_depth.hpp>

#include <algorithm>
#include <limits>
#include <memory>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // wide vectors stay inside always-inlined code
#endif

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::detail {

/// A triangle of any size, ready for the pixels of a box: its corners run clockwise on the screen, edges are named by
/// their ends.
struct triangle_setup {
    edge_function bc, ca, ab;
    depth_plane depth;
    pixel_box box;
    bool narrow;  ///< the edge functions fit 32 bits all over the box

    /// The corners must not lie on one line. What `box` leaves out may be covered nevertheless.
    static triangle_setup of(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c,
                             const pixel_grid& grid, const pixel_box& box, int slack) {
        const bool compact = grid.is_compact(a) && grid.is_compact(b) && grid.is_compact(c);
        const double area =
            compact ? static_cast<double>(compact_area(a, b, c)) : double_double::from(wide_area(a, b, c)).high;
        triangle_setup t{edge_function::through(b, c, grid, box.x0, box.y0, compact),
                         edge_function::through(c, a, grid, box.x0, box.y0, compact),
                         edge_function::through(a, b, grid, box.x0, box.y0, compact),
                         depth_plane::through(a, b, c, area, grid),
                         box,
                         true};
        if (t.is_narrow(slack)) return t;
        const int width = box.width() + slack, height = box.height();
        t.bc = t.bc.simplified(width, height);
        t.ca = t.ca.simplified(width, height);
        t.ab = t.ab.simplified(width, height);
        t.narrow = t.is_narrow(slack);
        return t;
    }

    /// All pixels of the box are covered, and none to its right.
    void cover_box() {
        bc = ca = {0, 0, 0};
        ab = {box.width() - 1, -1, 0};
        narrow = true;
    }

  private:
    bool is_narrow(int slack) const {
        const int width = box.width() + slack, height = box.height();
        return bc.is_narrow(width, height) && ca.is_narrow(width, height) && ab.is_narrow(width, height);
    }
};

/// Depth of a tile's pixels and, where Winners, the name of the triangle that each shows.
template <bool Winners>
class tile_buffer {
  public:
    static constexpr std::uint32_t nobody = 0xFFFFFFFFu;
    static constexpr int slack = 16;  // whole vectors may reach past the end of a row

    explicit tile_buffer(int size)
        : stride_(size + slack),
          count_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(size)),
          depth_(std::make_unique_for_overwrite<float[]>(count_)),
          winner_(Winners ? std::make_unique_for_overwrite<std::uint32_t[]>(count_) : nullptr) {}

    /// Puts the tile where its first pixel is (x, y) of the image.
    void restart(int x, int y) {
        x_ = x;
        y_ = y;
    }

    template <int N>
    INSONIFY_INLINE void clear() {
        const lanes<float, N> farthest = lanes<float, N>{} + std::numeric_limits<float>::infinity();
        const lanes<std::uint32_t, N> none = lanes<std::uint32_t, N>{} + nobody;
        for (std::size_t i = 0; i < count_; i += N) {
            store(depth_.get() + i, farthest);
            if constexpr (Winners) store(winner_.get() + i, none);
        }
    }

    std::ptrdiff_t stride() const { return stride_; }
    float* depth(int x, int y) { return depth_.get() + index(x, y); }
    std::uint32_t* winner(int x, int y) { return Winners ? winner_.get() + index(x, y) : nullptr; }

  private:
    std::ptrdiff_t index(int x, int y) const { return static_cast<std::ptrdiff_t>(y - y_) * stride_ + (x - x_); }

    int stride_;
    int x_ = 0, y_ = 0;
    std::size_t count_;
    std::unique_ptr<float[]> depth_;
    std::unique_ptr<std::uint32_t[]> winner_;
};

/// Keeps the nearer of what is there and what comes; a tie stays with whoever came first. `winner` may be null if
/// nobody's name is kept.
template <int N, bool Winners>
INSONIFY_INLINE void keep_nearer(float* depth, std::uint32_t* winner, const lanes<std::int32_t, N>& covered,
                                 const lanes<float, N>& z, const lanes<std::uint32_t, N>& name) {
    using floats = lanes<float, N>;
    using names = lanes<std::uint32_t, N>;
    floats old;
    load(old, depth);
    const lanes<std::int32_t, N> visible = covered & lanes<std::int32_t, N>(z < old);
    store(depth, floats(visible ? z : old));
    if constexpr (Winners) {
        names before;
        load(before, winner);
        store(winner, names(visible ? name : before));
    }
}

/// Draws one triangle of any size into a tile, N pixels of a row at a time. Depths that a double can't round with
/// certainty are asked of `nearest(x, y)`, if Exact.
template <int N, class Int, bool Winners, bool Exact, class Nearest>
INSONIFY_INLINE void fill(const triangle_setup& t, tile_buffer<Winners>& tile, std::uint32_t name,
                          const Nearest& nearest) {
    using ints = lanes<Int, N>;
    using floats = lanes<float, N>;
    using doubles = lanes<double, N>;
    using masks = lanes<std::int32_t, N>;
    using names = lanes<std::uint32_t, N>;
    ints column;
    doubles column_x;
    count_up<Int, N>(column);
    count_up<double, N>(column_x);
    const floats lowest = floats{} + t.depth.lowest, highest = floats{} + t.depth.highest;
    const doubles error = doubles{} + t.depth.error;
    const names drawn = names{} + name;

    // Lanes hold N neighbouring pixels of a row.
    ints row_bc = static_cast<Int>(t.bc.origin) + column * static_cast<Int>(t.bc.dx);
    ints row_ca = static_cast<Int>(t.ca.origin) + column * static_cast<Int>(t.ca.dx);
    ints row_ab = static_cast<Int>(t.ab.origin) + column * static_cast<Int>(t.ab.dx);

    for (int y = t.box.y0; y <= t.box.y1; ++y) {
        const double row_z = t.depth.row(y);
        ints bc = row_bc, ca = row_ca, ab = row_ab;
        for (int x = t.box.x0; x <= t.box.x1; x += N) {
            masks covered;
            convert(covered, ints((bc | ca | ab) >= 0));
            const doubles plane = row_z + t.depth.dx * (column_x + (static_cast<double>(x) - t.depth.x));
            floats z;
            convert(z, plane);
            if constexpr (Exact) {
                floats below, above;
                convert(below, doubles(plane - error));
                convert(above, doubles(plane + error));
                const masks doubtful = covered & masks(below != above);
                if (any(doubtful))
                    for (int i = 0; i < N; ++i)
                        if (lane(doubtful, i) != 0) set_lane(z, i, nearest(x + i, y));
            }
            z = z > lowest ? z : lowest;
            z = z < highest ? z : highest;
            keep_nearer<N, Winners>(tile.depth(x, y), tile.winner(x, y), covered, z, drawn);
            bc += static_cast<Int>(N * t.bc.dx);
            ca += static_cast<Int>(N * t.ca.dx);
            ab += static_cast<Int>(N * t.ab.dx);
        }
        row_bc += static_cast<Int>(t.bc.dy);
        row_ca += static_cast<Int>(t.ca.dy);
        row_ab += static_cast<Int>(t.ab.dy);
    }
}

/// The same for triangle k of N small ones, whose rows are rarely longer than N pixels.
template <int N, class Real, bool Winners, class Nearest>
INSONIFY_INLINE void fill_small(const small_setup<N>& t, const small_planes<N, Real>& planes, int k, int unit,
                                tile_buffer<Winners>& tile, std::uint32_t name, const Nearest& nearest) {
    using ints = lanes<std::int32_t, N>;
    using floats = lanes<float, N>;
    using reals = lanes<Real, N>;
    ints column;
    count_up<std::int32_t, N>(column);
    const lanes<std::uint32_t, N> drawn = lanes<std::uint32_t, N>{} + name;
    const floats lowest = floats{} + planes.lowest[k], highest = floats{} + planes.highest[k];
    for (int x = t.x0[k]; x <= t.x1[k]; x += N) {
        const ints at = column + (x - t.x0[k]);
        ints bc = t.bc.origin[k] + at * t.bc.dx[k];
        ints ca = t.ca.origin[k] + at * t.ca.dx[k];
        ints ab = t.ab.origin[k] + at * t.ab.dx[k];
        reals right;
        convert(right, ints(at * unit + t.right[k]));
        const reals rise = right * planes.dx[k];
        int down = t.down[k];
        float* depth = tile.depth(x, t.y0[k]);
        std::uint32_t* winner = tile.winner(x, t.y0[k]);
        const std::ptrdiff_t stride = tile.stride();
        for (int y = t.y0[k]; y <= t.y1[k]; ++y, down += unit) {
            const ints covered = ints((bc | ca | ab) >= 0);
            const reals plane = rise + (planes.z[k] + planes.dy[k] * static_cast<Real>(down));
            floats z;
            if constexpr (small_planes<N, Real>::exact) {
                floats above;
                convert(z, reals(plane - planes.error[k]));
                convert(above, reals(plane + planes.error[k]));
                const ints doubtful = covered & ints(z != above);
                if (any(doubtful))
                    for (int i = 0; i < N; ++i)
                        if (lane(doubtful, i) != 0) set_lane(z, i, nearest(x + i, y));
            } else {
                z = plane;
            }
            z = z > lowest ? z : lowest;
            z = z < highest ? z : highest;
            keep_nearer<N, Winners>(depth, winner, covered, z, drawn);
            depth += stride;
            if constexpr (Winners) winner += stride;
            bc += t.bc.dy[k];
            ca += t.ca.dy[k];
            ab += t.ab.dy[k];
        }
    }
}

/// All triangles of one tile, between reading and writing the image. `Triangles` has the runs of the tile, and for a
/// name its corners' places, its set-up and its nearest depth.
template <class Triangles, bool Winners, class Real>
struct tile_kernel {
    static constexpr bool exact = std::is_same_v<Real, double>;
    const Triangles& triangles;
    tile_buffer<Winners>& tile;
    image_view<float> image;
    pixel_box box;
    float sign;  ///< a smaller internal depth wins
    bool load_image;

    template <int Width>
    INSONIFY_INLINE void run() const {
        // As many as fit a vector of depths.
        constexpr int N = exact && Width > 1 ? Width / 2 : Width;
        tile.restart(box.x0, box.y0);
        tile.template clear<Width>();
        if (load_image) copy<N>([&](int x, int y) { return std::pair(tile.depth(x, y), &image(x, y)); });
        for (const triangle_run& run : triangles.runs()) {
            if (run.is_small)
                for (std::size_t i = 0; i < run.names.size(); i += N)
                    draw_small<N>(run.names.data() + i, (std::min)(static_cast<int>(run.names.size() - i), N));
            else
                for (const std::uint32_t name : run.names) draw_one<N>(name);
        }
        copy<N>([&](int x, int y) { return std::pair(&image(x, y), tile.depth(x, y)); });
    }

  private:
    /// Between tile and image; `ends(x, y)` are where to and where from.
    template <int N, class Ends>
    INSONIFY_INLINE void copy(const Ends& ends) const {
        using floats = lanes<float, N>;
        for (int y = box.y0; y <= box.y1; ++y) {
            int x = box.x0;
            for (; x + N - 1 <= box.x1; x += N) {
                const auto [to, from] = ends(x, y);
                floats z;
                load(z, from);
                store(to, floats(z * sign));
            }
            for (; x <= box.x1; ++x) {
                const auto [to, from] = ends(x, y);
                *to = *from * sign;
            }
        }
    }

    template <int N>
    INSONIFY_INLINE void draw_one(std::uint32_t name) const {
        const triangle_setup t = triangles.setup(name);
        const auto nearest = [&](int x, int y) { return triangles.nearest_depth(name, x, y); };
        if (t.narrow)
            fill<N, std::int32_t, Winners, exact>(t, tile, name, nearest);
        else
            fill<N, std::int64_t, Winners, exact>(t, tile, name, nearest);
    }

    template <int N>
    INSONIFY_INLINE void draw_small(const std::uint32_t* names, int count) const {
        using reals = lanes<Real, N>;
        const auto name = [&](int k) { return names[k < count ? k : 0]; };
        corner_lanes<N> at([&](int k, int corner) -> const grid_place& { return triangles.place(name(k), corner); });
        reals az, bz, cz;
        gather<N>(az, [&](int k) { return triangles.depth(name(k), 0); });
        gather<N>(bz, [&](int k) { return triangles.depth(name(k), 1); });
        gather<N>(cz, [&](int k) { return triangles.depth(name(k), 2); });
        // Corners in clockwise order: b and c are exchanged where the front is seen.
        lanes<std::int32_t, N> area, front;
        at.area(area);
        front = area < 0;
        area = front ? 0 - area : area;
        exchange(front, at.bx, at.cx);
        exchange(front, at.by, at.cy);
        lanes<std::conditional_t<exact, std::int64_t, std::int32_t>, N> real_front;
        convert(real_front, front);
        exchange(real_front, bz, cz);
        const small_setup<N> t(at, triangles.grid(), box);
        const small_planes<N, Real> planes(at, area, az, bz, cz);
        const auto unit = static_cast<int>(triangles.grid().unit());
        for (int k = 0; k < count; ++k) triangles.prefetch(names[k]);
        for (int k = 0; k < count; ++k)
            fill_small<N>(t, planes, k, unit, tile, names[k],
                          [&](int x, int y) { return triangles.nearest_depth(names[k], x, y); });
    }

    template <class Mask, class Lanes>
    INSONIFY_INLINE static void exchange(const Mask& where, Lanes& a, Lanes& b) {
        const Lanes old = a;
        a = where ? b : a;
        b = where ? old : b;
    }
};

}  // namespace insonify::inline INSONIFY_ABI::detail

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

INSONIFY_ARITHMETIC_END
