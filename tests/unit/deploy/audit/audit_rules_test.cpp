// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/audit_rules.hpp"

#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "tests/catch.hpp"

namespace sidestep::audit_rules_test {

using namespace std::chrono_literals;

Violation violation() {
  Violation violation;
  violation.rule = AuditRule::kBase;
  violation.detected = Time{2'500'000us};
  violation.robot = 4;
  violation.detail = "too far";
  return violation;
}

TEST_CASE("a line of text states everything known about a violation") {
  Violation v = violation();
  CHECK(to_line(v) == "2.500000 base (ledger rule 1): robot 4: too far");
  v.version = 1;
  CHECK(to_line(v) == "2.500000 base (ledger rule 1): robot 4 version 1: too far");
  v.epoch = 1;
  v.other = 3;
  v.other_version = 9;
  CHECK(to_line(v) ==
        "2.500000 base (ledger rule 1): robot 4 version 1, robot 3 version 9, epoch 1: too far");
}

TEST_CASE("a line of JSON contains everything known about a violation") {
  Violation v = violation();
  v.version = 7;
  const auto json = [&] { return parse_json(to_json_line(v)); };
  CHECK(json() == nlohmann::json{{"rule", "base"},
                                 {"reference", "ledger rule 1"},
                                 {"detected_ns", 2'500'000'000},
                                 {"robot", 4},
                                 {"version", 7},
                                 {"detail", "too far"}});
  v.epoch = 1;
  CHECK(json().at("epoch") == 1);
  CHECK_FALSE(json().contains("other_robot"));
  v.other = 3;
  v.other_version = 9;
  CHECK(json().at("other_robot") == 3);
  CHECK(json().at("other_version") == 9);
}

}  // namespace sidestep::audit_rules_test
