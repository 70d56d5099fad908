// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/trial_result.hpp"

#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"

namespace sidestep {

using Json = nlohmann::ordered_json;

Json to_json(const TrialResult& r) {
  return {{"seed", r.seed},
          {"failures", r.failures},
          {"fault_kinds", r.fault_kinds},
          {"contacts", r.contacts},
          {"excused_contacts", r.excused_contacts},
          {"excused_by_cause", r.excused_by_cause},
          {"pair_s", r.pair_s},
          {"excused_pair_s", r.excused_pair_s},
          {"is_audited", r.is_audited},
          {"audit_violations", r.audit_violations},
          {"firmware_violations", r.firmware_violations},
          {"proposals", r.proposals},
          {"grants", r.grants},
          {"denials", r.denials},
          {"robots", r.robots},
          {"stationary", r.stationary},
          {"robot_s", r.robot_s},
          {"distance_m", r.distance_m},
          {"distance_after_recovery_m", r.distance_after_recovery_m},
          {"min_clearance_m", r.min_clearance_m},
          {"wall_s", r.wall_s}};
}

std::string to_line(const TrialResult& result) { return json_text(to_json(result)); }

TrialResult parse_trial_result(const std::string& line) {
  const Json json = parse_ordered_json(line);
  TrialResult r;
  json.at("seed").get_to(r.seed);
  json.at("failures").get_to(r.failures);
  json.at("fault_kinds").get_to(r.fault_kinds);
  json.at("contacts").get_to(r.contacts);
  json.at("excused_contacts").get_to(r.excused_contacts);
  json.at("excused_by_cause").get_to(r.excused_by_cause);
  json.at("pair_s").get_to(r.pair_s);
  json.at("excused_pair_s").get_to(r.excused_pair_s);
  json.at("is_audited").get_to(r.is_audited);
  json.at("audit_violations").get_to(r.audit_violations);
  json.at("firmware_violations").get_to(r.firmware_violations);
  json.at("proposals").get_to(r.proposals);
  json.at("grants").get_to(r.grants);
  json.at("denials").get_to(r.denials);
  json.at("robots").get_to(r.robots);
  json.at("stationary").get_to(r.stationary);
  json.at("robot_s").get_to(r.robot_s);
  json.at("distance_m").get_to(r.distance_m);
  json.at("distance_after_recovery_m").get_to(r.distance_after_recovery_m);
  json.at("min_clearance_m").get_to(r.min_clearance_m);
  json.at("wall_s").get_to(r.wall_s);
  return r;
}

}  // namespace sidestep
