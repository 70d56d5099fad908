// SPDX-License-Identifier: Apache-2.0
#include "common/svg/svg.hpp"

#include <fmt/format.h>

#include "common/file/xml_text.hpp"

namespace sidestep {

std::string svg_points(std::span<const Vec2> points_px) {
  std::string text;
  for (const Vec2& p : points_px) text += fmt::format("{:.1f},{:.1f} ", p.x(), p.y());
  return text;
}

std::string svg_path_data(std::span<const Vec2> points_px) {
  std::string text;
  for (const Vec2& p : points_px)
    text += fmt::format("{}{:.1f} {:.1f}", text.empty() ? 'M' : 'L', p.x(), p.y());
  return text;
}

std::string svg_circle(const Vec2& centre_px, double radius_px, std::string_view attributes) {
  return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{:.1f}' {}/>\n", centre_px.x(), centre_px.y(),
                     radius_px, attributes);
}

std::string svg_text(const Vec2& at_px, std::string_view text, std::string_view attributes) {
  return fmt::format("<text x='{:.1f}' y='{:.1f}'{}{}>{}</text>\n", at_px.x(), at_px.y(),
                     attributes.empty() ? "" : " ", attributes, xml_escaped(text));
}

std::string svg_ring_data(const Vec2& centre_px, double radius_px) {
  return fmt::format("M{0:.1f} {1:.1f}a{2:.1f} {2:.1f} 0 1 0 {3:.1f} 0a{2:.1f} {2:.1f} 0 1 0 -{3:.1f} 0z",
                     centre_px.x() - radius_px, centre_px.y(), radius_px, 2 * radius_px);
}

std::string svg_arrow_data(const Vec2& centre_px, const Vec2& direction, double size_px) {
  const Vec2 along = direction.normalized() * size_px, across(-along.y(), along.x());
  const Vec2 tip = centre_px + along, left = centre_px - 0.7 * along + 0.8 * across,
             right = centre_px - 0.7 * along - 0.8 * across;
  return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}z", tip.x(), tip.y(), left.x(), left.y(),
                     right.x(), right.y());
}

std::string svg_document(double width_px, double height_px, std::string_view content) {
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {:.0f} {:.0f}' font-family='sans-serif' "
      "font-size='13' fill='#1f2328'>\n<rect width='100%' height='100%' fill='#ffffff'/>\n{}</svg>\n",
      width_px, height_px, content);
}

double text_width_px(std::string_view text, double font_px) {
  // Bytes that continue a character have no width of their own.
  std::size_t characters = 0;
  for (const char c : text) characters += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  return 0.58 * font_px * static_cast<double>(characters);
}

}  // namespace sidestep
