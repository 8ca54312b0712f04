// Targets scattered over the whole plane, at most one in each square of a lattice. Targets of a square depend on it
// alone, so that a scene holds only those in sight.
#pragma once

#include <insonify/insonify.hpp>

#include <map>
#include <optional>
#include <set>

namespace survey {

namespace in = insonify;

/// A square of the lattice.
using square = std::pair<std::int64_t, std::int64_t>;

class target_field {
  public:
    /// @param spacing  metres from square to square
    /// @param share    fraction of the squares that hold a target
    target_field(const in::seabed::any& seabed, double spacing, double share, std::uint64_t seed)
        : seabed_(seabed), spacing_(spacing), share_(share), seed_(seed) {}

    double spacing() const { return spacing_; }
    square square_at(const glm::dvec2& p) const {
        return {in::numeric::floor_to_int(p.x / spacing_), in::numeric::floor_to_int(p.y / spacing_)};
    }

    /// Adds the target of a square to a scene. @returns whether it has one
    bool add_to(in::scene& scene, const square& at) const {
        in::random_sequence random(
            seed_, 7,
            static_cast<std::uint64_t>(at.first) * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(at.second));
        if (random.uniform() > share_) return false;
        const auto coordinate = [&](std::int64_t cell) {
            return (static_cast<double>(cell) + random.uniform(0.15, 0.85)) * spacing_;
        };
        // One draw a statement: compilers evaluate arguments in different orders.
        const double y = coordinate(at.second), x = coordinate(at.first);
        const glm::dvec2 place(x, y);
        const auto size = static_cast<float>(random.uniform(0.5, 1.0));
        const auto yaw = static_cast<float>(random.uniform(0, 2 * in::numeric::pi));
        const auto lie = [&](const auto& shape, const char* name) {
            const in::mesh m = to_mesh(shape);
            in::pose pose = in::rest_on(seabed_, m, {.position = glm::dvec3(place, 0), .yaw = yaw});
            pose.burial = 0.1f * size;
            scene.add(m, pose, name);
        };
        switch (random.below(4)) {
            case 0: lie(in::cylinder{.radius = size / 2, .length = 3 * size}, "cylinder"); break;
            case 1: lie(in::cube{.size = glm::vec3(size)}, "cube"); break;
            case 2: lie(in::cone{.radius = 0.6f * size, .height = 1.2f * size}, "cone"); break;
            default: lie(in::sphere{.radius = size / 2}, "sphere"); break;
        }
        return true;
    }

    /// The squares within `reach` metres of any of the pings.
    std::set<square> around(std::span<const in::ping> pings, double reach) const {
        std::set<square> squares;
        std::optional<square> last_low, last_high;  // mostly those of the ping before
        for (const in::ping& p : pings) {
            const square low = square_at({p.position.x - reach, p.position.y - reach});
            const square high = square_at({p.position.x + reach, p.position.y + reach});
            if (low == last_low && high == last_high) continue;
            last_low = low, last_high = high;
            for (std::int64_t y = low.second; y <= high.second; ++y)
                for (std::int64_t x = low.first; x <= high.first; ++x) squares.emplace(x, y);
        }
        return squares;
    }

  private:
    in::seabed::any seabed_;
    double spacing_, share_;
    std::uint64_t seed_;
};

/// The targets near a part of the track, with the survey's contact numbers.
struct sight {
    in::scene scene;
    std::vector<std::uint16_t> numbers{0};  ///< by instance
};

/// Numbers targets when they come into sight and forgets them afterwards.
class lookout {
  public:
    sight around(const target_field& field, const in::seabed::any& seabed, std::span<const in::ping> pings,
                 double reach) {
        sight s;
        s.scene.seabed = seabed;
        std::map<square, std::uint16_t> still;
        for (const square& at : field.around(pings, reach)) {
            if (!field.add_to(s.scene, at)) continue;
            const auto known = numbers_.find(at);
            s.numbers.push_back(still[at] = known != numbers_.end() ? known->second : fresh());
        }
        numbers_ = std::move(still);
        return s;
    }

  private:
    /// Wraps around after 16 bits; by then the first target of that number is far away.
    std::uint16_t fresh() { return last_ = static_cast<std::uint16_t>(last_ == 65000 ? 1 : last_ + 1); }

    std::map<square, std::uint16_t> numbers_;
    std::uint16_t last_ = 0;
};

}  // namespace survey
