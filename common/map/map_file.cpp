// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_file.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>

#include "common/file/home_folder.hpp"
#include "common/file/write_file.hpp"
#include "common/map/map_image.hpp"
#include "common/yaml/yaml_document.hpp"
#include "common/yaml/yaml_map.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpectedMap = "a map";
/// A probability that is within this distance of its threshold counts as unknown, because the brightness is
/// rounded.
constexpr double kThresholdTolerance = 1e-9;
/// Map savers write unknown cells as 205 of 255, which some values of free_thresh would make free.
constexpr double kUnknownGrey = 50.0 / 255;
/// Maximum yaw that is ignored: it moves no corner of a map by more than a millimetre.
constexpr double kMaxIgnoredYaw_rad = 1e-6;
constexpr char kBlockedPixel = 0, kFreePixel = static_cast<char>(254);

/// Decides from a pixel's brightness whether its cell is free.
struct Interpretation {
  enum class Mode { kTrinary, kScale, kRaw };
  Mode mode = Mode::kTrinary;
  bool is_negated = false;
  double occupied_above = 0, free_below = 0;

  /// The modes trinary and scale differ only for the grey of unknown cells.
  MapCellState state(double brightness) const {
    double occupied = is_negated ? brightness : 1 - brightness;
    if (mode == Mode::kTrinary && std::abs(occupied - kUnknownGrey) < kThresholdTolerance)
      return MapCellState::kUnknown;
    if (mode == Mode::kRaw) occupied = std::round(255 * brightness) / 100;
    if (mode == Mode::kRaw && occupied > 1) return MapCellState::kUnknown;
    if (occupied > occupied_above) return MapCellState::kOccupied;
    return occupied < free_below - kThresholdTolerance ? MapCellState::kFree : MapCellState::kUnknown;
  }
};

double required_number(YamlMap& map, const std::string& key, Range range) {
  return number_from(map.require(key), map.location_of(key), range);
}

Interpretation::Mode read_mode(YamlMap& map) {
  const YAML::Node node = map.find("mode");
  if (!node.IsDefined()) return Interpretation::Mode::kTrinary;
  const std::string name = text_from(node, map.location_of("mode"));
  if (name == "trinary") return Interpretation::Mode::kTrinary;
  if (name == "scale") return Interpretation::Mode::kScale;
  if (name == "raw") return Interpretation::Mode::kRaw;
  map.location_of("mode").fail("expected trinary, scale or raw, got \"" + name.substr(0, 40) + "\"");
}

/// Accepts 0 or 1, or a truth value in any of YAML's forms.
bool read_negate(YamlMap& map) {
  const YAML::Node node = map.require("negate");
  bool value = false;
  if (node.IsScalar() && YAML::convert<bool>::decode(node, value)) return value;
  const double number = number_from(node, map.location_of("negate"), {0, 1});
  if (number != 0 && number != 1) map.location_of("negate").fail("expected 0 or 1, or false or true");
  return number == 1;
}

Interpretation read_interpretation(YamlMap& map) {
  Interpretation result;
  result.mode = read_mode(map);
  result.is_negated = read_negate(map);
  result.occupied_above = required_number(map, "occupied_thresh", {0, 1});
  result.free_below = required_number(map, "free_thresh", {0, 1});
  if (result.free_below > result.occupied_above)
    map.location_of("free_thresh").fail("expected at most occupied_thresh");
  return result;
}

/// The origin along the axes of the map's rows and columns.
Vec2 read_origin(YamlMap& map, double& yaw_rad) {
  const YamlLocation location = map.location_of("origin");
  const std::vector<double> origin =
      numbers_from(map.require("origin"), location, 3, 3, {-kMaxMapOrigin_m, kMaxMapOrigin_m});
  yaw_rad = std::abs(origin[2]) < kMaxIgnoredYaw_rad ? 0 : origin[2];
  return rotated(Vec2(origin[0], origin[1]), -yaw_rad);
}

ImageCells read_image(YamlMap& map, const std::string& path, const Interpretation& interpretation,
                      UnknownCells unknown) {
  const YamlLocation location = map.location_of("image");
  const std::string name = text_from(map.require("image"), location);
  if (name.empty()) location.fail("expected the path of an image, got nothing");
  const std::string image = (std::filesystem::path(path).parent_path() / expand_home(name)).string();
  try {
    return read_map_image(
        image, [&](double brightness) { return interpretation.state(brightness); }, unknown);
  } catch (const ImageError& error) {
    location.fail(fmt::format("{}: {}", image, error.what()));
  }
}

}  // namespace

LoadedMap load_map(const std::string& path, UnknownCells unknown) {
  YamlMap map = document_map(read_yaml_file(path, kExpectedMap), path, kExpectedMap);
  MapGrid grid;
  grid.resolution_m = required_number(map, "resolution", {kMinResolution_m, kMaxResolution_m});
  double yaw_rad = 0;
  grid.origin_m = read_origin(map, yaw_rad);
  const Interpretation interpretation = read_interpretation(map);
  (void)map.find("image");
  map.finish();
  ImageCells cells = read_image(map, path, interpretation, unknown);
  grid.columns = cells.blocked.columns();
  grid.rows = cells.blocked.rows();
  return {OccupancyMap(grid, std::move(cells.blocked)), cells.unknown, yaw_rad};
}

MapFiles map_files(const OccupancyMap& map, const std::string& image_name) {
  const MapGrid& grid = map.grid();
  MapFiles files;
  files.image = fmt::format("P5\n{} {}\n255\n", grid.columns, grid.rows);
  files.image.reserve(files.image.size() +
                      static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
  for (int row = grid.rows - 1; row >= 0; --row)
    for (int column = 0; column < grid.columns; ++column)
      files.image += map.blocked().get(column, row) ? kBlockedPixel : kFreePixel;
  YAML::Emitter name;
  name << YAML::DoubleQuoted << image_name;
  // Numbers are written so that load_map() reads back exactly the same values.
  files.yaml = fmt::format(
      "image: {}\nresolution: {}\norigin: [{}, {}, 0]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
      name.c_str(), grid.resolution_m, grid.origin_m.x(), grid.origin_m.y());
  return files;
}

void write_occupancy_map(const OccupancyMap& map, const std::string& path) {
  const MapFiles files = map_files(map, std::filesystem::path(path).filename().string() + ".pgm");
  write_file(path + ".pgm", files.image);
  write_file(path + ".yaml", files.yaml);
}

}  // namespace sidestep
