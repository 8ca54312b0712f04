// Meshes as users bring them, made by code: open, closed, non-manifold, self-intersecting, inside out, degenerate, in
// any order. None is a primitive of the library. All fit a circle of about 1 m around the origin; z is up.
#pragma once

#include <insonify/all.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace shadow_meshes {

namespace in = insonify;

/// A sheet over the unit square: columns x rows cells of two triangles each, whose corners are at(u, v).
template <class At>
in::mesh sheet(int columns, int rows, const At& at) {
    in::mesh m;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i)
            m.positions.emplace_back(at(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
    const auto stride = static_cast<std::uint32_t>(columns + 1);
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j)
        for (std::uint32_t i = 0; i + 1 < stride; ++i) {
            const std::uint32_t a = j * stride + i, b = a + 1, c = a + stride, d = c + 1;
            m.triangles.emplace_back(a, b, d);
            m.triangles.emplace_back(a, d, c);
        }
    return m;
}

/// Merges equal positions and leaves out the triangles that this collapses.
inline in::mesh welded(const in::mesh& m) {
    std::map<std::tuple<float, float, float>, std::uint32_t> known;
    in::mesh out;
    std::vector<std::uint32_t> index;
    for (const glm::vec3& p : m.positions) {
        const auto [found, is_new] = known.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(known.size()));
        if (is_new) out.positions.push_back(p);
        index.push_back(found->second);
    }
    for (const glm::uvec3& t : m.triangles) {
        const glm::uvec3 corners(index[t.x], index[t.y], index[t.z]);
        if (corners.x != corners.y && corners.y != corners.z && corners.z != corners.x)
            out.triangles.push_back(corners);
    }
    return out;
}

inline in::mesh joined(in::mesh a, const in::mesh& b) {
    const auto offset = static_cast<std::uint32_t>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const glm::uvec3& t : b.triangles) a.triangles.push_back(t + offset);
    return a;
}

inline in::mesh turned_around(in::mesh m) {
    for (glm::uvec3& t : m.triangles) std::swap(t.y, t.z);
    return m;
}

/// (cosine, sine) of an angle in turns; the same bits at both ends of a whole turn.
inline glm::dvec2 on_circle(double turns) {
    const auto [sine, cosine] = in::numeric::sin_cos_turns(turns >= 1 ? turns - 1 : turns);
    return {cosine, sine};
}

/// A closed surface around the origin, at radius(direction) from it; 2 columns (rows - 1) triangles.
template <class Radius>
in::mesh blob(int columns, int rows, const Radius& radius) {
    return welded(sheet(columns, rows, [&](double u, double v) {
        const glm::dvec2 around = on_circle(u), up = on_circle(0.5 * v);
        const double level = v >= 1 ? 0 : up.y;
        const glm::dvec3 direction(level * around.x, level * around.y, v >= 1 ? 1 : -up.x);
        return glm::dvec3(radius(direction) * direction);
    }));
}

/// Smooth bumps between -1 and 1, as many as `frequency` radians per metre make.
inline double bumps(const glm::dvec3& p, double frequency) {
    const auto wave = [&](double x) { return in::numeric::sin_cos(frequency * x).sine; };
    return wave(p.x + 0.31 * p.y) * wave(1.13 * p.y - 0.57 * p.z) * wave(0.93 * p.z + 0.41 * p.x);
}

inline in::mesh tilted_quad(int cells = 1) {
    const auto [sine, cosine] = in::numeric::sin_cos(in::numeric::to_radians(30));
    return sheet(cells, cells, [&, s = sine, c = cosine](double u, double v) {
        return glm::dvec3((1.6 * u - 0.8) * c, 1.6 * v - 0.8, (1.6 * u - 0.8) * s + 0.5);
    });
}

/// Half of a hollow ball, open to above.
inline in::mesh bowl(int cells = 40) {
    return welded(sheet(2 * cells, cells, [](double u, double v) {
        const glm::dvec2 around = on_circle(u), up = on_circle(0.23 * v);
        return glm::dvec3(up.y * around.x, up.y * around.y, 1 - up.x);
    }));
}

/// A sheet that is rolled up one and a half times and overhangs itself.
inline in::mesh scroll() {
    return sheet(60, 20, [](double u, double v) {
        const glm::dvec2 around = on_circle(u * 1.5 >= 1 ? u * 1.5 - 1 : u * 1.5);
        const double radius = 0.3 + 0.4 * u;
        return glm::dvec3(radius * around.x, 1.6 * v - 0.8, 0.7 + radius * around.y);
    });
}

inline in::mesh moebius_strip() {
    return welded(sheet(120, 8, [](double u, double v) {
        const glm::dvec2 around = on_circle(u), twist = on_circle(0.5 * u);
        const double across = (v - 0.5) * 0.7, half = u >= 1 ? -1 : twist.x, rise = u >= 1 ? 0 : twist.y;
        const double radius = 0.8 + across * half;
        return glm::dvec3(radius * around.x, radius * around.y, 0.5 + across * rise);
    }));
}

inline in::mesh torus(double radius, double tube, int cells, const glm::dvec3& centre, bool upright) {
    return welded(sheet(2 * cells, cells, [&](double u, double v) {
        const glm::dvec2 around = on_circle(u), about = on_circle(v);
        const double out = radius + tube * about.x;
        const glm::dvec3 p(out * around.x, out * around.y, tube * about.y);
        return centre + (upright ? glm::dvec3(p.x, -p.z, p.y) : p);
    }));
}
inline in::mesh crossed_tori() {
    return joined(torus(0.6, 0.2, 32, {-0.2, 0, 0.5}, false), torus(0.55, 0.2, 32, {0.2, 0.1, 0.7}, true));
}
/// A torus whose hole is one point, in which it touches itself.
inline in::mesh horn_torus() {
    return torus(0.4, 0.4, 36, {0, 0, 0.4}, false);
}

/// A closed surface like an hourglass that lies down, of which one half is inside out: its profile crosses the axis.
inline in::mesh inverted_lobe() {
    return welded(sheet(64, 48, [](double u, double v) {
        const glm::dvec2 around = on_circle(u);
        const bool is_tip = v <= 0 || v >= 1 || v == 0.5;
        const double radius = is_tip ? 0 : 0.5 * on_circle(v).y;
        return glm::dvec3(1.8 * v - 0.9, radius * around.x, 0.5 + radius * around.y);
    }));
}

inline in::mesh inside_out_ball() {
    return turned_around(blob(48, 32, [](const glm::dvec3&) { return 0.6; }));
}

/// Every triangle with corners of its own, in any order.
inline in::mesh soup(const in::mesh& m, std::uint64_t seed = 5) {
    in::random_sequence random(seed);
    in::mesh out;
    std::vector<glm::uvec3> triangles = m.triangles;
    for (std::size_t i = triangles.size(); i > 1; --i)
        std::swap(triangles[i - 1], triangles[random.below(static_cast<std::uint32_t>(i))]);
    for (const glm::uvec3& t : triangles) {
        const auto first = static_cast<std::uint32_t>(out.positions.size());
        for (const std::uint32_t corner : {t.x, t.y, t.z}) out.positions.push_back(m.positions[corner]);
        out.triangles.emplace_back(first, first + 1, first + 2);
    }
    return out;
}

/// The same triangles in any order.
inline in::mesh shuffled(in::mesh m, std::uint64_t seed = 6) {
    in::random_sequence random(seed);
    for (std::size_t i = m.triangles.size(); i > 1; --i)
        std::swap(m.triangles[i - 1], m.triangles[random.below(static_cast<std::uint32_t>(i))]);
    return m;
}

/// A sheet with upright fins along the edges of its cells: three and four triangles share an edge.
inline in::mesh fins() {
    constexpr int cells = 10;
    const auto at = [](double u, double v) {
        const glm::dvec3 p(1.8 * u - 0.9, 1.8 * v - 0.9, 0);
        return p + glm::dvec3(0, 0, 0.2 + 0.1 * bumps(p, 4));
    };
    in::mesh m = sheet(cells, cells, at);
    const auto bottom = static_cast<std::uint32_t>(m.positions.size());
    for (std::uint32_t i = 0; i < bottom; ++i) m.positions.push_back(m.positions[i] + glm::vec3(0.01f, 0.02f, 0.09f));
    const auto fin = [&](std::uint32_t a, std::uint32_t b) {
        m.triangles.emplace_back(a, b, b + bottom);
        m.triangles.emplace_back(a, b + bottom, a + bottom);
    };
    constexpr std::uint32_t stride = cells + 1;
    for (std::uint32_t j = 0; j < stride; j += 2)
        for (std::uint32_t i = 0; i + 1 < stride; ++i) {
            fin(j * stride + i, j * stride + i + 1);
            if (i % 3 == 0) fin(i * stride + j, (i + 1) * stride + j);
        }
    return m;
}

/// A rough standing figure: 2 columns (rows - 1) triangles, each far smaller than a pixel of most pictures.
inline in::mesh statue(int columns = 240, int rows = 152) {
    return blob(columns, rows, [](const glm::dvec3& d) {
        return 0.62 + 0.2 * bumps(d, 3.1) + 0.05 * bumps(d, 11) + 0.012 * bumps(d, 43);
    });
}

/// A body on four legs, with a head; 5.8 thousand triangles.
inline in::mesh cow() {
    const glm::dvec3 limbs[] = {
        {0.5, 0.25, -0.75}, {0.5, -0.25, -0.75}, {-0.5, 0.25, -0.75}, {-0.5, -0.25, -0.75}, {0.9, 0, 0.4}};
    return blob(54, 55, [&](const glm::dvec3& d) {
        double radius = 0.42 + 0.16 * d.x * d.x + 0.02 * bumps(d, 15);
        for (const glm::dvec3& limb : limbs) {
            const double length = in::numeric::square_root(in::numeric::dot(limb, limb));
            const double off = 1 - in::numeric::dot(limb, d) / length;
            radius += 0.45 * in::numeric::exp(-40 * off);
        }
        return radius;
    });
}

/// A rough bottom of 5 m a side, as a regular grid; heights are exact multiples of 2^-16 m.
inline in::mesh relief(int cells = 96) {
    return sheet(cells, cells, [](double u, double v) {
        const glm::dvec3 p(5 * u - 2.5, 5 * v - 2.5, 0.3);
        const double height = 0.1 * bumps(p, 2.3) + 0.06 * bumps(p, 7) + 0.02 * bumps(p, 29);
        return glm::dvec3(p.x, p.y, static_cast<double>(in::numeric::floor_to_int(height * 65536)) / 65536);
    });
}

/// Missing heights: NaN vertices.
inline in::mesh with_nodata(in::mesh m) {
    const auto side = static_cast<std::size_t>(in::numeric::square_root(static_cast<double>(m.positions.size())) + 0.5);
    for (std::size_t i = 0; i < m.positions.size(); ++i) {
        const std::size_t x = i % side, y = i / side;
        if ((x / 7 + y / 5) % 6 == 0 && x % 7 < 4) m.positions[i].z = std::numeric_limits<float>::quiet_NaN();
    }
    return m;
}

/// The same, with the triangles left out instead.
inline in::mesh with_holes(in::mesh m) {
    std::size_t i = 0;
    std::erase_if(m.triangles, [&](const glm::uvec3&) { return i++ / 23 % 9 == 0; });
    return m;
}

/// The triangles of a sheet of `cells` columns along a Morton curve, and vertices numbered as they come: as an
/// optimizer for vertex caches leaves them.
inline in::mesh in_cache_order(const in::mesh& m, int cells) {
    std::vector<std::pair<std::uint64_t, std::size_t>> keys;
    for (std::size_t i = 0; i < m.triangles.size(); ++i) {
        const std::uint64_t cell = i / 2, x = cell % static_cast<unsigned>(cells),
                            y = cell / static_cast<unsigned>(cells);
        std::uint64_t key = 0;
        for (unsigned bit = 0; bit < 16; ++bit) key |= (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1);
        keys.emplace_back(key, i);
    }
    std::sort(keys.begin(), keys.end());
    in::mesh out;
    std::vector<std::uint32_t> place(m.positions.size(), 0xFFFFFFFFu);
    for (const auto& [key, i] : keys) {
        glm::uvec3 t(0);
        for (int k = 0; k < 3; ++k) {
            std::uint32_t& at = place[m.triangles[i][k]];
            if (at == 0xFFFFFFFFu) {
                at = static_cast<std::uint32_t>(out.positions.size());
                out.positions.push_back(m.positions[m.triangles[i][k]]);
            }
            t[k] = at;
        }
        out.triangles.push_back(t);
    }
    return out;
}

/// A blob, and one triangle that reaches to the largest float.
inline in::mesh with_huge_vertex(in::mesh m) {
    const auto first = static_cast<std::uint32_t>(m.positions.size());
    m.positions.insert(m.positions.end(), {{-0.9f, -0.9f, 0.4f}, {-0.9f, -0.5f, 0.4f}, {-3.4e38f, -0.7f, 0.4f}});
    m.triangles.emplace_back(first, first + 1, first + 2);
    return m;
}

/// Triangles without area among the others: points, and lines along edges.
inline in::mesh with_degenerates(in::mesh m) {
    const std::size_t count = m.triangles.size();
    for (std::size_t i = 0; i < count; i += 3) {
        const glm::uvec3 t = m.triangles[i];
        m.triangles.emplace_back(t.x, t.x, t.x);
        m.triangles.emplace_back(t.x, t.y, t.y);
        m.positions.push_back(0.5f * (m.positions[t.x] + m.positions[t.y]));
        m.triangles.emplace_back(t.x, static_cast<std::uint32_t>(m.positions.size() - 1), t.y);
    }
    return m;
}

/// Every other triangle twice, every fourth a third time and the other way round.
inline in::mesh with_duplicates(in::mesh m) {
    const std::size_t count = m.triangles.size();
    for (std::size_t i = 0; i < count; i += 2) {
        const glm::uvec3 t = m.triangles[i];
        m.triangles.emplace_back(t.y, t.z, t.x);
        if (i % 4 == 0) m.triangles.emplace_back(t.y, t.x, t.z);
    }
    return m;
}

/// Long thin triangles: a fan of a thousand blades, and a sheet of strips 1 mm wide.
inline in::mesh slivers() {
    const in::mesh fan = sheet(1000, 1, [](double u, double v) {
        const glm::dvec2 around = on_circle(u);
        const double wave = on_circle(17 * u - static_cast<double>(in::numeric::floor_to_int(17 * u))).y;
        return glm::dvec3(v * around.x, v * around.y, 0.7 - 0.3 * v + 0.1 * v * wave);
    });
    const in::mesh strips = sheet(2000, 1, [](double u, double v) {
        return glm::dvec3(2 * u - 1, 2.4 * v - 1.2, 0.15 + 0.02 * bumps({2 * u, 0.7, 0.2}, 60));
    });
    return joined(fan, strips);
}

}  // namespace shadow_meshes
