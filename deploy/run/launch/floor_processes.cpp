// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/floor_processes.hpp"

#include <iterator>
#include <sstream>

#include "common/league/multicast.hpp"

namespace sidestep {
namespace {

std::vector<std::string> split_words(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

}  // namespace

FloorProcess robots_process(const FloorOptions& options) {
  if (options.driver.empty()) {
    std::vector<std::string> arguments = split_words(options.simulator);
    arguments.insert(arguments.begin(), {"--seed", std::to_string(options.seed)});
    return {"simulator", "sidestep-simulator", arguments};
  }
  std::vector<std::string> arguments = split_words(options.robots);
  arguments.insert(arguments.begin(), {"--driver", options.driver, "--memory", options.memory_folder});
  return {"robots", "sidestep-robot", arguments};
}

FloorProcess vision_process(const FloorOptions& options) {
  std::vector<std::string> arguments = split_words(options.vision);
  if (options.driver == "league" && arguments.empty())
    arguments = {"--source", "ssl", "--ssl-vision", league::kSimulatedVisionEndpoint};
  return {"vision", "sidestep-vision", arguments};
}

std::vector<std::string> driver_names() { return {"league", "velocity", "skeleton"}; }

}  // namespace sidestep
