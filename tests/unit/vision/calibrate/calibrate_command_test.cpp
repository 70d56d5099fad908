// SPDX-License-Identifier: Apache-2.0
#include "vision/calibrate/calibrate_command.hpp"

#include <filesystem>
#include <unistd.h>

#include "common/file/write_file.hpp"
#include "common/image/picture.hpp"
#include "common/process/process.hpp"
#include "tests/catch.hpp"
#include "tests/unit/vision/calibrate/calibrate_run.hpp"
#include "tests/unit/vision/calibrate/rendered_start.hpp"
#include "vision/cameras/camera_file.hpp"
#include "vision/colours/colour_file.hpp"

namespace sidestep::calibrate_command_test {

using namespace sidestep::test;

const std::string kCrossing = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";

struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("calibrate-" + std::to_string(getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
};

void save_start(const std::string& scenario_file, std::size_t camera, const std::string& path) {
  const Scenario scenario = load_scenario(scenario_file);
  RenderSpec spec;
  spec.format = PixelFormat::kRgb;
  write_png(bgr_of(rendered_start(scenario, camera_grid(scenario)[camera], spec, 1).view()), path);
}

/// Number of robots found in frames of the scenario's cameras with the thresholds of a file.
std::size_t found(const std::string& scenario_file, const std::string& colours_file) {
  const Scenario scenario = load_scenario(scenario_file);
  const ColourThresholds colours = load_colours(colours_file);
  RenderSpec spec;
  spec.format = colours.format;
  std::size_t sum = 0;
  for (const CameraModel& camera : camera_grid(scenario)) {
    Detector detector(camera, settings_of(scenario, colours.boxes));
    msg::DetectionFrame frame;
    detector.detect(rendered_start(scenario, camera, spec, 2).view(), {}, {}, frame);
    sum += found_at_start(scenario, frame);
  }
  return sum;
}

TEST_CASE("thresholds learned from one picture of the start find all robots") {
  const Folder folder;
  save_start(kFloorFile, 0, folder / "frame.png");
  const std::string format = GENERATE("yuv422", "rgb");
  REQUIRE(calibrate({kFloorFile, folder / "frame.png", "--format", format, "--out", folder / "c.yaml"}) == 0);
  CHECK(name_of(load_colours(folder / "c.yaml").format) == format);
  CHECK(found(kFloorFile, folder / "c.yaml") == 6);
}

TEST_CASE("pictures of several cameras give one file of thresholds") {
  const Folder folder;
  save_start(kCrossing, 0, folder / "left.png");
  save_start(kCrossing, 1, folder / "right.png");
  REQUIRE(calibrate({kCrossing, folder / "left.png", folder / "right.png", "--camera", "0,1", "--out",
                     folder / "c.yaml"}) == 0);
  CHECK(found(kCrossing, folder / "c.yaml") == load_scenario(kCrossing).robots.size());
}

TEST_CASE("cameras are read from a file if one is given") {
  const Folder folder;
  save_start(kFloorFile, 0, folder / "frame.png");
  CameraParameters camera = camera_grid(load_scenario(kFloorFile))[0].parameters();
  write_file(folder / "cameras.yaml", cameras_text({{3, camera}}));
  const std::vector<std::string> basic{kFloorFile, folder / "frame.png", "--cameras", folder / "cameras.yaml",
                                       "--out",    folder / "c.yaml"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), basic.begin(), basic.end());
    return calibrate(more);
  };
  CHECK(with({"--camera", "3"}) == 0);
  CHECK(found(kFloorFile, folder / "c.yaml") == 6);
  CHECK(with({"--camera", "0"}) == kExitUsage);
  camera.width_px = 640;
  write_file(folder / "cameras.yaml", cameras_text({{3, camera}}));
  CHECK(with({"--camera", "3"}) == kExitUsage);
}

TEST_CASE("invalid arguments and pictures are refused and nothing is written") {
  const Folder folder;
  save_start(kFloorFile, 0, folder / "frame.png");
  save_start(kCrossing, 0, folder / "elsewhere.png");
  write_file(folder / "text.png", "no picture\n");
  write_file(folder / "absent.yaml",
             "robots: [{id: 0, absent: true, team: blue, start_m: [0, 0], goals_m: [[1, 0]]}]\n");
  const std::string out = folder / "c.yaml";
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--out", out});
    const int exit_code = calibrate(arguments);
    CHECK_FALSE(std::filesystem::exists(out));
    return exit_code;
  };
  CHECK(run({kFloorFile}) == kExitUsage);
  CHECK(run({folder / "none.yaml", folder / "frame.png"}) == kExitUsage);
  CHECK(run({kFloorFile, folder / "none.png"}) == kExitUsage);
  CHECK(run({kFloorFile, folder / "text.png"}) == kExitUsage);
  CHECK(run({kFloorFile, folder / "frame.png", "--camera", "1"}) == kExitUsage);
  CHECK(run({kFloorFile, folder / "frame.png", "--camera", "0,0"}) == kExitUsage);
  CHECK(run({kFloorFile, folder / "frame.png", "--format", "bgr"}) == kExitUsage);
  CHECK(run({folder / "absent.yaml", folder / "frame.png"}) == kExitUsage);
  CHECK(run({kFloorFile, folder / "elsewhere.png"}) == kExitFailure);
  CHECK(calibrate({kFloorFile, folder / "frame.png", "--out", folder / "frame.png/c.yaml"}) == kExitFailure);
}

}  // namespace sidestep::calibrate_command_test
