// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>

#include "deploy/trial/simulate/system/sim_link_faults.hpp"
#include "deploy/trial/test/judgement/run_observer.hpp"
#include "deploy/trial/test/plan/fault_test.hpp"
#include "deploy/trial/test/runs/absence_attestations.hpp"
#include "deploy/trial/test/runs/robot_disturbances.hpp"

namespace sidestep {

/// Applies a test's faults to a system on SimBus; see FaultSchedule.
class SimFaults {
 public:
  /// `bus` belongs to an observer of the system. All arguments must outlive this object.
  SimFaults(const FaultTest& test, SimSystem& system, Bus& bus, const RunObserver& observer);

  void begin(std::size_t fault);
  void end(std::size_t fault);
  /// When update() is due, not counting attestations in progress.
  Time next() const;
  /// Restarts killed processes if the scenario says so, and repeats attestations. Call it at least a few
  /// times a second.
  void update();
  /// Faults that could not be applied. Call it at the end of the run; see RobotDisturbances::problems().
  std::vector<FaultProblem> problems();

 private:
  void apply(const Kill& fault, const PlannedFault&);
  void apply(const RestartFault& fault, const PlannedFault&);
  void apply(const Pause& fault, const PlannedFault& planned);
  void apply(const Partition& fault, const PlannedFault&) { links_.begin(fault); }
  void apply(const ImpairmentFault& fault, const PlannedFault&) { impair(fault.target, fault.quality); }
  void apply(const RobotDisturbance& fault, const PlannedFault& planned) {
    disturbances_.begin(fault, planned);
  }
  void apply(const TwinFault& fault, const PlannedFault&);
  void apply(const AbsenceFault& fault, const PlannedFault&);
  /// Replaces the impairment of a process, or of "all".
  void impair(const std::string& target, const LinkQuality& quality);
  /// A process that dies loses its impairment, as over DDS.
  void end_impairment(const std::string& process) {
    if (impaired_.contains(process)) impair(process, kUnimpairedLink);
  }
  /// The name of the running process with this name, or of the active coordinator. Throws std::runtime_error
  /// if it is not running.
  std::string running(const std::string& process) const;

  const FaultTest& test_;
  SimSystem& system_;
  const RunObserver& observer_;
  SimLinkFaults links_;
  std::set<std::string> impaired_;  // names of impaired processes
  std::unique_ptr<RawWriter> disturbance_writer_;
  RobotDisturbances disturbances_;
  Writer<msg::AbsenceAttestation> attestation_writer_;
  AbsenceAttestations attestations_;
  std::map<std::string, Time> restarts_;      // when to restart killed processes
  std::set<std::string> with_changed_rules_;  // processes that were last started with another scenario
};

}  // namespace sidestep
