// SPDX-License-Identifier: Apache-2.0
#include "common/marking/butterfly.hpp"

#include <array>
#include <string_view>

namespace sidestep {
namespace {

/// The colours of the dots for the ids 0 to 15, P for pink and G for green, in the order front left, front
/// right, rear left, rear right.
constexpr std::array<std::string_view, 16> kIds{"PPGP", "GPGP", "GGGP", "PGGP", "PPPG", "GPPG",
                                                "GGPG", "PGPG", "GGGG", "PPPP", "PPGG", "GGPP",
                                                "GPGG", "GPPP", "PGGG", "PGPP"};

MarkerLayout make_butterfly() {
  MarkerLayout layout;
  layout.name = "butterfly";
  layout.centre.radius_m = 0.025;
  for (const Vec2& position_m :
       {Vec2(0.035, 0.054772), Vec2(0.035, -0.054772), Vec2(-0.054772, 0.035), Vec2(-0.054772, -0.035)})
    layout.dots.push_back({position_m, 0.02});
  for (const std::string_view letters : kIds) {
    MarkerPattern pattern{static_cast<std::uint32_t>(layout.patterns.size()), {}};
    for (const char letter : letters)
      pattern.colours.push_back(letter == 'P' ? Colour::kPink : Colour::kGreen);
    layout.patterns.push_back(pattern);
  }
  return layout;
}

}  // namespace

const MarkerLayout& butterfly() {
  static const MarkerLayout layout = make_butterfly();
  return layout;
}

}  // namespace sidestep
