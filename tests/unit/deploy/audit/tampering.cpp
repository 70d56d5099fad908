// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/deploy/audit/tampering.hpp"

#include <map>

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep {

using namespace std::chrono_literals;

const MessageHistory& crossing() {
  static const MessageHistory history = [] {
    Scenario scenario = load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml");
    return history_of(scenario, 3, 4s);
  }();
  return history;
}

std::uint64_t count(const AuditTotals& totals, AuditRule rule) {
  return totals.by_rule[static_cast<std::size_t>(rule)];
}

Switch first_moving_switch(MessageHistory& history) {
  std::map<RobotId, std::vector<msg::Version>> executed;
  history.each<msg::Feedback>([&](msg::Feedback& f, Time) {
    auto& list = executed[f.robot()];
    if (list.empty() || list.back().version_number() != f.executing().version_number())
      list.push_back(f.executing());
  });
  const auto& list = executed.at(2);
  REQUIRE(list.size() > 60);
  const msg::Version& to = list[50];
  return {2, to.version_number(), list[49].version_number(), to.start_ns(), to};
}

AuditTotals audit_tampered_crossing(const std::function<void(MessageHistory&)>& tamper) {
  MessageHistory history = crossing();
  tamper(history);
  return audit_of(history, kComplete);
}

void require_violation(AuditRule rule, const std::function<void(MessageHistory&)>& tamper) {
  const AuditTotals totals = audit_tampered_crossing(tamper);
  INFO(rule_info_of(rule).name << " expected; found:\n" << lines(totals));
  REQUIRE(count(totals, rule) > 0);
}

}  // namespace sidestep
