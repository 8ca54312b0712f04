// What a survey leaves behind, written as it comes: the waterfall and its labels row by row, pages to look at, the
// navigation, and a line for every contact.
#pragma once

#include <insonify/io/png.hpp>

#include <cstdio>
#include <fstream>

#include "field.hpp"
#include "vehicle.hpp"

namespace survey {

/// A binary PGM whose rows are appended; the number of rows is known before.
class pgm_stream {
  public:
    pgm_stream(const std::string& path, int width, std::int64_t height, int largest)
        : path_(path), file_(path, std::ios::binary) {
        file_ << "P5\n" << width << ' ' << height << '\n' << largest << '\n';
        check();
    }
    void row(std::span<const std::uint8_t> pixels) {
        file_.write(reinterpret_cast<const char*>(pixels.data()), static_cast<std::streamsize>(pixels.size()));
        check();
    }
    /// 16 bits, the high one first, as PGM wants it.
    void row(std::span<const std::uint16_t> pixels) {
        bytes_.clear();
        for (const std::uint16_t p : pixels) {
            bytes_.push_back(static_cast<std::uint8_t>(p >> 8));
            bytes_.push_back(static_cast<std::uint8_t>(p & 0xFF));
        }
        row(std::span<const std::uint8_t>(bytes_));
    }

  private:
    void check() {
        if (!file_) throw in::io_error(path_ + ": can't be written");
    }
    std::string path_;
    std::ofstream file_;
    std::vector<std::uint8_t> bytes_;
};

/// A table whose lines are appended.
class csv_stream {
  public:
    csv_stream(const std::string& path, const std::string& header) : path_(path), file_(path) { line(header); }
    void line(const std::string& text) {
        file_ << text << '\n';
        if (!file_) throw in::io_error(path_ + ": can't be written");
    }

  private:
    std::string path_;
    std::ofstream file_;
};

/// Text of numbers, printf's way.
template <class... Values>
std::string format(const char* pattern, Values... values) {
    char text[512];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

/// Keeps the last rows and writes them as a picture when there are enough: gray, and copper to look at.
class pages {
  public:
    pages(const std::string& folder, int width, int height) : folder_(folder), page_(width, height) {}

    void row(std::span<const std::uint8_t> pixels) {
        std::copy(pixels.begin(), pixels.end(), page_.row(used_).begin());
        if (++used_ == page_.height()) finish();
    }
    /// Writes what there is.
    void finish() {
        if (used_ == 0) return;
        const in::image<std::uint8_t> part(page_.view().part(0, 0, page_.width(), used_));
        const std::string name = folder_ + format("/page_%04d", count_++);
        in::write_png(name + ".png", part);
        const auto gray = in::map_pixels(part, [](std::uint8_t p) { return static_cast<float>(p) / 255; });
        in::write_png(name + "_copper.png", gray | in::colormap::copper);
        used_ = 0;
    }

  private:
    std::string folder_;
    in::image<std::uint8_t> page_;
    int used_ = 0, count_ = 0;
};

/// Where a target is in the waterfall: a box that grows until the target is out of sight.
struct contact {
    std::string class_name;
    in::side side;
    glm::dvec3 position;
    double yaw, height;
    std::int64_t first_ping = 0, last_ping = -1;
    int first_bin = 1 << 30, last_bin = -1, shadow_end = -1;
    std::int64_t area = 0, shadow_area = 0;
    fix closest{};  ///< the ping from which it is abeam
    double closest_along = 1e30;
};

class contact_list {
  public:
    explicit contact_list(const std::string& path)
        : table_(path,
                 "target,class,side,first_ping,last_ping,first_bin,last_bin,shadow_end_bin,target_px,shadow_px,x_m,y_m,"
                 "height_m,range_m,altitude_m,grazing_deg,aspect_deg,shadow_theory_m,shadow_measured_m") {}

    contact& of(std::uint16_t target, in::side side) { return open_[{target, side}]; }
    bool knows(std::uint16_t target, in::side side) const { return open_.contains({target, side}); }

    /// Writes and forgets contacts that have not been seen since a ping.
    void close(std::int64_t before, const in::side_scan& rig) {
        for (auto at = open_.begin(); at != open_.end();) {
            if (at->second.last_ping >= before) {
                ++at;
                continue;
            }
            write(at->first.first, at->second, rig);
            at = open_.erase(at);
        }
    }

  private:
    void write(std::uint16_t target, const contact& c, const in::side_scan& rig) {
        if (c.area + c.shadow_area == 0) return;
        namespace geometry = in::range_geometry;
        const double altitude = c.closest.at.position.z;
        const double ground = in::ping_frame(c.closest.at, c.side)(c.position).x;
        const double turn = 2 * in::numeric::pi, off = (c.yaw - c.closest.at.yaw) / turn;
        const double aspect = turn * (off - static_cast<double>(in::numeric::floor_to_int(off)));
        const double echo = geometry::slant_range(ground, altitude, c.height);
        const double measured = c.shadow_end < 0 ? 0 : (c.shadow_end + 1) * rig.bin() - echo;
        table_.line(std::to_string(target) + "," + c.class_name + (c.side == in::side::port ? ",port" : ",starboard") +
                    "," + std::to_string(c.first_ping) + "," + std::to_string(c.last_ping) +
                    format(",%d,%d,%d", c.first_bin, c.last_bin, c.shadow_end) + "," + std::to_string(c.area) + "," +
                    std::to_string(c.shadow_area) +
                    format(",%.3f,%.3f,%.3f,%.3f,%.3f,%.2f,%.1f,%.3f,%.3f", c.position.x, c.position.y, c.height,
                           geometry::slant_range(ground, altitude), altitude,
                           in::numeric::to_degrees(geometry::grazing_angle(ground, altitude)),
                           in::numeric::to_degrees(aspect), geometry::slant_shadow_length(ground, altitude, c.height),
                           measured));
    }

    std::map<std::pair<std::uint16_t, in::side>, contact> open_;
    csv_stream table_;
};

}  // namespace survey
