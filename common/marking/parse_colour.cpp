// SPDX-License-Identifier: Apache-2.0
#include "common/marking/parse_colour.hpp"

#include <fmt/format.h>

namespace sidestep {

Colour parse_colour(const YAML::Node& node, const YamlLocation& location) {
  const std::string name = text_from(node, location);
  if (const auto colour = colour_named(name)) return *colour;
  std::string names;
  for (const NamedColour& colour : kColours) names += (names.empty() ? "" : ", ") + std::string(colour.name);
  location.fail(fmt::format("expected one of {}, got \"{}\"", names, name.substr(0, 40)));
}

}  // namespace sidestep
