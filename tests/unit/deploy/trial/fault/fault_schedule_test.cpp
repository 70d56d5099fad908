// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/fault_schedule.hpp"

#include "tests/catch.hpp"

namespace sidestep::fault_schedule_test {

using namespace std::chrono_literals;

struct Effects {
  void begin(std::size_t fault) {
    if (fault == failing) throw std::runtime_error("it does not run");
    done.push_back("begin " + std::to_string(fault));
  }
  void end(std::size_t fault) { done.push_back("end " + std::to_string(fault)); }

  std::size_t failing = 99;
  std::vector<std::string> done;
};

struct Fault {
  FaultSpan span() const { return times; }

  FaultSpan times;
  std::string text;
};

const std::vector<Fault> kFaults{
    {{3s, std::nullopt}, "kill agent 1"}, {{1s, 3500ms}, "pause vision"}, {{3s, 3250ms}, "pause simulator"}};

TEST_CASE("faults begin and end at their times, and simultaneous faults follow the file's order") {
  const Time zero = time_from_ns(5'000'000'000);
  FaultSchedule schedule(kFaults, zero);
  Effects effects;
  CHECK(schedule.next() == zero + 1s);
  schedule.apply_due(zero + 999ms, effects);
  CHECK(effects.done.empty());
  schedule.apply_due(zero + 1s, effects);
  CHECK(effects.done == std::vector<std::string>{"begin 1"});
  CHECK(schedule.next() == zero + 3s);
  schedule.apply_due(zero + 10s, effects);
  CHECK(effects.done == std::vector<std::string>{"begin 1", "begin 0", "begin 2", "end 2", "end 1"});
  CHECK(schedule.next() == Time::max());
  CHECK(schedule.problems().empty());
}

TEST_CASE("a fault that cannot be applied is recorded with its time, and the other faults continue") {
  FaultSchedule schedule(kFaults, Time{});
  Effects effects;
  effects.failing = 0;
  schedule.apply_due(Time{10s}, effects);
  REQUIRE(schedule.problems().size() == 1);
  CHECK(schedule.problems()[0].at_s == 3);
  CHECK(schedule.problems()[0].text == "kill agent 1: it does not run");
  CHECK(effects.done.size() == 4);
}

}  // namespace sidestep::fault_schedule_test
