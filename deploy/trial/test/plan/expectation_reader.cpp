// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/plan/expectation_reader.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/yaml/yaml_schema.hpp"
#include "deploy/trial/simulate/system/system_processes.hpp"
#include "deploy/trial/test/plan/plan_names.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxExpectations = 1000;
constexpr Range kClearance_m{0, 1};
constexpr Range kSpeed_mps{0, 20};
// Ground truth is sent sixty times a second, so a shorter span may have no sample of it.
constexpr double kMinSpan_s = 0.02;

/// Throws ConfigError, with the location of its end, if the span is too short.
void require_long_enough(const TimeSpan& span, const YamlLocation& end) {
  constexpr double kRounding_s = 1e-9;
  if (span.to_s - span.from_s >= kMinSpan_s - kRounding_s) return;
  end.fail(fmt::format("the span from {:g} s to {:g} s is too short: expected at least {:g} s", span.from_s,
                       span.to_s, kMinSpan_s));
}

/// Reads one expectation.
class ExpectationReader {
 public:
  ExpectationReader(YamlMap& map, const Scenario& scenario, const std::vector<PlannedFault>& faults)
      : map_(map), scenario_(scenario), faults_(faults) {}

  Expectation read() {
    key_ = only_key_of(map_,
                       {"no_contact", "no_violations", "arrived", "not_arrived", "at_rest", "moving",
                        "min_clearance_m", "max_speed_mps", "takeover", "named", "mismatch"},
                       "an expectation");
    const Expectation expectation{read_check(), map_.location().line};
    if (const auto deadline = deadline_s(expectation); deadline && *deadline > scenario_.time_limit_s) {
      map_.location().fail(
          fmt::format("{:g} s is after the time limit of {:g} s", *deadline, scenario_.time_limit_s));
    }
    return expectation;
  }

 private:
  ExpectationCheck read_check() {
    if (key_ == "no_contact") return read_no_contact();
    if (key_ == "no_violations") {
      require_true();
      return ExpectNoViolations{};
    }
    if (key_ == "arrived") return ExpectArrived{robots(), optional_moment("by_s")};
    if (key_ == "not_arrived") return ExpectNotArrived{robots()};
    if (key_ == "at_rest") return read_rest();
    if (key_ == "moving") return ExpectMoving{robots(), span()};
    if (key_ == "min_clearance_m") return ExpectMinClearance{number(kClearance_m)};
    if (key_ == "max_speed_mps") return read_max_speed();
    if (key_ == "takeover") {
      require_true();
      return ExpectTakeover{span()};
    }
    if (key_ == "named") return ExpectNamed{robots(), read_notice_kind(), span()};
    return ExpectMismatch{process_from(map_, key_, system_process_names(scenario_))};
  }

  RobotSet robots() { return robots_from(map_, key_, scenario_); }

  double number(Range range) {
    (void)map_.require(key_);
    return map_.number(key_, range).value_or(range.low);
  }

  std::optional<double> optional_moment(const char* key) {
    return map_.number(key, {0, scenario_.time_limit_s});
  }

  void require_true() {
    if (YamlSchema* const schema = map_.schema()) return schema->add(key_, {{"const", true}});
    bool value = false;
    map_.read(key_, value);
    if (!value) map_.location_of(key_).fail("expected true");
  }

  ExpectNoContact read_no_contact() {
    return {robots(), find_robots(map_, "except", scenario_).value_or(RobotSet{})};
  }

  ExpectAtRest read_rest() {
    ExpectAtRest check{robots(), span(), 0};
    map_.read("for_s", {0, scenario_.time_limit_s}, check.for_s);
    return check;
  }

  ExpectMaxSpeed read_max_speed() {
    ExpectMaxSpeed check;
    check.speed_mps = number(kSpeed_mps);
    check.robots = find_robots(map_, "robots", scenario_).value_or(RobotSet{roster_of(scenario_), true});
    check.from_s = optional_moment("from_s").value_or(0);
    check.to_s = optional_moment("to_s");
    if (check.to_s) require_long_enough({check.from_s, *check.to_s}, map_.location_of("to_s"));
    return check;
  }

  NoticeKind read_notice_kind() {
    const std::string name =
        process_from(map_, "as", {"missing", "quarantined", "displaced", "conflict", "clock_out_of_bound"});
    return *notice_kind_named(name);
  }

  /// Reads a span from a time or a fault until a deadline.
  TimeSpan span() {
    TimeSpan span;
    span.from_s = start_s();
    const std::string key = deadline_key();
    const double time = map_.number(key, {0, 86'400'000}).value_or(0);
    if (map_.schema()) return span;
    span.to_s = key == "by_s" ? time : span.from_s + (key == "within_s" ? time : time * 1e-3);
    require_long_enough(span, map_.location_of(key));
    return span;
  }

  std::string deadline_key() {
    const std::vector<std::string> keys{"within_s", "within_ms", "by_s"};
    if (YamlSchema* const schema = map_.schema()) return schema->choose(keys);
    std::vector<std::string> given;
    for (const std::string& key : keys) {
      if (map_.find(key).IsDefined()) given.push_back(key);
    }
    if (given.size() != 1) map_.location().fail("expected one of the keys within_s, within_ms and by_s");
    return given.front();
  }

  /// Reads the start of a span, which by default is the time of the first fault.
  double start_s() {
    const auto after_s = optional_moment("after_s");
    if (faults_.empty() && map_.find("after_fault").IsDefined())
      map_.location_of("after_fault").fail("the scenario has no faults");
    const auto fault = map_.integer("after_fault", {0, static_cast<double>(faults_.size()) - 1});
    if (!fault) return after_s.value_or(faults_.empty() ? 0 : faults_.front().at_s);
    if (after_s) map_.location_of("after_fault").fail("cannot be combined with after_s");
    return faults_[static_cast<std::size_t>(*fault)].at_s;
  }

  YamlMap& map_;
  const Scenario& scenario_;
  const std::vector<PlannedFault>& faults_;
  std::string key_;
};

}  // namespace

std::vector<Expectation> read_expectations(YamlMap& map, const Scenario& scenario,
                                           const std::vector<PlannedFault>& faults) {
  std::vector<Expectation> expectations;
  read_optional_list(map, "expect", 1, kMaxExpectations, [&](YamlMap& inner) {
    expectations.push_back(ExpectationReader(inner, scenario, faults).read());
  });
  return expectations;
}

}  // namespace sidestep
