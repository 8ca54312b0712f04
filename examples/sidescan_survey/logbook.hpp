// The files of a survey, written as it runs: the waterfall and its labels row by row, pages to look at, the navigation,
// a line for every contact, and at the end the map.
#pragma once

#include "chart.hpp"
#include "contacts.hpp"

namespace survey {

/// Writes a survey's files. @throws io_error if one cannot be written
class logbook {
  public:
    /// @param total  number of pings of the whole survey
    logbook(const options& o, const in::seabed::any& seabed, std::int64_t total, chart map)
        : folder_(o.out),
          waterfall_(o.out + "/waterfall.pgm", 2 * o.bins, total, 255),
          targets_(o.out + "/targets.pgm", 2 * o.bins, total, 65535),
          shadows_(o.out + "/shadows.pgm", 2 * o.bins, total, 65535),
          seabed_(o.out + "/seabed.pgm", 2 * o.bins, total, 255),
          pages_(o.out + "/pages", 2 * o.bins, o.page),
          navigation_(o.out + "/navigation.csv",
                      "ping,time_s,x_m,y_m,altitude_over_datum_m,altitude_over_bottom_m,heading_deg"),
          contacts_(o.out + "/contacts.csv"),
          map_(std::move(map)),
          bottom_(seabed.prepare()) {}

    void write(const block& b, const sight& in_sight, const in::side_scan& rig) {
        for (int row = 0; row < b.gray.height(); ++row) {
            waterfall_.row(b.gray.row(row));
            targets_.row(b.labels.instance.row(row));
            shadows_.row(b.labels.shadow.row(row));
            seabed_.row(b.labels.seabed.row(row));
            pages_.row(b.gray.row(row));
            write_navigation(b.pings[static_cast<std::size_t>(row)]);
        }
        for (const in::target& t : in_sight.scene.targets)
            map_.mark(glm::dvec2(t.placement.position), {220, 30, 30}, 2);
        contacts_.add(b, in_sight);
        // Contacts last seen before this block are complete.
        contacts_.close(b.pings.front().number, rig);
    }

    void finish(std::int64_t total, const in::side_scan& rig) {
        for (pgm_stream* const file : {&waterfall_, &targets_, &shadows_, &seabed_}) file->close();
        navigation_.close();
        contacts_.finish(total, rig);
        pages_.finish();
        in::write_png(folder_ + "/map.png", map_.picture());
    }

  private:
    void write_navigation(const fix& f) {
        const glm::dvec3& p = f.at.position;
        const double over = p.z - static_cast<double>(in::seabed::at(bottom_, p.x, p.y).height);
        const double turns = -f.at.yaw / (2 * in::numeric::pi);  // a compass goes clockwise
        const double degrees = 360 * (turns - static_cast<double>(in::numeric::floor_to_int(turns)));
        const double heading = degrees < 359.9995 ? degrees : 0;  // three decimals would be 360.000
        navigation_.line(std::to_string(f.number) +
                         format(",%.4f,%.3f,%.3f,%.3f,%.3f,%.3f", f.time, p.x, p.y, p.z, over, heading));
        map_.mark(glm::dvec2(p), {20, 40, 160}, 1);
    }

    std::string folder_;
    pgm_stream waterfall_, targets_, shadows_, seabed_;
    pages pages_;
    csv_stream navigation_;
    contact_list contacts_;
    chart map_;
    in::seabed::any_sampler bottom_;
};

}  // namespace survey
