// SPDX-License-Identifier: Apache-2.0
#include "common/marking/layout_file.hpp"

#include <fmt/format.h>

#include "common/marking/parse_colour.hpp"
#include "common/yaml/yaml_document.hpp"
#include "common/yaml/yaml_map.hpp"

namespace sidestep {
namespace {

using Part = LayoutError::Part;

constexpr const char* kExpected = "a marker layout";
constexpr Range kCoordinate_m{-1, 1};
constexpr Range kRadius_m{0.001, 0.5};

Marker read_dot(YamlMap& map) {
  Marker dot;
  map.require("radius_m");
  map.read("radius_m", kRadius_m, dot.radius_m);
  map.read("position_m", kCoordinate_m, dot.position_m);
  return dot;
}

/// The locations of the elements of a list.
using Locations = std::vector<YamlLocation>;

void read_centre(YamlMap& map, MarkerLayout& layout) {
  YamlMap centre(map.require("centre"), map.location_of("centre"));
  layout.centre = read_dot(centre);
  layout.blue_team = parse_colour(centre.require("blue"), centre.location_of("blue"));
  layout.yellow_team = parse_colour(centre.require("yellow"), centre.location_of("yellow"));
  centre.finish();
}

Locations read_dots(YamlMap& map, MarkerLayout& layout) {
  Locations locations;
  read_list(map, "dots", kMaxDots, [&](YamlMap& dot) {
    locations.push_back(dot.location());
    dot.require("position_m");
    layout.dots.push_back(read_dot(dot));
  });
  return locations;
}

Locations read_patterns(YamlMap& map, MarkerLayout& layout) {
  Locations locations;
  read_list(map, "patterns", kMaxPatterns, [&](YamlMap& inner) {
    locations.push_back(inner.location());
    MarkerPattern pattern;
    pattern.id = static_cast<std::uint32_t>(
        integer_from(inner.require("id"), inner.location_of("id"), {0, kMaxRobots - 1.0}));
    const YamlLocation colours = inner.location_of("colours");
    for (const YAML::Node& colour : list_from(inner.require("colours"), colours, kMaxDots))
      pattern.colours.push_back(parse_colour(colour, colours.of(colour, colours.what)));
    layout.patterns.push_back(pattern);
  });
  return locations;
}

}  // namespace

MarkerLayout parse_layout(const std::string& text, const std::string& file_name) {
  YamlMap map = document_map(text, file_name, kExpected);
  MarkerLayout layout;
  layout.name = text_from(map.require("name"), map.location_of("name"));
  read_centre(map, layout);
  const Locations dots = read_dots(map, layout);
  const Locations patterns = read_patterns(map, layout);
  map.finish();
  if (const auto error = validation_error(layout)) {
    const Locations& locations = error->part == Part::kDots ? dots : patterns;
    const char* const list = error->part == Part::kCentre ? "centre"
                             : error->part == Part::kDots ? "dots"
                                                          : "patterns";
    const bool has_location = error->part != Part::kCentre && error->index < locations.size();
    (has_location ? locations[error->index] : map.location_of(list)).fail(error->why);
  }
  return layout;
}

MarkerLayout load_layout(const std::string& path) {
  return parse_layout(read_yaml_file(path, kExpected), path);
}

}  // namespace sidestep
