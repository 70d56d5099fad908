// SPDX-License-Identifier: Apache-2.0
#include "common/map/laser_scanner.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "common/collision/time_of_impact.hpp"

namespace sidestep {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kMaxBeams = 100'000;
constexpr double kMinFieldOfView_rad = 1e-3;
/// Widens the angles that a shape covers, so that rounding excludes no beam.
constexpr double kAngleSlack_rad = 1e-9;
/// A shape nearer than this covers all angles, because the angles of its corners are unreliable.
constexpr double kTouching_m = 1e-9;

const LaserSettings& checked(const LaserSettings& settings) {
  const auto fail = [](const std::string& why) { throw std::invalid_argument("a laser scanner: " + why); };
  if (settings.beams < 1 || settings.beams > kMaxBeams)
    fail(fmt::format("{} beams, expected 1 to {}", settings.beams, kMaxBeams));
  if (!(settings.field_of_view_rad >= kMinFieldOfView_rad && settings.field_of_view_rad <= 2 * kPi))
    fail(fmt::format("a field of view of {} rad, expected {} to a full turn", settings.field_of_view_rad,
                     kMinFieldOfView_rad));
  if (!(settings.min_range_m >= 0 && settings.min_range_m < settings.max_range_m &&
        std::isfinite(settings.max_range_m)))
    fail(fmt::format("ranges from {} to {} m, expected 0 <= minimum < maximum", settings.min_range_m,
                     settings.max_range_m));
  return settings;
}

/// The interval of angles under which a shape is seen; half_width_rad = pi means all angles.
struct Bearings {
  double middle_rad, half_width_rad;
};

/// The bearings of a circle that does not contain the point.
Bearings bearings_of(const Vec2& at, const Circle& circle) {
  const Vec2 offset = circle.centre_m - at;
  return {std::atan2(offset.y(), offset.x()), std::asin(std::min(1.0, circle.radius_m / offset.norm()))};
}

/// The bearings of the convex hull of points, which does not contain `at`. They span at most half a turn.
Bearings bearings_of(const Vec2& at, std::span<const Vec2> corners_m) {
  const Vec2 first = corners_m.front() - at;
  double low_rad = 0, high_rad = 0;
  for (const Vec2& corner : corners_m.subspan(1)) {
    const Vec2 offset = corner - at;
    const double turn_rad = std::atan2(cross(first, offset), first.dot(offset));
    low_rad = std::min(low_rad, turn_rad);
    high_rad = std::max(high_rad, turn_rad);
  }
  return {std::atan2(first.y(), first.x()) + (low_rad + high_rad) / 2, (high_rad - low_rad) / 2};
}

Bearings bearings_of(const Vec2& at, const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape)) return bearings_of(at, *circle);
  if (const auto* box = std::get_if<Box>(&shape)) return bearings_of(at, corners_of(*box));
  if (const auto* segment = std::get_if<Segment>(&shape))
    return bearings_of(at, std::array{segment->from_m, segment->to_m});
  return bearings_of(at, std::get<ConvexPolygon>(shape).corners_m);
}

}  // namespace

struct LaserScanner::View {
  Vec2 at_m, heading;
  double heading_rad;
};

LaserScanner::LaserScanner(const LaserSettings& settings) : settings_(checked(settings)) {
  const bool is_full_turn = settings.field_of_view_rad > 2 * kPi - kAngleSlack_rad;
  const int gaps = is_full_turn ? settings.beams : std::max(1, settings.beams - 1);
  spacing_rad_ = settings.field_of_view_rad / gaps;
  first_rad_ = settings.beams == 1 ? 0 : -settings.field_of_view_rad / 2;
  for (int beam = 0; beam < settings.beams; ++beam)
    directions_.emplace_back(std::cos(beam_angle_rad(beam)), std::sin(beam_angle_rad(beam)));
}

Vec2 LaserScanner::direction(const View& view, int beam) const {
  const Vec2& relative = directions_[static_cast<std::size_t>(beam)];
  return view.heading.x() * relative + view.heading.y() * left_of(relative);
}

/// Calls `call(beam)` at least once for each beam within these angles, which are relative to the heading.
template <typename Call>
void LaserScanner::for_beams(double middle_rad, double half_width_rad, const Call& call) const {
  const double low_rad = wrapped_rad(middle_rad) - half_width_rad - kAngleSlack_rad;
  const double high_rad = wrapped_rad(middle_rad) + half_width_rad + kAngleSlack_rad;
  for (const double turn_rad : {-2 * kPi, 0.0, 2 * kPi}) {
    const double first = std::ceil((low_rad + turn_rad - first_rad_) / spacing_rad_);
    const double last = std::floor((high_rad + turn_rad - first_rad_) / spacing_rad_);
    if (last < 0 || first >= settings_.beams) continue;
    const int end = static_cast<int>(std::min(last, settings_.beams - 1.0)) + 1;
    for (int beam = static_cast<int>(std::max(first, 0.0)); beam < end; ++beam) call(beam);
  }
}

void LaserScanner::scan_shape(const Shape& shape, const View& view, std::span<float> ranges_m) const {
  const double distance_m = signed_distance(view.at_m, shape);
  if (distance_m > settings_.max_range_m) return;
  const Bearings bearings =
      distance_m > kTouching_m ? bearings_of(view.at_m, shape) : Bearings{view.heading_rad, kPi};
  for_beams(bearings.middle_rad - view.heading_rad, bearings.half_width_rad, [&](int beam) {
    float& range_m = ranges_m[static_cast<std::size_t>(beam)];
    if (range_m < distance_m) return;
    const Vec2 end = view.at_m + settings_.max_range_m * direction(view, beam);
    if (const std::optional<double> fraction = time_of_impact(Sweep(view.at_m, end, 0), shape))
      range_m = std::min(range_m, static_cast<float>(*fraction * settings_.max_range_m));
  });
}

void LaserScanner::scan(const RayScene& scene, const Vec2& at, double heading_rad,
                        std::span<float> ranges_m) const {
  if (!at.allFinite() || !std::isfinite(heading_rad))
    throw std::invalid_argument("the pose of a laser scanner is not finite");
  if (ranges_m.size() != directions_.size())
    throw std::invalid_argument(
        fmt::format("{} ranges for a laser scanner of {} beams", ranges_m.size(), directions_.size()));
  constexpr float kNoHit = std::numeric_limits<float>::infinity();
  const View view{at, rotated({1, 0}, heading_rad), heading_rad};
  std::ranges::fill(ranges_m, kNoHit);
  for (const Circle& disc : scene.discs) {
    check(disc);
    scan_shape(disc, view, ranges_m);
  }
  for (std::size_t i = 0; scene.shapes != nullptr && i < scene.shapes->size(); ++i)
    scan_shape(scene.shapes->shape(scene.shapes->obstacle(i)), view, ranges_m);
  for (int beam = 0; beam < settings_.beams; ++beam) {
    float& range_m = ranges_m[static_cast<std::size_t>(beam)];
    if (scene.map != nullptr) {
      const double limit_m = std::min(settings_.max_range_m, static_cast<double>(range_m));
      const double map_m = cast_ray(*scene.map, *scene.field, at, direction(view, beam), limit_m);
      range_m = std::min(range_m, static_cast<float>(map_m));
    }
    if (range_m < settings_.min_range_m) range_m = -kNoHit;
  }
}

}  // namespace sidestep
