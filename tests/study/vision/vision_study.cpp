// SPDX-License-Identifier: Apache-2.0
#include "tests/study/vision/vision_study.hpp"

#include "tests/study/vision/frame_times.hpp"
#include "tests/study/vision/marker_errors.hpp"
#include "tests/study/vision/recognition.hpp"

namespace sidestep {
namespace {

struct VisionSizes {
  Recognition recognition;
  MarkerErrors errors;
  FrameTimes times;
};
VisionSizes quick_vision_sizes() {
  return {{.frames = 100}, {.frames = 20, .noises = {2, 6}}, {.rounds = 100}};
}

}  // namespace

int study_vision(const StudyOptions& options) {
  require_study_output(options);
  const VisionSizes sizes = options.is_quick ? quick_vision_sizes() : VisionSizes{};
  const auto run = [&](const std::string& name, const auto& experiment, const auto& settings) {
    const StudyTable table = experiment(settings, options.seed, StudyProgress(name));
    write_study_table(table, "vision", options);
    fmt::print("{}\n", markdown_of(table));
  };
  run("recognition", recognition, sizes.recognition);
  run("marker errors", marker_errors, sizes.errors);
  run("frame times", frame_times, sizes.times);
  return 0;
}

}  // namespace sidestep
