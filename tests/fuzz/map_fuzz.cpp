// SPDX-License-Identifier: Apache-2.0
// Fuzzes the reader of maps. An input is a byte that selects whether
// checksums are corrected, the YAML file, a zero byte, and the image, which the YAML file calls `image`.
#include <algorithm>
#include <array>
#include <cmath>
#include <png.h>
#include <zlib.h>

#include "common/file/temporary_folder.hpp"
#include "common/map/floor_map.hpp"
#include "common/map/map_file.hpp"
#include "common/yaml/config_error.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace sidestep::fuzz {
namespace {

/// Corrects the checksums of a PNG image's chunks, because random changes would never pass them.
void correct_checksums(Bytes& image) {
  constexpr std::size_t kSignature = 8, kOverhead = 12;
  for (std::size_t at = kSignature; image.size() >= at + kOverhead;) {
    const std::size_t size =
        std::size_t{image[at]} << 24 | image[at + 1] << 16 | image[at + 2] << 8 | image[at + 3];
    if (size > image.size() - at - kOverhead) return;
    const uLong sum = crc32_z(0, &image[at + 4], 4 + size);
    for (std::size_t i = 0; i < 4; ++i)
      image[at + 8 + size + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    at += kOverhead + size;
  }
}

void check(const LoadedMap& map) {
  const MapGrid& grid = map.cells.grid();
  SIDESTEP_REQUIRE(grid.columns >= 1 && grid.columns <= 16'384 && grid.rows >= 1 && grid.rows <= 16'384);
  const std::size_t cells = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  SIDESTEP_REQUIRE(cells <= 64u << 20 && map.unknown <= cells);
  SIDESTEP_REQUIRE(grid.resolution_m >= 0.001 && grid.resolution_m <= 10);
  // The origin in the file is within a square, which the yaw rotates.
  SIDESTEP_REQUIRE(grid.origin_m.norm() <= 1e6 * std::sqrt(2.0) && std::isfinite(map.yaw_rad));
}

/// Checks that blocked cells are found by distance and by contact, and that a written map is read as the same
/// map.
void check_use(const LoadedMap& map, const TemporaryFolder& folder) {
  const MapGrid& grid = map.cells.grid();
  constexpr int kMaxSide = 256;
  if (grid.columns > kMaxSide || grid.rows > kMaxSide) return;
  for (int row = 0; row < grid.rows; row += 1 + grid.rows / 4) {
    for (int column = 0; column < grid.columns; column += 1 + grid.columns / 4) {
      const Box box = grid.box_of({column, row});
      const Vec2 centre = (box.min_m + box.max_m) / 2;
      const bool is_blocked = map.cells.blocked().get(column, row);
      SIDESTEP_REQUIRE(!is_blocked || map.cells.distance_m(centre, 1) == 0);
      SIDESTEP_REQUIRE(!is_blocked || map.cells.touches(centre, centre, 0));
    }
  }
  const MapFiles files = map_files(map.cells, "image");
  write_input(folder.file("written.yaml"), bytes_of(files.yaml));
  write_input(folder.file("image"), bytes_of(files.image));
  const LoadedMap again = load_map(folder.file("written.yaml"));
  SIDESTEP_REQUIRE(again.cells.blocked() == map.cells.blocked() && again.unknown == 0);
  SIDESTEP_REQUIRE(again.cells.grid().resolution_m == grid.resolution_m);
  SIDESTEP_REQUIRE(again.cells.grid().origin_m == grid.origin_m);
}

/// Uses a map on a floor, with its distances and rectangles.
void try_floor(const LoadedMap& map) {
  try {
    const FloorMap floor(map.cells, "map");
    SIDESTEP_REQUIRE(floor.boxes_on({}).size() <= FloorMap::kMaxRectangles + 4);
  } catch (const std::invalid_argument&) {
    // the map has too many rectangles
  }
}

Bytes input_of(std::string_view yaml, const Bytes& image) {
  Bytes input{1};
  input.insert(input.end(), yaml.begin(), yaml.end());
  input.push_back(0);
  input.insert(input.end(), image.begin(), image.end());
  return input;
}

/// A PNG image of 5 x 4 pixels in a format of libpng.
Bytes png_image_of(std::uint32_t format) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 5, image.height = 4, image.format = format;
  image.colormap_entries = 256;
  Bytes pixels(PNG_IMAGE_SIZE(image));
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = static_cast<std::uint8_t>(i % 3 == 0 ? 255 : 37 * i);
  Bytes map(PNG_IMAGE_COLORMAP_SIZE(image), 200);
  Bytes file(1024);
  png_alloc_size_t size = file.size();
  SIDESTEP_REQUIRE(png_image_write_to_memory(&image, file.data(), &size, 0, pixels.data(), 0, map.data()) !=
                   0);
  file.resize(size);
  return file;
}

}  // namespace

bool try_input(View input) {
  static const TemporaryFolder folder;
  if (input.empty()) return false;
  const View rest = input.subspan(1);
  const auto end = std::ranges::find(rest, 0);
  Bytes image(end == rest.end() ? end : end + 1, rest.end());
  if ((input[0] & 1) != 0) correct_checksums(image);
  write_input(folder.file("map.yaml"), {rest.begin(), end});
  write_input(folder.file("image"), image);
  const UnknownCells unknown = (input[0] & 2) != 0 ? UnknownCells::kFree : UnknownCells::kBlocked;
  try {
    const LoadedMap map = load_map(folder.file("map.yaml"), unknown);
    check(map);
    try_floor(map);
    check_use(map, folder);
    return true;
  } catch (const ConfigError& error) {
    SIDESTEP_REQUIRE(std::string_view(error.what()).starts_with(folder.path()));
    return false;
  }
}

std::vector<Bytes> seeds() {
  const std::string yaml =
      "image: image\nresolution: 0.05\norigin: [-1, -2, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
      "free_thresh: 0.196\n";
  std::vector<Bytes> result;
  for (const char* mode : {"", "mode: trinary\n", "mode: scale\n", "mode: raw\n"})
    result.push_back(
        input_of(yaml + mode, bytes_of("P2\n# five by two\n5 2\n255\n0 254 205 254 0\n0 254 9 1 255\n")));
  result.push_back(input_of(yaml, bytes_of("P5\n3 2\n255\nabcdef")));
  result.push_back(input_of(yaml, bytes_of("P5 3 2 65535 aabbccddeeff")));
  constexpr std::uint32_t kFormats[] = {PNG_FORMAT_GRAY, PNG_FORMAT_GA, PNG_FORMAT_RGB, PNG_FORMAT_RGBA,
                                        PNG_FORMAT_RGB_COLORMAP};
  for (const std::uint32_t format : kFormats) result.push_back(input_of(yaml, png_image_of(format)));
  for (const auto& file : files_in("deploy/scenarios/maps", ".png"))
    result.push_back(input_of(yaml, file_content(file)));
  return result;
}

}  // namespace sidestep::fuzz
