// The sea floor as a function: height and slope at any place.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "dice.hpp"

namespace pings {

struct bottom_point {
    double height;
    glm::dvec2 slope;  ///< rise per metre
};

class bottom {
  public:
    /// Adds broad undulations of level sand or mud; `rms` in metres.
    void undulate(double rms, dice& random) {
        constexpr int count = 6;
        for (int i = 0; i < count; ++i) swells_.push_back(wave::sample(random, 1.2, 5, rms * std::sqrt(2.0 / count)));
    }

    /// Crests across `direction`, radians; they meander, and their height varies a little along them.
    void ripple(double wavelength, double height, double direction, dice& random) {
        height_ = height;
        number_ = 2 * std::numbers::pi / wavelength * glm::dvec2(std::cos(direction), std::sin(direction));
        for (int i = 0; i < 4; ++i) meanders_.push_back(wave::sample(random, 4 * wavelength, 12 * wavelength, 0.7));
        fade_ = wave::sample(random, 3, 8, 0.25);
    }

    bottom_point operator()(const glm::dvec2& at) const {
        bottom_point p{0, {0, 0}};
        for (const wave& w : swells_) w.add(at, p);
        if (height_ > 0) {
            bottom_point phase{number_.x * at.x + number_.y * at.y, number_}, size{0.75, {0, 0}};
            for (const wave& w : meanders_) w.add(at, phase);
            fade_.add(at, size);
            // A second harmonic makes crests narrower than troughs.
            const double c = std::cos(phase.height), s = std::sin(phase.height);
            const double profile = 0.5 * height_ * (c + 0.2 * (c * c - s * s));
            const double steep = -0.5 * height_ * (s + 0.8 * s * c);
            p.height += size.height * profile;
            p.slope += size.height * steep * phase.slope + profile * size.slope;
        }
        return p;
    }

    /// Upper bound of crests over troughs, metres.
    double relief() const {
        double sum = 1.2 * height_;
        for (const wave& w : swells_) sum += 2 * w.amplitude;
        return sum;
    }

  private:
    struct wave {
        glm::dvec2 number{0, 0};
        double phase = 0, amplitude = 0;

        static wave sample(dice& random, double shortest, double longest, double amplitude) {
            const double k = 2 * std::numbers::pi / random.uniform(shortest, longest);
            const double turn = random.uniform(0, 2 * std::numbers::pi);
            return {k * glm::dvec2(std::cos(turn), std::sin(turn)), random.uniform(0, 2 * std::numbers::pi), amplitude};
        }
        void add(const glm::dvec2& at, bottom_point& to) const {
            const double angle = number.x * at.x + number.y * at.y + phase;
            to.height += amplitude * std::sin(angle);
            to.slope += amplitude * std::cos(angle) * number;
        }
    };

    std::vector<wave> swells_, meanders_;
    wave fade_;
    double height_ = 0;
    glm::dvec2 number_{0, 0};
};

}  // namespace pings
