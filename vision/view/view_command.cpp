// SPDX-License-Identifier: Apache-2.0
#include "vision/view/view_command.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/core.h>
#include <stdexcept>

#include "common/config/scenario_loader.hpp"
#include "common/image/picture.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "vision/images/image_options.hpp"
#include "vision/view/annotation.hpp"

namespace sidestep {
namespace {

struct ViewOptions {
  std::string scenario_file, folder;
  ImageOptions images;
  DdsSettings dds;
  int count = 1;
  double every_s = 0.5;
  double wait_s = 10;
  bool is_plain = false;
};

/// Writes pictures of the images that come.
class Viewer {
 public:
  Viewer(DdsBus& bus, const Scenario& scenario, const ViewOptions& options)
      : bus_(bus),
        scenario_(scenario),
        options_(options),
        reader_(image_reader(scenario, options.images)),
        taken_(reader_.cameras().size()) {
    bus_.subscribe<msg::WorldState>(topics::kWorld, [this](const msg::WorldState& world) { world_ = world; });
    bus_.subscribe<msg::CameraImage>(topics::kImages, [this](const msg::CameraImage& image) { take(image); });
  }

  bool is_done() const {
    return std::ranges::all_of(taken_, [this](const Taken& one) { return one.count >= options_.count; });
  }

 private:
  struct Taken {
    int count = 0;
    Time at{};
  };

  void take(const msg::CameraImage& image) {
    if (!reader_.read(image, bus_.now(), world_, seen_)) return;
    Taken& taken = taken_[image.camera()];
    const Time captured_at = time_from_ns(image.captured_at_ns());
    if (taken.count >= options_.count || captured_at - taken.at < from_seconds(options_.every_s)) return;
    taken = {taken.count + 1, captured_at};
    const CameraModel& camera = reader_.cameras()[image.camera()];
    cv::Mat3b picture = bgr_of(view_of(image, camera).value());
    FloorPen pen(picture, camera);
    if (!options_.is_plain) draw_detections(seen_, scenario_, pen);
    const std::string file =
        fmt::format("{}/camera-{}-{:04}.png", options_.folder, image.camera(), taken.count);
    write_png(picture, file);
    fmt::print("{}: {} robots, {} balls, {} obstacles\n", file, seen_.robots().size(), seen_.ball_count(),
               seen_.obstacle_count());
    std::fflush(stdout);
    if (is_done()) bus_.stop();
  }

  DdsBus& bus_;
  const Scenario& scenario_;
  const ViewOptions& options_;
  ImageReader reader_;
  std::vector<Taken> taken_;  ///< of each camera
  msg::WorldState world_;
  msg::DetectionFrame seen_;
};

int view(const ViewOptions& options) {
  const Scenario scenario = load_scenario(options.scenario_file);
  if (!scenario.vision.images) {
    throw std::invalid_argument(options.scenario_file +
                                ": its cameras send no images, expected the key vision.images");
  }
  std::filesystem::create_directories(options.folder);
  DdsBus bus(options.dds);
  const StopSignals stop_signals([&bus] { bus.stop(); });
  const Viewer viewer(bus, scenario, options);
  bus.run_until(bus.now() +
                from_seconds(options.wait_s + options.every_s * static_cast<double>(options.count)));
  if (viewer.is_done()) return 0;
  fmt::print(stderr, "sidestep-vision view: not from every camera images came that can be read\n");
  return kExitFailure;
}

}  // namespace

int view_command(int argc, char** argv) {
  CLI::App app("Writes pictures of a running system's images, with what is seen in them.",
               "sidestep-vision view");
  ViewOptions options;
  options.dds.participant = "sidestep-view";
  app.add_option("--scenario", options.scenario_file, "scenario file")->required();
  app.add_option("--out", options.folder, "folder for the pictures")->required();
  app.add_option("--count", options.count, "pictures of each camera")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--every-s", options.every_s, "seconds between two of one camera, at least")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.add_option("--wait-s", options.wait_s, "for so long for images")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  app.add_flag("--plain", options.is_plain, "draw nothing on them, for sidestep-vision calibrate");
  add_image_options(app, options.images);
  add_dds_options(app, options.dds);
  const int exit_code = parse_options(app, argc, argv);
  if (exit_code >= 0) return exit_code;
  return guarded("sidestep-vision view", [&] { return view(options); });
}

}  // namespace sidestep
