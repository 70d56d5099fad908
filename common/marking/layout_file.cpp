// SPDX-License-Identifier: Apache-2.0
#include "common/marking/layout_file.hpp"

#include <fmt/format.h>

#include "common/config/yaml_document.hpp"
#include "common/config/yaml_map.hpp"
#include "common/marking/colour_from.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpected = "a layout of markings";
constexpr Range kPlace_m{-1, 1};
constexpr Range kRadius_m{0.001, 0.5};

MarkingDot read_dot(YamlMap& map) {
  MarkingDot dot;
  map.require("radius_m");
  map.read("radius_m", kRadius_m, dot.radius_m);
  map.read("position_m", kPlace_m, dot.position_m);
  return dot;
}

/// Where the elements of a list stand.
using Places = std::vector<YamlPlace>;

void read_centre(YamlMap& map, MarkingLayout& layout) {
  YamlMap centre(map.require("centre"), map.place_of("centre"));
  layout.centre = read_dot(centre);
  layout.blue_team = colour_from(centre.require("blue"), centre.place_of("blue"));
  layout.yellow_team = colour_from(centre.require("yellow"), centre.place_of("yellow"));
  centre.finish();
}

Places read_dots(YamlMap& map, MarkingLayout& layout) {
  Places places;
  read_list(map, "dots", kMaxDots, [&](YamlMap& dot) {
    places.push_back(dot.place());
    dot.require("position_m");
    layout.dots.push_back(read_dot(dot));
  });
  return places;
}

Places read_patterns(YamlMap& map, MarkingLayout& layout) {
  Places places;
  read_list(map, "patterns", kMaxPatterns, [&](YamlMap& inner) {
    places.push_back(inner.place());
    MarkingPattern pattern;
    pattern.id = static_cast<std::uint32_t>(
        integer_from(inner.require("id"), inner.place_of("id"), {0, kMaxRobots - 1.0}));
    const YamlPlace colours = inner.place_of("colours");
    for (const YAML::Node& colour : list_from(inner.require("colours"), colours, kMaxDots))
      pattern.colours.push_back(colour_from(colour, colours.of(colour, colours.what)));
    layout.patterns.push_back(pattern);
  });
  return places;
}

}  // namespace

MarkingLayout parse_layout(const std::string& text, const std::string& file_name) {
  YamlMap map = document_map(text, file_name, kExpected);
  MarkingLayout layout;
  layout.name = text_from(map.require("name"), map.place_of("name"));
  read_centre(map, layout);
  const Places dots = read_dots(map, layout);
  const Places patterns = read_patterns(map, layout);
  map.finish();
  if (const auto fault = fault_of(layout)) {
    using Part = LayoutFault::Part;
    const Places& places = fault->part == Part::kDots ? dots : patterns;
    const char* const list = fault->part == Part::kCentre ? "centre"
                             : fault->part == Part::kDots ? "dots"
                                                          : "patterns";
    const bool has_place = fault->part != Part::kCentre && fault->index < places.size();
    (has_place ? places[fault->index] : map.place_of(list)).refuse(fault->why);
  }
  return layout;
}

MarkingLayout load_layout(const std::string& path) {
  return parse_layout(read_yaml_file(path, kExpected), path);
}

}  // namespace sidestep
