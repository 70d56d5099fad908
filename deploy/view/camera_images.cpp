// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/camera_images.hpp"

#include <opencv2/imgproc.hpp>

#include "common/camera/camera_grid.hpp"
#include "common/image/picture.hpp"
#include "vision/detection/detector.hpp"
#include "vision/images/image_reader.hpp"

namespace sidestep {
namespace {

/// Images are received until this long after the last request.
constexpr Duration kPatience = std::chrono::seconds(5);

}  // namespace

CameraImages::CameraImages(const Scenario& scenario, const DdsSettings& dds) : dds_(dds) {
  dds_.participant += "-images";
  if (!scenario.vision.images) return;
  for (const CameraModel& model : camera_grid(scenario)) cameras_.push_back({model, std::nullopt});
}

void CameraImages::poll(Time now) {
  if (!bus_) return;
  if (now - asked_at_ <= kPatience) return bus_->run_until(bus_->now());
  bus_.reset();
  for (Camera& camera : cameras_) camera.image.reset();
}

std::optional<std::string> CameraImages::jpeg(std::size_t camera, const FloorState& floor, Time now) {
  if (camera >= cameras_.size()) return std::nullopt;
  asked_at_ = now;
  if (!bus_) {
    bus_ = std::make_unique<DdsBus>(dds_);
    bus_->observe<msg::CameraImage>(topics::kImages, 0, [this](const msg::CameraImage& image) {
      if (image.camera() < cameras_.size()) cameras_[image.camera()].image = image;
    });
  }
  const Camera& shown = cameras_[camera];
  if (!shown.image) return std::nullopt;
  const std::optional<ImageView> pixels = view_of(*shown.image, shown.model);
  if (!pixels) return std::nullopt;
  cv::Mat3b picture = bgr_of(*pixels);
  for (const auto& [id, robot] : floor.robots()) {
    const msg::TrackedRobot* seen = fresh(robot.seen, now);
    if (seen == nullptr) continue;
    const auto pixel = shown.model.pixel_of({seen->x_m(), seen->y_m(), kRobotHeight_m});
    if (!pixel || !shown.model.is_in_image(*pixel)) continue;
    const cv::Point centre(static_cast<int>(pixel->x()), static_cast<int>(pixel->y()));
    cv::drawMarker(picture, centre, {255, 255, 255}, cv::MARKER_CROSS, 14, 2);
    cv::putText(picture, std::to_string(id), centre + cv::Point(8, -8), cv::FONT_HERSHEY_SIMPLEX, 0.5,
                {255, 255, 255}, 1, cv::LINE_AA);
  }
  return jpeg_of(picture);
}

}  // namespace sidestep
