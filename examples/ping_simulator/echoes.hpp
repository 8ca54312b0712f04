// Echoes of pings as a coherent sum: every scatterer returns the pulse with its own amplitude and the phase of its
// path, and the receiver adds them up. Speckle, glints, layover, shadows and the blur of the beam come from the sum.
//
// The sonar travels along y at x = 0 and points towards +x. The points are the same for every ping.
#pragma once

#include <complex>
#include <vector>

#include "scene.hpp"

namespace pings {

/// An even function on [-end, end], 0 beyond, from a table.
class table {
  public:
    template <class Fn>
    table(double end, const Fn& fn) : scale_(steps / end) {
        for (int i = 0; i <= steps; ++i) values_.push_back(fn(end * i / steps));
        values_.back() = 0;
    }
    double operator()(double x) const {
        const double at = std::abs(x) * scale_ + 0.5;
        return at < steps ? values_[static_cast<std::size_t>(at)] : 0;
    }

  private:
    static constexpr int steps = 4096;
    double scale_;
    std::vector<double> values_;
};

/// exp(-2 pi i turns) from a table, to 3 mrad: errors 50 dB below the signal.
class carrier {
  public:
    carrier() {
        for (std::size_t i = 0; i < steps; ++i)
            values_.push_back(std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(i) / steps));
    }
    const std::complex<double>& operator()(double turns) const {
        return values_[static_cast<std::size_t>(turns * steps + 0.5) % steps];
    }

  private:
    static constexpr std::size_t steps = 1024;
    std::vector<std::complex<double>> values_;
};

/// Samples of a complex signal: a row per ping, the first one nearest to the chip's lower edge.
struct waterfall {
    std::size_t pings, samples;
    double spacing, first, step;  ///< metres: from ping to ping, to the first sample, and from sample to sample
    std::vector<std::complex<double>> signal;

    waterfall(std::size_t pings_, std::size_t samples_, double spacing_, double first_, double step_)
        : pings(pings_), samples(samples_), spacing(spacing_), first(first_), step(step_), signal(pings_ * samples_) {}

    std::complex<double>* row(std::size_t ping) { return &signal[ping * samples]; }
    double y(std::size_t ping) const { return (static_cast<double>(ping) + 0.5) * spacing; }
    double range(std::size_t sample) const { return first + (static_cast<double>(sample) + 0.5) * step; }
    double end() const { return first + static_cast<double>(samples) * step; }
};

class receiver {
  public:
    receiver(scene& s, waterfall& w)
        : scene_(s),
          out_(w),
          // A line array of length l: sinc(l sin(angle) / wavelength), there and back; -3 dB of one way at 0.443.
          lobe_(s.rig.beam / 0.886),
          pulse_width_(2 * s.rig.resolution),
          beam_(lobes, [](double u) { return u > 0 ? std::pow(std::sin(pi * u) / (pi * u), 2) : 1.0; }),
          pulse_(0.5 * pulse_width_, [this](double d) { return 0.5 * (1 + std::cos(2 * pi * d / pulse_width_)); }),
          reach_(lobes * lobe_ * w.end()) {}

    /// The echoes of bottom and target, and the receiver's noise.
    void record() {
        add_bottom();
        add_target();
        const double middle = 0.5 * (out_.first + out_.end()),
                     level = std::sqrt(scene_.rig.noise * bottom_power(middle));
        for (auto& sample : out_.signal) sample += level * scene_.random.gaussian();
    }

    /// Mean echo power of level bottom at a range.
    double bottom_power(double range) const {
        const double sine = std::min(1.0, scene_.rig.altitude / range), cosine = std::sqrt(1 - sine * sine);
        // Integrals of the beam's and the pulse's power: sinc^4 is 2/3 lobes wide, the Hann pulse 3/8 of its length.
        const double area = 2.0 / 3 * lobe_ * range * 0.375 * pulse_width_ / std::max(cosine, 0.1);
        return sine * sine * area / std::pow(range, 4);
    }

  private:
    static constexpr double pi = std::numbers::pi;
    static constexpr double lobes = 2;  // the main lobe, and one beside it

    /// Lambert's law for backscatter, power per area of surface.
    static double lambert(double cosine) { return cosine * cosine; }

    glm::dvec3 beside(const glm::dvec3& p) const { return {0, p.y, scene_.rig.altitude}; }

    /// The sea floor: a point in every cell, four cells to the pulse. Points behind a crest, seen from the ping
    /// abreast, are dropped here; the target's shadow is found ping by ping.
    void add_bottom() {
        const double altitude = scene_.rig.altitude, dx = scene_.rig.resolution / 4;
        // Eight rows to the beam's half width on the bottom, for smooth edges of shadows.
        const double dy = std::max(0.02, scene_.rig.beam * out_.first / 8);
        const auto ground = [&](double r) { return std::sqrt(std::max(0.0, r * r - altitude * altitude)); };
        const double relief = scene_.ground.relief(), more = relief + pulse_width_;
        const double from = std::max(0.0, ground(out_.first - more) - relief), to = ground(out_.end() + more) + relief;
        // Crests this far before the chip throw shadows into it.
        const double lead = std::min(from, 1.5 * relief * from / altitude);
        const double last = out_.y(out_.pings - 1) + reach_;
        for (double row = out_.y(0) - reach_; row < last; row += dy) {
            double horizon = -1e30;
            const double y = row + dy * scene_.random.uniform();
            for (double x = from - lead; x < to; x += dx) {
                const glm::dvec2 at{x + dx * scene_.random.uniform(), y};
                const bottom_point b = scene_.ground(at);
                const glm::dvec3 p{at.x, at.y, b.height};
                const double tangent = (p.z - altitude) / p.x;
                if (tangent <= horizon) continue;
                horizon = tangent;
                if (x < from) continue;
                const double stretched = std::sqrt(1 + b.slope.x * b.slope.x + b.slope.y * b.slope.y);
                const double facing = (altitude - p.z + p.x * b.slope.x) / (stretched * glm::length(p - beside(p)));
                if (facing > 0)
                    add_echoes(p, std::sqrt(lambert(facing) * dx * dy * stretched) * scene_.random.gaussian(), true);
            }
        }
    }

    /// The target: points all over its surface. Facets that face the sonar glint.
    void add_target() {
        const body& target = scene_.target_body();
        const double cell = 1e-4;
        const auto count = static_cast<std::size_t>(target.area() / cell);
        for (std::size_t i = 0; i < count; ++i) {
            const surface_point s = target.sample_surface(scene_.random);
            const std::complex<double> fluctuation = scene_.random.gaussian();
            const glm::dvec3 towards = beside(s.position) - s.position;
            const double facing = glm::dot(s.normal, towards) / glm::length(towards);
            if (!(facing > 0) || is_buried(s.position)) continue;
            const double incidence = std::acos(std::min(facing, 1.0)) / glm::radians(3.0);
            const double power = scene_.strength * (lambert(facing) + scene_.glint * std::exp(-incidence * incidence));
            add_echoes(s.position, std::sqrt(power * cell) * fluctuation, false);
        }
    }

    /// In the bottom, or behind a crest.
    bool is_buried(const glm::dvec3& p) const {
        if (p.z < scene_.ground({p.x, p.y}).height) return true;
        const glm::dvec3 towards = beside(p) - p;
        const double reaches = std::max(0.0, scene_.ground.relief() - p.z) / towards.z;  // fraction of the path
        for (double t = 0.02 / glm::length(towards); t < std::min(reaches, 1.0); t += 0.02 / glm::length(towards)) {
            const glm::dvec3 q = p + t * towards;
            if (q.z < scene_.ground({q.x, q.y}).height) return true;
        }
        return false;
    }

    /// Adds one point's echoes to all pings whose beam reaches it.
    void add_echoes(const glm::dvec3& p, const std::complex<double>& amplitude, bool may_be_hidden) {
        const body& target = scene_.target_body();
        const double across = p.x * p.x + (p.z - scene_.rig.altitude) * (p.z - scene_.rig.altitude);
        const double reach = lobes * lobe_ * std::sqrt(across);
        const double turns = 2 / scene_.rig.wavelength;  // there and back
        const bool near_target = may_be_hidden && p.x > target.centre().x - target.radius() &&
                                 std::abs(p.y - target.centre().y) < target.radius() + reach;
        const auto ping_at = [&](double y) {
            return static_cast<std::size_t>(std::clamp(y / out_.spacing + 0.5, 0.0, static_cast<double>(out_.pings)));
        };
        for (std::size_t ping = ping_at(p.y - reach), end = ping_at(p.y + reach); ping < end; ++ping) {
            const double along = out_.y(ping) - p.y, range = std::sqrt(across + along * along);
            const double first = (range - 0.5 * pulse_width_ - out_.first) / out_.step + 0.5;
            const double last = (range + 0.5 * pulse_width_ - out_.first) / out_.step + 0.5;
            if (!(last > 0 && first < static_cast<double>(out_.samples))) continue;
            const double gain = beam_(along / (range * lobe_)) / (range * range);
            if (near_target && target.hides(p, {0, out_.y(ping), scene_.rig.altitude})) continue;
            const std::complex<double> wave = gain * phase_(turns * range);
            const std::complex<double> echo(amplitude.real() * wave.real() - amplitude.imag() * wave.imag(),
                                            amplitude.real() * wave.imag() + amplitude.imag() * wave.real());
            std::complex<double>* const row = out_.row(ping);
            const auto until = static_cast<std::size_t>(std::min(last, static_cast<double>(out_.samples)));
            for (auto i = static_cast<std::size_t>(std::max(first, 0.0)); i < until; ++i)
                row[i] += pulse_(out_.range(i) - range) * echo;
        }
    }

    scene& scene_;
    waterfall& out_;
    double lobe_, pulse_width_;
    table beam_, pulse_;
    carrier phase_;
    double reach_;
};

}  // namespace pings
