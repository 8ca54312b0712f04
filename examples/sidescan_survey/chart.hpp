// A map, north up: shaded relief with the track and the targets on it.
#pragma once

#include <insonify/seabed/sample.hpp>

#include "field.hpp"

namespace survey {

class chart {
  public:
    /// @param low, high  corners of the map, metres
    /// @param longer     pixels along its longer side
    chart(const in::seabed::any& seabed, glm::dvec2 low, glm::dvec2 high, int longer, auto& ex) {
        const glm::dvec2 size = high - low;
        spacing_ = (std::max)(size.x, size.y) / (longer - 1);
        low_ = low;
        const auto vertices = [&](double length) { return (std::max)(2, static_cast<int>(length / spacing_) + 1); };
        const auto field = in::seabed::sample(seabed, {low, spacing_, vertices(size.x), vertices(size.y)}, ex);
        picture_ = in::image<in::rgb8>(field.heights.width(), field.heights.height());
        for (int y = 0; y < picture_.height(); ++y)
            for (int x = 0; x < picture_.width(); ++x) {
                const int row = picture_.height() - 1 - y;
                // Light from the upper left: slopes that face it are brighter.
                const float rise = field.heights(x, row) -
                                   field.heights((std::max)(x - 1, 0), (std::min)(row + 1, picture_.height() - 1));
                const float shade = 0.5f + 1.2f * rise / static_cast<float>(spacing_);
                const auto type = field.types.empty() ? field.fallback : field.types(x, row);
                const glm::vec3 tint = type == in::seabed::type::mud    ? glm::vec3(0.55f, 0.50f, 0.42f)
                                       : type == in::seabed::type::rock ? glm::vec3(0.50f, 0.52f, 0.58f)
                                                                        : glm::vec3(0.80f, 0.72f, 0.52f);
                const glm::vec3 c = tint * (0.5f + (std::min)((std::max)(shade, 0.0f), 1.0f));
                picture_(x, y) = {in::quantize<std::uint8_t>(c.x), in::quantize<std::uint8_t>(c.y),
                                  in::quantize<std::uint8_t>(c.z)};
            }
    }

    /// A square dot of (2 radius + 1)^2 pixels.
    void mark(const glm::dvec2& at, in::rgb8 color, int radius) {
        const int x = static_cast<int>((at.x - low_.x) / spacing_ + 0.5);
        const int y = picture_.height() - 1 - static_cast<int>((at.y - low_.y) / spacing_ + 0.5);
        for (int j = y - radius; j <= y + radius; ++j)
            for (int i = x - radius; i <= x + radius; ++i)
                if (i >= 0 && j >= 0 && i < picture_.width() && j < picture_.height()) picture_(i, j) = color;
    }

    const in::image<in::rgb8>& picture() const { return picture_; }

  private:
    double spacing_;
    glm::dvec2 low_;
    in::image<in::rgb8> picture_;
};

}  // namespace survey
