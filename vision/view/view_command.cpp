// SPDX-License-Identifier: Apache-2.0
#include "vision/view/view_command.hpp"

#include <algorithm>
#include <csignal>
#include <fmt/format.h>
#include <memory>
#include <stdexcept>

#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/file/folder.hpp"
#include "common/image/picture.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "vision/images/image_arguments.hpp"
#include "vision/view/annotation.hpp"

namespace sidestep {
namespace {

struct ViewOptions {
  std::string scenario_file, folder;
  ImageOptions images;
  DdsSettings dds;
  int count = 1;
  double period_s = 0.5;
  double timeout_s = 10;
  bool is_plain = false;
};

/// Writes annotated pictures of received images.
class Viewer {
 public:
  Viewer(DdsBus& bus, const Scenario& scenario, const ViewOptions& options)
      : bus_(bus),
        scenario_(scenario),
        options_(options),
        reader_(image_reader(scenario, options.images)),
        progress_(reader_.cameras().size()) {
    bus_.subscribe<msg::WorldState>(topics::kWorld, [this](const msg::WorldState& world) { world_ = world; });
    bus_.subscribe<msg::CameraImage>(topics::kImages,
                                     [this](const msg::CameraImage& image) { handle(image); });
  }

  bool is_done() const {
    return std::ranges::all_of(progress_,
                               [this](const Progress& one) { return one.count >= options_.count; });
  }
  /// What write_text() returned for the first line that could not be printed; 0: none.
  int output_error() const { return output_error_; }

 private:
  /// The state of writing one camera's pictures.
  struct Progress {
    int count = 0;
    Time last_captured_at{};
  };

  void handle(const msg::CameraImage& image) {
    if (!reader_.read(image, bus_.now(), world_, detections_)) return;
    Progress& progress = progress_[image.camera()];
    const Time captured_at = time_from_ns(image.captured_at_ns());
    if (progress.count >= options_.count ||
        captured_at - progress.last_captured_at < from_seconds(options_.period_s))
      return;
    progress = {progress.count + 1, captured_at};
    const CameraModel& camera = reader_.cameras()[image.camera()];
    cv::Mat3b picture = bgr_of(view_of(image, camera).value());
    FloorPen pen(picture, camera);
    if (!options_.is_plain) draw_detections(detections_, scenario_, pen);
    const std::string file =
        fmt::format("{}/camera-{}-{:04}.png", options_.folder, image.camera(), progress.count);
    write_png(picture, file);
    const int error = write_text(
        stdout, fmt::format("{}: {} robots, {} balls, {} obstacles\n", file, detections_.robots().size(),
                            detections_.ball_count(), detections_.obstacle_count()));
    if (output_error_ == 0) output_error_ = error;
    if (is_done()) bus_.stop();
  }

  DdsBus& bus_;
  const Scenario& scenario_;
  const ViewOptions& options_;
  ImageReader reader_;
  std::vector<Progress> progress_;  ///< indexed by camera
  msg::WorldState world_;
  msg::DetectionFrame detections_;
  int output_error_ = 0;
};

int view(const ViewOptions& options) {
  // The pictures are written even if the reader of the output disappears.
  std::signal(SIGPIPE, SIG_IGN);
  const Scenario scenario = load_scenario(options.scenario_file);
  if (!scenario.vision.images) {
    throw std::invalid_argument(options.scenario_file +
                                ": expected the key vision.images: its cameras send no images");
  }
  create_folder(options.folder);
  DdsBus bus(options.dds);
  const StopSignals stop_signals([&bus] { bus.stop(); });
  const Viewer viewer(bus, scenario, options);
  bus.run_until(bus.now() +
                from_seconds(options.timeout_s + options.period_s * static_cast<double>(options.count)));
  require_printed(viewer.output_error());
  if (viewer.is_done()) return 0;
  fmt::print(stderr, "sidestep-vision view: some cameras sent no valid images, or too few\n");
  return kExitFailure;
}

}  // namespace

void add_view_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<ViewOptions>();
  options->dds.participant = "sidestep-view";
  const CliCommand command = root.add_subcommand(
      "view", "Writes pictures of a running system's images, annotated with the detections");
  command.add_option("--scenario", options->scenario_file, "scenario file").required();
  command.add_option("--out", options->folder, "folder for the pictures").required();
  command.add_option("--count", options->count, "pictures per camera")
      .check(in_range(1, 100000))
      .show_default();
  command.add_option("--period-s", options->period_s, "minimum time between two pictures of one camera")
      .check(in_range(0.0, 3600.0))
      .show_default();
  command
      .add_option("--timeout-s", options->timeout_s,
                  "time to wait for images, in addition to the pictures' period")
      .check(in_range(0.1, 86400.0))
      .show_default();
  command.add_flag("--plain", options->is_plain,
                   "write pictures without annotation, for sidestep-vision calibrate");
  add_image_options(command, options->images);
  add_dds_options(command, options->dds);
  command.on_parsed([options, &action] { action = [options] { return view(*options); }; });
}

}  // namespace sidestep
