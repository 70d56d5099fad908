// SPDX-License-Identifier: Apache-2.0
#include "common/config/shared_rules.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/config/obstacle_list.hpp"
#include "idl/rules.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxKeyLength = 64;
constexpr std::size_t kMaxRules = 64;
// Longer lists of obstacles are replaced by their number and fingerprint.
constexpr std::size_t kMaxListedObstacles = 16;
constexpr std::size_t kMaxShownLength = 80;

/// FNV-1a with 64 bits. It detects mistakes but does not protect against forgery.
std::uint64_t hash(std::string_view text) {
  std::uint64_t result = 0xcbf29ce484222325;
  for (const char c : text) result = (result ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return result;
}

/// The robot numbers, with consecutive ones as a range, for example "0-3, 8".
std::string numbers_of(const FloorSpec& floor, Team team) {
  std::string text;
  const auto& robots = floor.robots;
  const auto is_in_run = [&](std::size_t i, RobotId id) {
    return i < robots.size() && robots[i].team == team && robots[i].id == id;
  };
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (robots[i].team != team) continue;
    const RobotId first = robots[i].id;
    RobotId last = first;
    while (is_in_run(i + 1, last + 1)) {
      ++i;
      ++last;
    }
    text += (text.empty() ? "" : ", ") + std::to_string(first);
    if (last > first) text += "-" + std::to_string(last);
  }
  return text.empty() ? "none" : text;
}

std::string obstacles_of(const FloorSpec& floor) {
  std::string text;
  for (const Shape& obstacle : floor.obstacles) {
    if (!text.empty()) text += "; ";
    text += obstacle_text(obstacle);
  }
  if (floor.obstacles.size() > kMaxListedObstacles)
    return fmt::format("{} with fingerprint {:016x}", floor.obstacles.size(), hash(text));
  return text.empty() ? "none" : text;
}

std::string laser_text(const LaserSpec& laser) {
  return fmt::format("{} beams, {} rad, {}-{} m, error {} m, people {} m", laser.settings.beams,
                     laser.settings.field_of_view_rad, laser.settings.min_range_m, laser.settings.max_range_m,
                     laser.range_error_m, laser.person_radius_m);
}

bool is_printable(char c) { return c >= ' ' && c <= '~'; }

std::string shown(const std::string& value) {
  if (value.empty()) return "unknown";
  return value.size() <= kMaxShownLength ? value : value.substr(0, kMaxShownLength) + "...";
}

}  // namespace

SharedRules::SharedRules(const FloorSpec& floor) {
  const auto add = [this](const char* key, double value) {
    rules_.push_back({key, fmt::format("{}", value)});
  };
  rules_.push_back({"robots.blue", numbers_of(floor, Team::kBlue)});
  rules_.push_back({"robots.yellow", numbers_of(floor, Team::kYellow)});
  add("field.length_m", floor.field.length_m);
  add("field.width_m", floor.field.width_m);
  rules_.push_back({"obstacles", obstacles_of(floor)});
  if (floor.map) rules_.push_back({"map", fmt::format("fingerprint {:016x}", floor.map->fingerprint())});
  add("limits.acceleration_mps2", floor.limits.acceleration_mps2);
  add("limits.deceleration_mps2", floor.limits.deceleration_mps2);
  add("limits.speed_mps", floor.limits.speed_mps);
  add("radius_m", floor.radius_m);
  add("margin_m", floor.margin_m);
  add("tracking_bound_m", floor.tracking_bound_m);
  add("clock_bound_s", floor.clock_bound_s);
  add("max_opponent_speed_mps", floor.max_opponent_speed_mps);
  if (floor.laser) rules_.push_back({"laser", laser_text(*floor.laser)});
  finish();
}

std::optional<SharedRules> SharedRules::parse(std::string_view text) {
  SharedRules rules;
  if (text.size() > msg::MAX_RULES_TEXT) return std::nullopt;
  while (!text.empty()) {
    const std::size_t end = text.find('\n'), colon = text.find(": ");
    if (end == text.npos || colon > end || colon == 0 || colon > kMaxKeyLength) return std::nullopt;
    const Rule rule{std::string(text.substr(0, colon)), std::string(text.substr(colon + 2, end - colon - 2))};
    const bool is_valid = std::ranges::all_of(text.substr(0, end), is_printable) && !rule.value.empty() &&
                          !rules.find(rule.key) && rules.rules_.size() < kMaxRules;
    if (!is_valid) return std::nullopt;
    rules.rules_.push_back(rule);
    text.remove_prefix(end + 1);
  }
  rules.finish();
  return rules;
}

void SharedRules::finish() {
  for (const Rule& rule : rules_) text_ += rule.key + ": " + rule.value + "\n";
  fingerprint_ = std::max<Fingerprint>(hash(text_), 1);
}

const SharedRules::Rule* SharedRules::find(const std::string& key) const {
  const auto found = std::ranges::find(rules_, key, &Rule::key);
  return found == rules_.end() ? nullptr : &*found;
}

std::vector<RuleDifference> SharedRules::differences(const SharedRules& others) const {
  std::vector<RuleDifference> result;
  for (const Rule& own : rules_) {
    const Rule* other = others.find(own.key);
    if (!other || other->value != own.value)
      result.push_back({own.key, own.value, other ? other->value : ""});
  }
  for (const Rule& other : others.rules_) {
    if (!find(other.key)) result.push_back({other.key, "", other.value});
  }
  return result;
}

std::string describe(const std::vector<RuleDifference>& differences) {
  std::string text;
  for (const RuleDifference& rule : differences) {
    text += fmt::format("{}{} is {} instead of {}", text.empty() ? "" : ", ", rule.key, shown(rule.others),
                        shown(rule.own));
  }
  return text;
}

}  // namespace sidestep
