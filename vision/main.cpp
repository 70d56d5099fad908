// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/senders.hpp"
#include "common/process/process.hpp"
#include "vision/vision_node.hpp"

int main(int argc, char** argv) {
  sidestep::Program program;
  program.name = "sidestep-vision";
  program.description = "Turns the cameras' detections into one tracked world.";
  program.fault_target = [] { return static_cast<std::uint32_t>(sidestep::Sender::kVision); };
  program.start = [](sidestep::Bus& bus, const sidestep::Scenario& scenario) {
    const auto incarnation = static_cast<sidestep::Incarnation>(sidestep::to_ns(bus.now()));
    return std::make_shared<sidestep::VisionNode>(bus, scenario, incarnation);
  };
  return sidestep::run_process(argc, argv, program);
}
