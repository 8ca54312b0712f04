// Out of memory while files are read and written: the old file or the new one remains, and no temporary one.
#include <insonify/geometry/obj.hpp>
#include <insonify/io/file.hpp>
#include <insonify/io/manifest.hpp>
#include <insonify/io/netpbm.hpp>
#include <insonify/seabed/bathymetry.hpp>

#include "../../failing_new.hpp"
#include "../../scratch_folder.hpp"

namespace in = insonify;

TEST_CASE("write_file() that runs out of memory leaves the old file and no temporary one") {
    const scratch_folder folder;
    const std::string path = folder / "a_name_that_is_longer_than_a_string_holds_in_place.pgm", old_bytes = "old",
                      new_bytes = "newer";
    CHECK(failing_new::fail_each_allocation([&] {
              {
                  const long armed = failing_new::fails_at.exchange(0);
                  in::write_file(path, old_bytes);
                  failing_new::calls = 0;
                  failing_new::fails_at = armed;
              }
              bool was_refused = false;
              try {
                  in::write_file(path, new_bytes);
              } catch (const std::bad_alloc&) {
                  was_refused = true;
              }
              failing_new::fails_at = 0;
              return in::read_file(path) == (was_refused ? old_bytes : new_bytes) && folder.names().size() == 1;
          }) > 2);
}

TEST_CASE("Readers and tables survive any failed allocation") {
    const in::image<std::uint8_t> picture{{1, 2}, {3, 4}};
    CHECK(failing_new::fail_each_allocation(
              [&] { return in::parse_netpbm<std::uint8_t>(in::format_netpbm(picture)); }) > 1);
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 1 2 4 3\n";
    CHECK(failing_new::fail_each_allocation([&] { return in::read_obj(obj).positions; }) > 2);
    const std::string grid = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n1 2 3\n4 -9 6\n";
    CHECK(failing_new::fail_each_allocation([&] { return in::seabed::parse_esri_grid(grid).heights.size(); }) > 0);
    CHECK(failing_new::fail_each_allocation(
              [&] { return in::seabed::parse_xyz("0 0 1\n1 0 2\n0 1 3\n1 1 4\n", 1).heights.size(); }) > 0);
}

TEST_CASE("A failed add() leaves the table unchanged") {
    const std::string cell = "a cell that is longer than a string holds in place";
    CHECK(failing_new::fail_each_allocation([&] {
              in::csv_table table{"name", "note"};
              const std::string before = table.text();
              try {
                  table.add(cell, "with \"quotes\" and more than fits in place");
                  return table.text().size() > before.size() && table.text().ends_with("\r\n");
              } catch (const std::bad_alloc&) {
                  return table.text() == before;
              }
          }) > 3);
}
