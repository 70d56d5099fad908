// SPDX-License-Identifier: Apache-2.0
#include "common/marking/colours.hpp"

namespace sidestep {

std::optional<Colour> colour_named(std::string_view name) {
  for (const NamedColour& entry : kColours)
    if (entry.name == name) return entry.colour;
  return std::nullopt;
}

}  // namespace sidestep
