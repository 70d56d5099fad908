// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "deploy/audit/contact_excuses.hpp"
#include "deploy/audit/seen_contacts.hpp"
#include "idl/vision.hpp"

namespace sidestep {

/// Reads positions and contacts from vision's observations, for systems without ground truth.
class VisionAudit {
 public:
  VisionAudit(const AuditedRun& run, RobotRecords& robots, RunCoverage& coverage, Disturbances& disturbances,
              ContactExcuses& excuses, AuditFindings& findings)
      : run_(run),
        robots_(robots),
        coverage_(coverage),
        disturbances_(disturbances),
        excuses_(excuses),
        findings_(findings),
        sightings_(robots.all().size()),
        seen_contacts_(run.scenario) {}

  void on_world_state(const msg::WorldState& world, const Reception& reception);

 private:
  void record_sightings(const msg::WorldState& world);
  /// Makes vision the reference if it has shown robots for a while without any ground truth being received.
  /// Returns whether it is the reference.
  bool try_become_reference();
  void check_contacts(Time at);
  void record_positions(const msg::WorldState& world);

  const AuditedRun& run_;
  RobotRecords& robots_;
  RunCoverage& coverage_;
  Disturbances& disturbances_;
  ContactExcuses& excuses_;
  AuditFindings& findings_;
  std::vector<VisionSighting> sightings_;  ///< parallel to the robots
  SeenContacts seen_contacts_;
  std::optional<Time> first_sighting_at_;
};

}  // namespace sidestep
