// Adds relief finer than the grid to a coarse survey: multibeam maps of a metre's spacing lack what a sonar of
// centimetres resolves.
#pragma once

#include <insonify/seabed/detail/noise.hpp>
#include <insonify/seabed/heightfield.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

inline namespace INSONIFY_FLAGS {

class detailed_sampler;

}  // namespace INSONIFY_FLAGS

/// A heightfield with bicubic (Catmull-Rom) interpolation between its vertices, plus roughness. Within two cells of a
/// missing vertex it has the heightfield's triangles instead; where they meet, heights may step by 1/8 of the relief.
///
/// `roughness_of(sediment, spacing)` continues the relief of a survey of that spacing (seabed/sediment.hpp).
struct detailed {
    heightfield field{};
    roughness surface{.rms = 0.01f, .longest = 1, .shortest = 0.06f};
    std::uint64_t seed = 1;

    /// By reference: the heightfield has to outlive the sampler.
    /// @throws invalid_input as `validate` of heightfields, and for parameters of the roughness out of their range
    INSONIFY_TAGGED detailed_sampler prepare() const;
    INSONIFY_MEMBER std::optional<type> only_type() const { return field.only_type(); }
    INSONIFY_MEMBER std::vector<type_properties> legend() const { return field.legend(); }
};

inline namespace INSONIFY_FLAGS {

/// Evaluates `detailed`.
class detailed_sampler {
  public:
    explicit detailed_sampler(const detailed& d)
        : field_(&d.field), surface_(d.surface, d.seed, detail::stream::survey) {
        validate(d.field);
    }

    void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        detail::by_stretches(line, heights, [&](const detail::stretch& part, detail::stretch_values& values) {
            for (std::size_t i = 0; i < part.count; ++i) values[i] = smooth_at(part.x[i], part.y);
            surface_.add(part, values);
        });
        for (std::size_t i = 0; i < types.size(); ++i) types[i] = field_->type_at(line.x(i), line.y);
    }

    /// Catmull-Rom's negative weights add up to 1/8 at most: interpolated rows overshoot the range by 1/8 at either
    /// end, and columns overshoot the resulting 5/4 of the range by 1/8 again.
    height_range range() const {
        const height_range field = detail::with_rounding(field_->prepare().range());
        const double over = 0.2813 * (field.highest - field.lowest) + surface_.upper_bound();
        return field.empty() ? field : height_range{field.lowest - over, field.highest + over};
    }

  private:
    /// Catmull-Rom interpolation in both directions; beside missing vertices, the facets of the mesh.
    float smooth_at(double x, double y) const {
        const image<float>& h = field_->heights;
        const detail::grid_coordinate u((x - field_->origin.x) / field_->spacing, h.width() - 1),
            v((y - field_->origin.y) / field_->spacing, h.height() - 1);
        const auto clamped = [](int i, int size) { return i < 0 ? 0 : i < size ? i : size - 1; };
        float column[4];
        for (int j = 0; j < 4; ++j) {
            const int row = clamped(v.cell - 1 + j, h.height());
            float p[4];
            for (int i = 0; i < 4; ++i) p[i] = h(clamped(u.cell - 1 + i, h.width()), row);
            detail::catmull_rom(column[j], p, static_cast<float>(u.across));
        }
        float height;
        detail::catmull_rom(height, column, static_cast<float>(v.across));
        return numeric::is_finite(height) ? height : field_->height_at(x, y);
    }

    const heightfield* field_;
    detail::power_law_noise surface_;
};

}  // namespace INSONIFY_FLAGS

inline detailed_sampler detailed::prepare() const {
    return detailed_sampler(*this);
}

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
