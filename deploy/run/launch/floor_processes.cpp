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

/// The value of an option that is given as `NAME VALUE` or `NAME=VALUE`; nullopt if it is not given.
std::optional<std::string> value_of(const std::string& name, const std::vector<std::string>& arguments) {
  for (auto word = arguments.begin(); word != arguments.end(); ++word) {
    if (word->starts_with(name + "=")) return word->substr(name.size() + 1);
    if (*word == name) return std::next(word) == arguments.end() ? "" : *std::next(word);
  }
  return std::nullopt;
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> values;
  std::istringstream stream(text);
  for (std::string value; std::getline(stream, value, ',');) values.push_back(value);
  return values;
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
  if (options.driver != "league") return {"vision", "sidestep-vision", arguments};
  // Options of the user come in addition to these, or replace them one by one.
  const auto source = value_of("--source", arguments);
  if (source.value_or("ssl") == "ssl" && !value_of("--ssl-vision", arguments))
    arguments.insert(arguments.begin(), {"--ssl-vision", league::kSimulatedVisionEndpoint});
  if (!source) arguments.insert(arguments.begin(), {"--source", "ssl"});
  return {"vision", "sidestep-vision", arguments};
}

PlaceOptions place_options_of(const FloorOptions& options) {
  const std::vector<std::string> vision = vision_process(options).arguments;
  PlaceOptions placing;
  placing.control = options.placing_control.value();
  if (const auto group = value_of("--ssl-vision", vision)) placing.vision = *group;
  placing.interfaces = split_list(value_of("--league-interface", vision).value_or(""));
  placing.senders = split_list(value_of("--league-sender", vision).value_or(""));
  return placing;
}

std::vector<std::string> driver_names() { return {"league", "velocity", "skeleton"}; }

}  // namespace sidestep
