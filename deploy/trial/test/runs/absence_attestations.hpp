// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "deploy/trial/fault/attestation_exchange.hpp"
#include "deploy/trial/test/judgement/run_observer.hpp"
#include "deploy/trial/test/judgement/test_result.hpp"
#include "idl/negotiation.hpp"

namespace sidestep {

/// Attests that robots are absent. Each attestation is repeated until no coordinator reports the robot as
/// missing.
class AbsenceAttestations {
 public:
  using Publish = std::function<void(msg::AbsenceAttestation&)>;

  /// `publish` sends a message as the operator, header included. The observer must outlive this object.
  AbsenceAttestations(const RunObserver& observer, Publish publish)
      : observer_(observer), publish_(std::move(publish)) {}

  void begin(RobotId robot, Time now) { pending_.emplace_back(robot, now); }
  /// Call it at least a few times a second.
  void update(Time now);
  /// Attestations that have not been accepted, including pending ones.
  std::vector<FaultProblem> problems() const;

 private:
  FaultProblem problem_of(const AttestationExchange& exchange) const;

  const RunObserver& observer_;
  Publish publish_;
  std::vector<AttestationExchange> pending_;
  std::vector<FaultProblem> problems_;
};

}  // namespace sidestep
