// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "common/geometry/vec2.hpp"

namespace sidestep {

// Parts of SVG pictures, in pixels. SVG's y axis points down.

/// The points of a polyline or polygon, as "x,y x,y ".
[[nodiscard]] std::string svg_points(std::span<const Vec2> points_px);
/// The data of a path through the points, as "Mx yLx y"; empty if there are none.
[[nodiscard]] std::string svg_path_data(std::span<const Vec2> points_px);

[[nodiscard]] std::string svg_circle(const Vec2& centre_px, double radius_px, std::string_view attributes);
/// Text that is not escaped yet. `attributes` may be empty.
[[nodiscard]] std::string svg_text(const Vec2& at_px, std::string_view text, std::string_view attributes);

/// The outline of a circle as the data of a path, for symbols that share one element.
[[nodiscard]] std::string svg_ring_data(const Vec2& centre_px, double radius_px);
/// A triangle that points in a direction, as the data of a path. The direction need not have unit length.
[[nodiscard]] std::string svg_arrow_data(const Vec2& centre_px, const Vec2& direction, double size_px);

/// A document of this size in pixels. It fills the width that its viewer offers.
[[nodiscard]] std::string svg_document(double width_px, double height_px, std::string_view content);

/// The estimated width of a text in a proportional font.
[[nodiscard]] double text_width_px(std::string_view text, double font_px);

}  // namespace sidestep
