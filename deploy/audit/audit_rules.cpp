// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/audit_rules.hpp"

#include <array>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"

namespace sidestep {
namespace {

constexpr std::array<AuditRuleInfo, kAuditRules> kRules{{
    {"clearance", "ledger rule 1, S-02",
     "versions of two robots that may both be executed are clear of each other"},
    {"unique-version", "definitions: version", "a version number identifies one trajectory"},
    {"base", "ledger rule 1", "the base of a granted version is one that its robot may be executing"},
    {"continuity", "ledger rule 1", "a version continues its base in position and velocity"},
    {"limits", "ledger rule 1", "a granted version obeys the robot's motion limits"},
    {"rest", "ledger rule 1", "a granted version ends at rest"},
    {"field", "ledger rule 1", "a granted version stays inside the field"},
    {"obstacle", "ledger rule 1", "a granted version keeps clear of the obstacles"},
    {"inflation", "off reference",
     "a granted version has the inflation of its base, or begins at rest without inflation"},
    {"version-order", "ledger rule 7",
     "granted versions have increasing numbers, each above its base's number"},
    {"proposed", "ledger rule 1", "only proposed versions are granted, in the epoch of their proposal"},
    {"all-registered", "new coordinator",
     "nothing is granted before every robot has registered in the epoch"},
    {"single-coordinator", "new coordinator", "only one coordinator grants in an epoch"},
    {"ledger-page", "ledger rule 2", "the ledger holds exactly what robots may be executing"},
    {"registration", "new coordinator", "a registration holds every version that the robot may be executing"},
    {"acknowledged", "robots fence epochs, S-10",
     "an agent registers only after its robot has acknowledged its incarnation and the epoch"},
    {"forwarded", "agent, S-06", "an agent forwards only granted versions"},
    {"epoch-regression", "new coordinator", "an agent never returns to a lower epoch"},
    {"sent", "firmware, S-05", "a robot executes only versions that were sent to it"},
    {"switch", "firmware, S-05", "a robot switches to a version only from the version's base"},
    {"late-switch", "firmware, S-05", "a robot switches only to versions that arrived before their start"},
    {"stale-incarnation", "firmware, S-05", "a robot obeys no incarnation older than one that it has obeyed"},
    {"stale-epoch", "robots fence epochs, S-10",
     "a robot executes no version sent under an epoch older than one that it has obeyed"},
    {"facts", "ledger rule 2", "a robot's later reports never contradict earlier ones"},
    {"off-reference", "off reference",
     "a robot's own stop brakes to rest immediately and is numbered above all others"},
    {"tracking", "off reference",
     "a robot that estimates itself beyond the drift bound recovers within 25 ms or goes off reference"},
    {"position", "S-11", "a robot on its reference is within the margin of that reference"},
    {"contact", "the promise, S-08", "robots touch nothing"},
    {"crash", "opponents", "a robot is at rest before a moving object touches it"},
    {"firmware-monitor", "firmware, S-05", "the simulator's firmware monitor finds no violation"},
    {"held", "orders, S-45", "nothing is granted to a robot while an order holds it"},
    {"forgotten-order", "who remembers, S-48",
     "a confirmed order stays in force until a later one replaces, lifts or removes it"},
}};

}  // namespace

const AuditRuleInfo& rule_info_of(AuditRule rule) { return kRules.at(static_cast<std::size_t>(rule)); }

std::string to_line(const Violation& v) {
  const AuditRuleInfo& rule = rule_info_of(v.rule);
  std::string text = fmt::format("{:.6f} {} ({}): robot {}", to_seconds(v.detected.time_since_epoch()),
                                 rule.name, rule.reference, v.robot);
  if (v.version != 0) text += fmt::format(" version {}", v.version);
  if (v.other) text += fmt::format(", robot {} version {}", *v.other, v.other_version);
  if (v.epoch != 0) text += fmt::format(", epoch {}", v.epoch);
  return text + ": " + v.detail;
}

std::string to_json_line(const Violation& v) {
  nlohmann::ordered_json json;
  json["rule"] = rule_info_of(v.rule).name;
  json["reference"] = rule_info_of(v.rule).reference;
  json["detected_ns"] = to_ns(v.detected);
  json["robot"] = v.robot;
  json["version"] = v.version;
  if (v.other) {
    json["other_robot"] = *v.other;
    json["other_version"] = v.other_version;
  }
  if (v.epoch != 0) json["epoch"] = v.epoch;
  json["detail"] = v.detail;
  return json_text(json);
}

}  // namespace sidestep
