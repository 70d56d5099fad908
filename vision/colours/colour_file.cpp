// SPDX-License-Identifier: Apache-2.0
#include "vision/colours/colour_file.hpp"

#include <fmt/format.h>

#include "common/marking/parse_colour.hpp"
#include "common/yaml/yaml_document.hpp"
#include "common/yaml/yaml_map.hpp"
#include "vision/colours/colour_learner.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpected = "a file of colour thresholds";
constexpr Range kByte{0, 255};

PixelFormat format_from(const YAML::Node& node, const YamlLocation& location) {
  const std::string name = text_from(node, location);
  if (const auto format = pixel_format_named(name)) return *format;
  location.fail(fmt::format("expected yuv422 or rgb, got \"{}\"", name.substr(0, 40)));
}

Yuv yuv_from(const YAML::Node& node, const YamlLocation& location) {
  numbers_from(node, location, 3, 3, kByte);
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint8_t>(integer_from(node[i], location.of(node[i], location.what), kByte));
  };
  return {byte(0), byte(1), byte(2)};
}

std::uint32_t colour_number_from(const YAML::Node& node, const YamlLocation& location) {
  if (node.IsScalar() && node.Scalar() == name_of_colour(kOtherColour)) return kOtherColour;
  return static_cast<std::uint32_t>(parse_colour(node, location));
}

ColourBox read_box(YamlMap& map) {
  ColourBox box;
  box.colour = colour_number_from(map.require("colour"), map.location_of("colour"));
  box.low = yuv_from(map.require("low"), map.location_of("low"));
  box.high = yuv_from(map.require("high"), map.location_of("high"));
  if (box.low.y > box.high.y || box.low.u > box.high.u || box.low.v > box.high.v)
    map.location_of("low").fail("expected no component above that of high");
  return box;
}

}  // namespace

ColourThresholds parse_colours(const std::string& text, const std::string& file_name) {
  YamlMap map = document_map(text, file_name, kExpected);
  ColourThresholds thresholds;
  thresholds.format = format_from(map.require("format"), map.location_of("format"));
  read_list(map, "boxes", kMaxColours, [&](YamlMap& box) { thresholds.boxes.push_back(read_box(box)); });
  map.finish();
  return thresholds;
}

ColourThresholds load_colours(const std::string& path) {
  return parse_colours(read_yaml_file(path, kExpected), path);
}

std::string colours_text(const ColourThresholds& thresholds) {
  const auto numbers = [](const Yuv& yuv) { return fmt::format("[{}, {}, {}]", yuv.y, yuv.u, yuv.v); };
  std::string text = fmt::format("format: {}\nboxes:\n", name_of(thresholds.format));
  for (const ColourBox& box : thresholds.boxes) {
    text += fmt::format("  - {{colour: {}, low: {}, high: {}}}\n", name_of_colour(box.colour),
                        numbers(box.low), numbers(box.high));
  }
  return text;
}

}  // namespace sidestep
