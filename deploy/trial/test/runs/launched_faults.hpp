// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "common/messaging/dds/operator_channel.hpp"
#include "deploy/run/launch/hosts/run_hosts.hpp"
#include "deploy/run/launch/launcher.hpp"
#include "deploy/trial/test/judgement/run_observer.hpp"
#include "deploy/trial/test/plan/fault_test.hpp"
#include "deploy/trial/test/runs/absence_attestations.hpp"
#include "deploy/trial/test/runs/host_partitions.hpp"
#include "deploy/trial/test/runs/robot_disturbances.hpp"

namespace sidestep {

/// Applies a test's faults to real processes; see FaultSchedule. Nothing here blocks, because it runs in the
/// launcher's thread.
class LaunchedFaults {
 public:
  /// Throws std::runtime_error if the hosts do not allow a fault of the test. Create it before the processes
  /// start, so that they are discovered in time. All arguments must outlive this object.
  LaunchedFaults(const FaultTest& test, const RunHosts& hosts, const DdsSettings& dds, Launcher& launcher,
                 const RunObserver& observer);

  void begin(std::size_t fault);
  void end(std::size_t fault);
  /// Repeats attestations. Call it at least a few times a second.
  void update() { attestations_.update(launcher_.bus().now()); }
  /// Faults that could not be applied. Call it at the end of the run; see RobotDisturbances::problems().
  std::vector<FaultProblem> problems();

 private:
  void require_local(const std::string& process, const std::string& text) const;
  void require_possible(const PlannedFault& fault) const;

  void apply(const Kill& fault, std::size_t index);
  void apply(const RestartFault& fault, std::size_t index);
  void apply(const Pause& fault, std::size_t index);
  void apply(const Partition& fault, std::size_t index);
  void apply(const ImpairmentFault& fault, std::size_t index);
  void apply(const RobotDisturbance& fault, std::size_t index);
  void apply(const TwinFault& fault, std::size_t index);
  void apply(const AbsenceFault& fault, std::size_t index);
  void send_signal(const std::string& process, int signal);
  void impair(const std::string& target, const LinkQuality& quality, std::uint64_t seed);

  const FaultTest& test_;
  const RunHosts& hosts_;
  Launcher& launcher_;
  const RunObserver& observer_;
  // Set only if the test needs them.
  std::optional<OperatorChannel> disturbance_channel_, network_faults_, absences_;
  std::optional<RobotDisturbances> disturbances_;
  std::optional<HostPartitions> partitions_;
  AbsenceAttestations attestations_;
  std::map<std::size_t, ProcessNames> paused_;  // indexed by fault
};

}  // namespace sidestep
