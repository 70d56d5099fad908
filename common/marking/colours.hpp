// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "common/image/colour_space.hpp"

namespace sidestep {

/// The named colours.
enum class Colour : std::uint8_t {
  kField,  ///< the field surface
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
  Rgb rgb;  ///< colour as seen by a white-balanced camera in full light
};

/// All named colours, indexed by Colour.
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

/// nullopt for an unknown name.
[[nodiscard]] std::optional<Colour> colour_named(std::string_view name);

}  // namespace sidestep
