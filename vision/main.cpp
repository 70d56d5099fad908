// SPDX-License-Identifier: Apache-2.0
#include "common/log/log.hpp"
#include "common/process/process.hpp"
#include "common/protocol/senders.hpp"
#include "vision/calibrate/calibrate_command.hpp"
#include "vision/images/image_arguments.hpp"
#include "vision/league/log_commands.hpp"
#include "vision/view/view_command.hpp"
#include "vision/vision_service.hpp"

int main(int argc, char** argv) {
  using namespace sidestep;
  VisionOptions options;
  Program program;
  program.name = "sidestep-vision";
  program.description = "Fuses the cameras' detections into one tracked world.";
  program.add_options = [&options](const CliCommand& app) {
    add_league_options(app, options);
    add_image_options(app, options.images);
  };
  program.add_commands = [](const CliCommand& app, std::function<int()>& action) {
    add_view_command(app, action);
    add_calibrate_command(app, action);
    add_log_commands(app, action);
  };
  program.process = [] { return static_cast<std::uint32_t>(Sender::kVision); };
  program.start = [&options](DdsBus& bus, const Scenario& scenario, Incarnation incarnation) -> RunningNodes {
    auto service = std::make_shared<VisionService>(bus, scenario, incarnation, options);
    log_events_of(*service);
    return {service, {}};
  };
  return run_process(argc, argv, program);
}
