// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/plan/expectation_reader.hpp"

#include <fmt/format.h>

#include "deploy/trial/simulate/system/system_processes.hpp"
#include "deploy/trial/test/plan/plan_names.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxExpectations = 1000;
constexpr Range kClearance_m{0, 1};
constexpr Range kSpeed_mps{0, 20};

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

  double number(Range range) { return number_from(map_.require(key_), map_.location_of(key_), range); }

  std::optional<double> optional_moment(const char* key) {
    if (!map_.find(key).IsDefined()) return std::nullopt;
    return moment_from(map_, key, scenario_);
  }

  void require_true() {
    bool value = false;
    map_.read(key_, value);
    if (!value) map_.location_of(key_).fail("expected true");
  }

  ExpectNoContact read_no_contact() {
    ExpectNoContact check{robots(), {}};
    if (map_.find("except").IsDefined()) check.except = robots_from(map_, "except", scenario_);
    return check;
  }

  ExpectAtRest read_rest() {
    ExpectAtRest check{robots(), span(), 0};
    map_.read("for_s", {0, scenario_.time_limit_s}, check.for_s);
    return check;
  }

  ExpectMaxSpeed read_max_speed() {
    ExpectMaxSpeed check;
    check.speed_mps = number(kSpeed_mps);
    check.robots = {roster_of(scenario_), true};
    if (map_.find("robots").IsDefined()) check.robots = robots_from(map_, "robots", scenario_);
    check.from_s = optional_moment("from_s").value_or(0);
    check.to_s = optional_moment("to_s");
    if (check.to_s && *check.to_s <= check.from_s) map_.location_of("to_s").fail("expected more than from_s");
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
    std::vector<std::string> given;
    for (const char* key : {"within_s", "within_ms", "by_s"}) {
      if (map_.find(key).IsDefined()) given.emplace_back(key);
    }
    if (given.size() != 1) map_.location().fail("expected one of the keys within_s, within_ms and by_s");
    const double time = number_from(map_.require(given[0]), map_.location_of(given[0]), {0, 86'400'000});
    span.to_s = given[0] == "by_s" ? time : span.from_s + (given[0] == "within_s" ? time : time * 1e-3);
    if (span.to_s <= span.from_s)
      map_.location_of(given[0]).fail(fmt::format("expected a time after {:g} s", span.from_s));
    return span;
  }

  /// Reads the start of a span, which by default is the time of the first fault.
  double start_s() {
    const auto after_s = optional_moment("after_s");
    const YAML::Node fault = map_.find("after_fault");
    if (!fault.IsDefined()) return after_s.value_or(faults_.empty() ? 0 : faults_.front().at_s);
    const YamlLocation location = map_.location_of("after_fault");
    if (after_s) location.fail("cannot be combined with after_s");
    if (faults_.empty()) location.fail("the scenario has no faults");
    const Range indices{0, static_cast<double>(faults_.size() - 1)};
    return faults_[static_cast<std::size_t>(integer_from(fault, location, indices))].at_s;
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
  read_list(map, "expect", kMaxExpectations, [&](YamlMap& inner) {
    expectations.push_back(ExpectationReader(inner, scenario, faults).read());
  });
  return expectations;
}

}  // namespace sidestep
