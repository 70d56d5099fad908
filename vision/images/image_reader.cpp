// SPDX-License-Identifier: Apache-2.0
#include "vision/images/image_reader.hpp"

#include "vision/tracking/frame.hpp"

namespace sidestep {
namespace {

constexpr double kMaxWorldAge_s = 0.25;  // maximum age of poses that are extrapolated

std::optional<PixelFormat> format_of(msg::ImageFormat format) {
  switch (format) {
    case msg::ImageFormat::IMAGE_YUV422:
      return PixelFormat::kYuv422;
    case msg::ImageFormat::IMAGE_RGB:
      return PixelFormat::kRgb;
  }
  return std::nullopt;
}

}  // namespace

DetectorSettings detector_settings(const Scenario& scenario, const std::vector<ColourBox>& boxes,
                                   const MarkerLayout& layout) {
  DetectorSettings settings;
  settings.boxes = boxes;
  settings.layout = layout;
  for (const RobotSpec& robot : scenario.robots)
    settings.roster.push_back({robot.id, robot.team, pattern_of(layout, robot.id)});
  settings.robot_radius_m = scenario.radius_m;
  settings.known_obstacles = scenario.obstacles;
  settings.known_map = scenario.map;
  return settings;
}

std::optional<ImageView> view_of(const msg::CameraImage& message, const CameraModel& camera) {
  const auto format = format_of(message.image_format());
  const CameraParameters& size = camera.parameters();
  if (!format || message.width_px() != static_cast<std::uint32_t>(size.width_px) ||
      message.height_px() != static_cast<std::uint32_t>(size.height_px))
    return std::nullopt;
  const ImageView view{*format, size.width_px, size.height_px, message.pixels().data()};
  return message.pixels().size() == view.bytes() ? std::optional(view) : std::nullopt;
}

ImageReader::ImageReader(const Scenario& scenario, std::vector<CameraModel> cameras,
                         const ColourThresholds& colours, const MarkerLayout& layout)
    : cameras_(std::move(cameras)),
      format_(colours.format),
      max_lead_(max_vision_lead(max_clock_difference(scenario.clock_bound_s))) {
  const DetectorSettings settings = detector_settings(scenario, colours.boxes, layout);
  for (const CameraModel& camera : cameras_) detectors_.emplace_back(camera, settings);
}

bool ImageReader::read(const msg::CameraImage& message, Time now, const msg::WorldState& world,
                       msg::DetectionFrame& frame) {
  if (message.camera() >= cameras_.size() || !is_timely(message.captured_at_ns(), now, max_lead_))
    return false;
  const auto view = view_of(message, cameras_[message.camera()]);
  if (!view || view->format != format_) return false;
  const Time captured_at = time_from_ns(message.captured_at_ns());
  const double elapsed_s = to_seconds(captured_at - time_from_ns(world.valid_at_ns()));
  expected_.clear();
  if (std::abs(elapsed_s) <= kMaxWorldAge_s) {
    for (const msg::TrackedRobot& robot : world.robots()) {
      const Vec2 position_m(robot.x_m() + elapsed_s * robot.vx_mps(),
                            robot.y_m() + elapsed_s * robot.vy_mps());
      expected_.push_back(
          {robot.robot(),
           {position_m, wrapped_rad(robot.heading_rad() + elapsed_s * robot.angular_radps())}});
    }
  }
  frame.camera(message.camera());
  detectors_[message.camera()].detect(*view, captured_at, expected_, frame);
  return true;
}

}  // namespace sidestep
