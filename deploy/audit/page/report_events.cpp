// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/page/report_events.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "deploy/audit/metrics/reported_values.hpp"
#include "deploy/audit/picture/run_picture.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

/// The element with this key, or null if there is none.
const Json& part(const Json& json, const char* key) {
  static const Json kNull;
  const auto found = json.find(key);
  return found == json.end() ? kNull : *found;
}

/// Collects events of one report.
class Collector {
 public:
  explicit Collector(const Json& report)
      : report_(report), end_s_(reported_number(part(report, "robot_time_s"))) {}

  std::vector<ReportEvent> events() {
    if (part(report_, "grants") != 0) add(0.0, false, "a coordinator grants: robots may move");
    add_epochs();
    for (const auto& [robot, at] : part(report_, "arrival_s").items())
      if (const auto at_s = reported_number(at)) add(at_s, false, fmt::format("robot {} arrived", robot));
    add_incidents();
    add_deaths();
    add_violations();
    for (const auto& [robot, why] : part(report_, "not_arrived").items())
      add(end_s_, true, fmt::format("robot {} has not arrived: {}", robot, why.get<std::string>()));
    add(end_s_, part(report_, "passed") != true, "end: " + run_outcome(report_));
    add_without_time();
    const auto key = [](const ReportEvent& event) {
      return event.at_s.value_or(std::numeric_limits<double>::infinity());
    };
    std::ranges::stable_sort(events_, {}, key);
    return std::move(events_);
  }

 private:
  void add(std::optional<double> at_s, bool is_bad, std::string text) {
    events_.push_back({at_s, is_bad, std::move(text)});
  }
  void add_epochs() {
    for (const Json& epoch : part(report_, "epochs"))
      add(reported_number(epoch.at("at_s")), false,
          fmt::format("{} began epoch {}: {}", epoch.at("coordinator").get<std::string>(),
                      json_text(epoch.at("epoch")), epoch.at("reason").get<std::string>()));
  }
  void add_incidents() {
    for (const Json& incident : part(report_, "incidents")) {
      std::vector<std::string> robots;
      for (const Json& robot : incident.at("robots")) robots.push_back(json_text(robot));
      add(reported_number(incident.at("at_s")), true,
          fmt::format("{}: robot{} {}", incident.at("kind").get<std::string>(), robots.size() == 1 ? "" : "s",
                      fmt::join(robots, " and ")));
    }
  }
  void add_deaths() {
    for (const Json& death : part(report_, "deaths"))
      add(reported_number(death.at("at_s")), death.at("restarted") != true,
          fmt::format("{} died: {}{}", death.at("process").get<std::string>(),
                      death.at("reason").get<std::string>(),
                      death.at("restarted") == true ? "; it was started again" : ""));
  }
  void add_violations() {
    const Json& audit = part(report_, "audit");
    if (!audit.is_object()) return;
    for (const Json& violation : audit.at("first"))
      add(reported_number(part(violation, "at_s")), true,
          fmt::format("the rule {} was broken: robot {} version {}: {}",
                      violation.at("rule").get<std::string>(), json_text(violation.at("robot")),
                      json_text(violation.at("version")), violation.at("detail").get<std::string>()));
  }
  void add_without_time() {
    for (const Json& reason : part(report_, "director_deaths"))
      add(std::nullopt, true, "the process that directed the run died: " + reason.get<std::string>());
    for (const Json& robot : part(report_, "quarantined"))
      add(std::nullopt, true,
          fmt::format("robot {} was quarantined: it executed a version that it was never granted",
                      json_text(robot)));
    for (const Json& robot : part(report_, "displaced"))
      add(std::nullopt, true,
          fmt::format("robot {} was displaced: vision saw it where none of its versions led",
                      json_text(robot)));
    for (const Json& pair : part(report_, "conflicts"))
      add(std::nullopt, true,
          fmt::format("a cause outside the protocol brought robots {} and {} into conflict",
                      json_text(pair.at(0)), json_text(pair.at(1))));
    for (const auto& [process, rules] : part(report_, "mismatches").items()) {
      std::vector<std::string> keys;
      for (const auto& [key, values] : rules.items()) keys.push_back(key);
      add(std::nullopt, true,
          fmt::format("{} was refused because it has different rules{}{}", process, keys.empty() ? "" : ": ",
                      fmt::join(keys, ", ")));
    }
  }

  const Json& report_;
  std::optional<double> end_s_;
  std::vector<ReportEvent> events_;
};

}  // namespace

std::vector<ReportEvent> events_of(const Json& report) { return Collector(report).events(); }

}  // namespace sidestep
