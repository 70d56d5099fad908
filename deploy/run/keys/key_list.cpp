// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/keys/key_list.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/process/command_line.hpp"

namespace sidestep {
namespace {

bool takes_argument(const std::string& word) {
  return word == "agent" || word == "coordinator" || word == "robot" || word == "client";
}

/// The identities in a range such as "agent 0-21", or a single identity.
std::vector<Identity> split(const std::string& text) {
  if (const auto identity = parse_identity(text)) return {*identity};
  // parse_identity() accepts only ranges of robots, so other ranges are parsed as ranges of robots.
  const auto space = text.find(' ');
  const std::string word = text.substr(0, space);
  const bool has_range = space != std::string::npos && (word == "agent" || word == "coordinator");
  const auto range = has_range ? parse_identity("robot" + text.substr(space)) : std::nullopt;
  std::vector<Identity> result;
  for (std::uint32_t i = range ? range->first : 1; range && i <= range->last; ++i) {
    const auto identity = parse_identity(word + " " + std::to_string(i));
    if (!identity) break;
    result.push_back(*identity);
  }
  if (!range || result.size() != range->last - range->first + 1)
    throw UsageError(fmt::format("expected {}, got '{}'", expected_identity(text), text));
  return result;
}

}  // namespace

std::vector<Identity> parse_key_list(const std::vector<std::string>& words) {
  std::vector<Identity> result;
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::string text = words[i];
    if (takes_argument(text) && i + 1 < words.size()) text += " " + words[++i];
    const std::vector<Identity> identities = split(text);
    result.insert(result.end(), identities.begin(), identities.end());
  }
  return result;
}

std::vector<Identity> identities_of(const Scenario& scenario) {
  std::vector<Identity> result{
      {Role::kSimulator}, {Role::kVision}, {Role::kJudge}, {Role::kViewer}, {Role::kOperator}};
  for (int number = 0; number < scenario.coordinators; ++number)
    result.push_back(
        {Role::kCoordinator, static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number)});
  for (const RobotSpec& robot : scenario.robots) result.push_back({Role::kAgent, robot.id, robot.id});
  const auto [first, last] = std::ranges::minmax(scenario.robots, {}, &RobotSpec::id);
  result.push_back({Role::kRobot, first.id, last.id});
  return result;
}

}  // namespace sidestep
