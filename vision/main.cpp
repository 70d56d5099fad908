// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "common/log/log.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "common/protocol/senders.hpp"
#include "vision/calibrate/calibrate_command.hpp"
#include "vision/images/image_arguments.hpp"
#include "vision/league/log_commands.hpp"
#include "vision/view/view_command.hpp"
#include "vision/vision_service.hpp"

namespace sidestep {
namespace {

int run_service(int argc, char** argv) {
  VisionOptions options;
  Program program;
  program.name = "sidestep-vision";
  program.description = "Fuses the cameras' detections into one tracked world.";
  program.add_options = [&options](const CliCommand& app) {
    add_league_options(app, options);
    add_image_options(app, options.images);
    app.add_footer(
        "Commands, each with --help: sidestep-vision view, calibrate SCENARIO FRAME..., calibrate --geometry "
        "POINTS, replay FILE, record FILE.");
  };
  program.process = [] { return static_cast<std::uint32_t>(Sender::kVision); };
  program.start = [&options](DdsBus& bus, const Scenario& scenario, Incarnation incarnation) -> RunningNodes {
    auto service = std::make_shared<VisionService>(bus, scenario, incarnation, options);
    log_events_of(*service);
    return {service, {}};
  };
  return run_process(argc, argv, program);
}

}  // namespace
}  // namespace sidestep

int main(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "replay") return sidestep::replay_command(argc - 1, argv + 1);
  if (command == "view") return sidestep::view_command(argc - 1, argv + 1);
  if (command == "calibrate") return sidestep::calibrate_command(argc - 1, argv + 1);
  if (command == "record") return sidestep::record_command(argc - 1, argv + 1);
  return sidestep::run_service(argc, argv);
}
