// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "common/marking/butterfly.hpp"
#include "common/marking/layout_file.hpp"
#include "common/process/command_line.hpp"
#include "deploy/trial/camera/frame_command.hpp"
#include "deploy/trial/camera/pattern_command.hpp"
#include "tests/catch.hpp"

namespace sidestep::camera_commands_test {

const std::string kCrossing = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";

int run(const std::string& arguments) {
  CommandLine command_line("test", "test");
  const CliCommand app = command_line.root();
  std::function<int()> action;
  add_frame_command(app, action);
  add_pattern_command(app, action);
  std::istringstream words(arguments);
  command_line.parse({std::istream_iterator<std::string>(words), {}});
  return action();
}

struct PictureFile {
  std::string path =
      (std::filesystem::temp_directory_path() / ("frame-" + std::to_string(getpid()) + ".png")).string();
  ~PictureFile() { std::filesystem::remove(path); }
};

TEST_CASE("the image rendered for a scenario shows its robots at their start positions") {
  const PictureFile file;
  REQUIRE(run("frame " + kCrossing + " " + file.path) == 0);
  const cv::Mat3b bgr = cv::imread(file.path);
  REQUIRE(bgr.cols == 780);
  REQUIRE(bgr.rows == 580);
  // Camera 0 covers low x, where the four blue robots are; the test counts their centre dots.
  int blue = 0, yellow = 0, white = 0;
  for (const cv::Vec3b& c : bgr) {
    blue += c[0] > 130 && c[2] < 70 && c[1] < 110;
    yellow += c[2] > 180 && c[1] > 150 && c[0] < 90;
    white += c[0] > 170 && c[1] > 170 && c[2] > 170;
  }
  CHECK(blue > 100);
  CHECK(yellow < blue / 10);
  CHECK(white > 500);
}

TEST_CASE("the frame command accepts another camera and size") {
  const PictureFile file;
  REQUIRE(run("frame " + kCrossing + " " + file.path + " --camera 1 --width 320 --height 240") == 0);
  const cv::Mat3b bgr = cv::imread(file.path);
  CHECK(bgr.cols == 320);
  CHECK(bgr.rows == 240);
  const std::string square = " --layout " SIDESTEP_SOURCE_DIR "/deploy/scenarios/markings/square.yaml";
  CHECK(run("frame " + kCrossing + " " + file.path + square) == 0);
}

TEST_CASE("the frame command rejects invalid arguments and files") {
  const PictureFile file;
  CHECK(run("frame " + kCrossing + " " + file.path + " --camera 7") == 2);
  CHECK_THROWS_AS(run("frame " + kCrossing + " picture.gif"), UsageError);
  CHECK_THROWS_AS(run("frame " + kCrossing), UsageError);
  CHECK_THROWS_AS(run("frame nowhere.yaml " + file.path), ConfigError);
  CHECK_THROWS_AS(run("frame " + kCrossing + " " + file.path + " --layout " + kCrossing), ConfigError);
  CHECK_THROWS_AS(run("frame " + kCrossing + " /dev/null/frame.png"), std::runtime_error);
}

TEST_CASE("the pattern command prints the evaluation of a layout") {
  CHECK(describe_layout(butterfly(), 0.001) ==
        "butterfly: 4 dots and the centre, no rotational symmetry\n"
        "patterns: 16 of 16 possible with 2 colours; the most similar differ in 1 dot\n"
        "patterns with other numbers of colours: 2: 16, 3: 81, 4: 256, 5: 625, 6: 1296\n"
        "with 1 mm per axis and dot: position 0.447 mm longitudinal and 0.451 mm lateral, heading 0.445 "
        "degrees\n");
  const MarkerLayout square = load_layout(SIDESTEP_SOURCE_DIR "/deploy/scenarios/markings/square.yaml");
  CHECK(describe_layout(square, 0.002) ==
        "square: 4 dots and the centre, rotational symmetry by 90 degrees\n"
        "patterns: 8 of 60 possible with 4 colours; the most similar differ in 2 dots\n"
        "patterns with other numbers of colours: 2: 3, 3: 18, 4: 60, 5: 150, 6: 315\n"
        "with 2 mm per axis and dot: position 0.894 mm longitudinal and 0.894 mm lateral, heading 0.965 "
        "degrees\n");
  CHECK(run("pattern") == 0);
  CHECK_THROWS_AS(run("pattern " + kCrossing), ConfigError);
  CHECK_THROWS_AS(run("pattern --dot-mm -1"), UsageError);
}

}  // namespace sidestep::camera_commands_test
