// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "common/image/colour_space.hpp"

namespace sidestep {

/// The colours that have a name on the floor.
enum class Colour : std::uint8_t {
  kField,  ///< the carpet
  kWhite,
  kBlack,
  kOrange,
  kYellow,
  kBlue,
  kGreen,
  kPink,
  kRed,
  kCyan,
  kPurple,
};

struct NamedColour {
  Colour colour;
  std::string_view name;
  Rgb rgb;  ///< as a camera sees it in full light, its white balance right
};

/// All of them, each at its number.
inline constexpr std::array<NamedColour, 11> kColours{{
    {Colour::kField, "field", {38, 98, 46}},
    {Colour::kWhite, "white", {228, 230, 226}},
    {Colour::kBlack, "black", {22, 22, 24}},
    {Colour::kOrange, "orange", {244, 118, 30}},
    {Colour::kYellow, "yellow", {238, 206, 42}},
    {Colour::kBlue, "blue", {30, 86, 204}},
    {Colour::kGreen, "green", {74, 224, 84}},
    {Colour::kPink, "pink", {238, 66, 166}},
    {Colour::kRed, "red", {206, 28, 34}},
    {Colour::kCyan, "cyan", {62, 214, 226}},
    {Colour::kPurple, "purple", {112, 48, 168}},
}};

constexpr const NamedColour& named(Colour colour) { return kColours[static_cast<std::size_t>(colour)]; }

/// Nothing for a name that is none of theirs.
std::optional<Colour> colour_named(std::string_view name);

}  // namespace sidestep
