// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_file.hpp"

#include <cstdlib>
#include <filesystem>

#include "tests/catch.hpp"
#include "tests/unit/common/map/map_folder.hpp"
#include "tests/unit/common/map/random_map.hpp"

namespace sidestep::map_file_test {

using test::drawing;
using test::kMapYaml;
using test::MapFolder;
using test::replaced;

/// A raw image with one row.
std::string row_of(const std::string& pixels) {
  return "P5 " + std::to_string(pixels.size()) + " 1 255\n" + pixels;
}

TEST_CASE("a map is read with its position, and unknown cells are blocked") {
  const MapFolder folder;
  const OccupancyMap map =
      folder.load(kMapYaml, "P5\n# by hand\n3 2\n255\n" + std::string("\xfe\xcd\0\xfe\xfe\xff", 6));
  CHECK(map.grid().resolution_m == 0.1);
  CHECK(map.grid().origin_m == Vec2(-1.5, 2.25));
  CHECK(drawing(map) == ".##/.../");
}

TEST_CASE("occupancy probabilities follow map_server's rules") {
  const MapFolder folder;
  // p = (255 - v) / 255: 203 has p = 0.20392, 204 has 0.2, 206 has 0.19216, 207 has 0.18824.
  const std::string image = row_of("\xff\xcf\xce\xcc\xcb\x80\x01");
  CHECK(drawing(folder.load(kMapYaml, image)) == "...####/");
  CHECK(drawing(folder.load(replaced(kMapYaml, "0.196\n", "0.192\n"), image)) == "..#####/");
  CHECK(drawing(folder.load(replaced(kMapYaml, "0.196\n", "0.2\n"), image)) == "...####/");
  CHECK(drawing(folder.load(replaced(kMapYaml, "0.196\n", "0.201\n"), image)) == "....###/");
  // Negated, p = v / 255: 50 has 0.19608, 49 has 0.19216.
  const std::string dark = row_of(std::string("\0\x31\x32\x33\xff", 5));
  for (const char* yes : {"1", "true", "True", "TRUE", "yes", "on", "1.0"})
    CHECK(drawing(folder.load(replaced(kMapYaml, "negate: 0", std::string("negate: ") + yes), dark)) ==
          "..###/");
  for (const char* no : {"false", "False", "no", "off", "0.0"})
    CHECK(drawing(folder.load(replaced(kMapYaml, "negate: 0", std::string("negate: ") + no), dark)) ==
          "####./");
  CHECK(drawing(folder.load(kMapYaml + "mode: trinary\n", image)) == "...####/");
  CHECK(drawing(folder.load(kMapYaml + "mode: scale\n", image)) == "...####/");
  // Raw values are percentages, and unknown above 100.
  CHECK(drawing(folder.load(kMapYaml + "mode: raw\n", row_of(std::string("\0\x13\x14\x64\xff", 5)))) ==
        "..###/");
}

TEST_CASE("the grey value that map savers use for unknown cells means unknown for any thresholds") {
  const MapFolder folder;
  // Free, unknown, likely free, likely occupied, occupied.
  const std::string image = row_of(std::string("\xfe\xcd\xd2\x80\0", 5));
  for (const char* threshold : {"0.196\n", "0.25\n", "0.5\n"}) {
    const std::string yaml = replaced(kMapYaml, "0.196\n", threshold);
    const bool is_lax = std::string(threshold) == "0.5\n";
    const LoadedMap blocked = folder.load_all(yaml, image);
    CHECK(drawing(blocked.cells) == (is_lax ? ".#..#/" : ".#.##/"));
    CHECK(blocked.unknown == (is_lax ? 1 : 2));
    const LoadedMap allowed = folder.load_all(yaml, image, UnknownCells::kFree);
    CHECK(drawing(allowed.cells) == "....#/");
    CHECK(allowed.unknown == blocked.unknown);
  }
  // In mode "scale", every grey value is a probability.
  const LoadedMap scaled = folder.load_all(replaced(kMapYaml, "0.196\n", "0.25\n") + "mode: scale\n", image);
  CHECK(drawing(scaled.cells) == "...##/");
  CHECK(scaled.unknown == 1);
  const LoadedMap raw = folder.load_all(kMapYaml + "mode: raw\n", row_of(std::string("\0\x32\x64\xff", 4)),
                                        UnknownCells::kFree);
  CHECK(drawing(raw.cells) == "..#./");
  CHECK(raw.unknown == 2);
}

TEST_CASE("the axes of a rotated map are its rows and columns") {
  const MapFolder folder;
  const auto load = [&](const std::string& origin) {
    return folder.load_all(replaced(kMapYaml, "[-1.5, 2.25, 0.0]", origin), row_of("\xff"));
  };
  const LoadedMap quarter = load("[-1.5, 2.25, 1.5707963267948966]");
  CHECK(quarter.yaw_rad == Approx(1.5707963267948966));
  CHECK((quarter.cells.grid().origin_m - Vec2(2.25, 1.5)).norm() < 1e-12);
  const LoadedMap straight = load("[-4, -2, 1.2246467991473532e-16]");
  CHECK(straight.yaw_rad == 0);
  CHECK(straight.cells.grid().origin_m == Vec2(-4, -2));
}

TEST_CASE("all kinds of PGM images give the same map") {
  const MapFolder folder;
  for (const std::string& image :
       {std::string("P2\n2 2 255\n254 0\n0 254\n"), std::string("P2 2 2 # comment\n 9\n9 0 0\t9"),
        std::string("P2\n2\r\n2\n65535 65535 0\n0 65535\n"), std::string("P5\n2 2\n1\n\1\0\0\1", 13),
        std::string("P5 2 2 65535\n\xff\xfe\0\0\0\xff\xff\0", 21),
        std::string("P5 2 2 255\n\xfe\0\0\xfe trailing", 24)}) {
    INFO(image);
    CHECK(drawing(folder.load(kMapYaml, image)) == ".#/#./");
  }
}

TEST_CASE("the path of the image may be absolute or relative to the YAML file") {
  const MapFolder folder;
  write_file(folder / "images/other.pgm", row_of("\xff"));
  CHECK(drawing(folder.load(replaced(kMapYaml, "map.pgm", "images/other.pgm"), "")) == "./");
  CHECK(drawing(folder.load(replaced(kMapYaml, "map.pgm", folder / "images/other.pgm"), "")) == "./");
}

TEST_CASE("a map survives writing and reading") {
  const std::uint64_t seed = GENERATE(range(1, 30));
  CAPTURE(seed);
  Rng rng(seed);
  const MapFolder folder;
  const OccupancyMap map = test::random_map(rng, 60);
  write_occupancy_map(map, folder / "written \"map\"");
  const OccupancyMap read = load_map(folder / "written \"map\".yaml").cells;
  CHECK(read.blocked() == map.blocked());
  CHECK(read.grid().resolution_m == map.grid().resolution_m);
  CHECK(read.grid().origin_m == map.grid().origin_m);
}

TEST_CASE("errors in the YAML file are reported with their line") {
  const MapFolder folder;
  const auto check = [&](const std::string& old_part, const std::string& new_part, int line,
                         const std::string& why) {
    const std::string error = folder.error(replaced(kMapYaml, old_part, new_part), row_of("\xff"));
    CHECK_THAT(error, StartsWith("map.yaml:" + std::to_string(line) + ": "));
    CHECK_THAT(error, ContainsSubstring(why));
  };
  check("image: map.pgm\n", "", 1, "\"image\" is missing");
  check("image: map.pgm", "image: [1]", 1, "expected text");
  check("image: map.pgm", "image: \"\"", 1, "expected the path of an image");
  check("resolution: 0.1\n", "", 1, "\"resolution\" is missing");
  check("0.1\n", "0\n", 2, "expected 0.001 to 10");
  check("0.1\n", "11\n", 2, "expected 0.001 to 10");
  check("0.1\n", ".nan\n", 2, "expected a number");
  check("0.1\n", "nan\n", 2, "expected 0.001 to 10");
  check("origin: [-1.5, 2.25, 0.0]\n", "", 1, "\"origin\" is missing");
  check("[-1.5, 2.25, 0.0]", "[-1.5, 2.25]", 3, "expected a list of 3 numbers");
  check("[-1.5, 2.25, 0.0]", "[-1.5, inf, 0.0]", 3, "expected -1000000 to 1000000");
  check("negate: 0\n", "", 1, "\"negate\" is missing");
  check("negate: 0", "negate: 2", 4, "expected 0 to 1");
  check("negate: 0", "negate: maybe", 4, "expected a number from 0 to 1");
  check("occupied_thresh: 0.65", "occupied_thresh: 1.5", 5, "expected 0 to 1");
  check("occupied_thresh: 0.65", "occupied_thresh: 0.1", 6, "expected at most occupied_thresh");
  check("free_thresh: 0.196\n", "", 1, "\"free_thresh\" is missing");
  check("free_thresh: 0.196", "free_thresh: -1", 6, "expected 0 to 1");
  check("free_thresh: 0.196\n", "free_thresh: 0.196\nmode: colour\n", 7, "expected trinary, scale or raw");
  check("free_thresh: 0.196\n", "free_thresh: 0.196\nheight: 3\n", 7, "unknown key \"height\"");
  CHECK_THAT(folder.error("", ""), ContainsSubstring("the file is empty, expected a map"));
  CHECK_THROWS_AS(load_map(folder / "none.yaml"), ConfigError);
}

TEST_CASE("errors in an image are reported with its name and the line of its key") {
  const MapFolder folder;
  const auto check = [&](const std::string& image, const std::string& why) {
    const std::string error = folder.error(kMapYaml, image);
    INFO(image);
    CHECK_THAT(error, StartsWith("map.yaml:1: image: "));
    CHECK_THAT(error, ContainsSubstring("map.pgm: "));
    CHECK_THAT(error, ContainsSubstring(why));
  };
  check("", "cannot read it (No such file");
  check("P6 1 1 255\n\1\1\1", "neither a PGM image (P2 or P5) nor a PNG image");
  check("P", "neither a PGM");
  check("P5", "ends before its width");
  check("P5 # only a comment", "ends before its width");
  check("P5 2", "ends before its height");
  check("P5 2 2\n", "ends before its maximum sample");
  check("P5 x 2 255\n", "width is not a number");
  check("P5 -2 2 255\n", "width is not a number");
  check("P5 99999999999999999999 2 255\n", "width is larger than 65535");
  check("P5 0 2 255\n", "0 x 2 pixels, expected 1 to 16384");
  check("P5 16385 1 255\n", "16385 x 1 pixels");
  check("P5 16384 16384 255\n", "at most 67108864 pixels");
  check("P5 1 1 0\n\1", "maximum sample is 0");
  check("P5 1 1 65536\n\1", "maximum sample is larger than 65535");
  check("P5 2 2 255\n\1\1\1", "truncated");
  check("P5 2 2 256\n\1\1\1\1\1\1\1", "truncated");
  check("P5 8192 8192 255\n", "truncated");
  check("P5 1 1 7\n\x8", "a pixel is 8, but its maximum sample is 7");
  check("P2 2 2 255\n1 1 1", "truncated");
  check("P2 2 2 255\n100 100 1 ", "ends before its pixel");
  check("P2 2 2 255\n1 1 256 1", "a pixel is 256");
  check("P2 2 2 255\n1 1 1.5 1", "pixel is not a number");
  check("P2 2 2 255\n1 1 99999999999999999999 1", "pixel is larger than 65535");
  check("P2 2 2 255\n1 1 # 1 1", "pixel is not a number");
  std::filesystem::remove(folder / "map.pgm");
  std::filesystem::create_directory(folder / "map.pgm");
  check("", "not a regular file");
}

TEST_CASE("a map recorded by a mobile robot is read") {
  const char* const maps = std::getenv("SIDESTEP_MAPS");
  if (maps == nullptr) {
    WARN("skipped: SIDESTEP_MAPS is not a folder with tb3_sandbox.yaml of ROS's nav2_bringup");
    return;
  }
  const OccupancyMap map = load_map(std::string(maps) + "/tb3_sandbox.yaml").cells;
  CHECK(map.grid().columns == 384);
  CHECK(map.grid().rows == 384);
  CHECK(map.grid().resolution_m == 0.05);
  CHECK(map.grid().origin_m == Vec2(-10, -10));
  // Three points: the robot's start, the middle of a pillar, and the unknown corner.
  CHECK(map.distance_m({-2, -0.5}) > 0.3);
  CHECK(map.distance_m({0, 0}) == 0);
  CHECK(map.distance_m({-9.9, -9.9}) == 0);
}

}  // namespace sidestep::map_file_test
