// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/audit_rules.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace sidestep {
namespace {

constexpr std::array<AuditRuleInfo, kAuditRules> kRules{{
    {"clearance", "ledger rule 1, S-02",
     "versions of two robots that both may be executed are clear of each other"},
    {"one-meaning", "words: version", "a version number means one trajectory"},
    {"base", "ledger rule 1", "a granted version's base is one that its robot may be executing"},
    {"continuity", "ledger rule 1", "a version continues its base in position and velocity"},
    {"limits", "ledger rule 1", "a granted version obeys the robot's limits"},
    {"rest", "ledger rule 1", "a granted version ends at rest"},
    {"floor", "ledger rule 1", "a granted version stays on the field"},
    {"obstacle", "ledger rule 1", "a granted version stays off the obstacles"},
    {"growth", "off reference", "a granted version is as grown as its base, or begins at rest"},
    {"numbers", "ledger rule 4", "versions are granted in increasing order, above their base, once"},
    {"proposed", "ledger rule 1", "only what was proposed is granted, in the epoch that was asked"},
    {"all-registered", "new coordinator",
     "nothing is granted before every robot has registered in the epoch"},
    {"one-coordinator", "new coordinator", "only one coordinator grants in an epoch"},
    {"ledger-page", "ledger rule 2", "the ledger holds what robots may be executing, and nothing else"},
    {"registration", "new coordinator", "a registration holds all that the robot may be executing"},
    {"acknowledged", "robots fence epochs, S-10",
     "an agent registers after its robot has acknowledged it and the epoch"},
    {"forwarded", "agent, S-06", "an agent forwards only what was granted"},
    {"epoch-back", "new coordinator", "an agent never goes back to a lower epoch"},
    {"sent", "firmware, S-05", "a robot executes only what it was sent"},
    {"switch", "firmware, S-05", "a robot switches to a version only from its base"},
    {"late", "firmware, S-05", "a robot switches to a version only if it came before its start"},
    {"fenced", "firmware, S-05", "a robot obeys no incarnation older than one it has obeyed"},
    {"old-epoch", "robots fence epochs, S-10",
     "a robot takes nothing sent under an epoch older than one it has obeyed"},
    {"facts", "ledger rule 2", "facts never become untrue"},
    {"off-reference", "off reference", "a robot's own version brakes to rest at once, above all numbers"},
    {"tracking", "off reference",
     "a robot that believes to be beyond the tracking bound gets back in 25 ms or breaks off"},
    {"place", "S-11", "a robot on its reference is where that says, within the margin"},
    {"contact", "the promise, S-08", "robots touch nothing"},
    {"crash", "opponents", "a robot is at rest before something that moves touches it"},
    {"firmware-judge", "firmware, S-05", "the simulator's own judge sees no firmware rule broken"},
}};

}  // namespace

const AuditRuleInfo& audit_rule(AuditRule rule) { return kRules.at(static_cast<std::size_t>(rule)); }

std::string to_line(const Violation& v) {
  const AuditRuleInfo& rule = audit_rule(v.rule);
  std::string text = fmt::format("{:.6f} {} ({}): robot {}", to_seconds(v.heard.time_since_epoch()),
                                 rule.name, rule.reference, v.robot);
  if (v.version != 0) text += fmt::format(" version {}", v.version);
  if (v.other) text += fmt::format(", robot {} version {}", *v.other, v.other_version);
  if (v.epoch != 0) text += fmt::format(", epoch {}", v.epoch);
  return text + ": " + v.what;
}

std::string to_json_line(const Violation& v) {
  nlohmann::ordered_json json;
  json["rule"] = audit_rule(v.rule).name;
  json["reference"] = audit_rule(v.rule).reference;
  json["heard_ns"] = to_ns(v.heard);
  json["robot"] = v.robot;
  json["version"] = v.version;
  if (v.other) {
    json["other_robot"] = *v.other;
    json["other_version"] = v.other_version;
  }
  if (v.epoch != 0) json["epoch"] = v.epoch;
  json["what"] = v.what;
  return json.dump();
}

}  // namespace sidestep
