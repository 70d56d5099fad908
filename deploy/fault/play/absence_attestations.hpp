// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "deploy/fault/plan/run_observer.hpp"
#include "deploy/fault/plan/test_result.hpp"
#include "idl/negotiation.hpp"

namespace sidestep {

/// Attests that robots are absent, each until no coordinator misses it any more.
class AbsenceAttestations {
 public:
  using Publish = std::function<void(msg::AbsenceAttestation&)>;

  /// `publish` sends a message as the operator, header included. The observer must outlive this object.
  AbsenceAttestations(const RunObserver& observer, Publish publish)
      : observer_(observer), publish_(std::move(publish)) {}

  void begin(RobotId robot, Time now) { pending_.push_back({robot, now, now, false}); }
  /// Call it at least a few times a second.
  void update(Time now);
  /// Attestations that were not accepted, including those that are still pending.
  std::vector<FaultProblem> problems() const;

 private:
  struct Pending {
    RobotId robot;
    Time begun, due;
    bool was_missing;
  };
  /// Why it is not accepted.
  FaultProblem problem_of(const Pending& pending) const;

  const RunObserver& observer_;
  Publish publish_;
  std::vector<Pending> pending_;
  std::vector<FaultProblem> problems_;
};

}  // namespace sidestep
