// SPDX-License-Identifier: Apache-2.0
#include "deploy/fault/play/absence_attestations.hpp"

#include <fmt/format.h>

namespace sidestep {
namespace {

constexpr Duration kAttestationTimeout = std::chrono::seconds(5);
constexpr Duration kAttestationPeriod = std::chrono::milliseconds(200);

}  // namespace

void AbsenceAttestations::update(Time now) {
  std::erase_if(pending_, [&](Pending& pending) {
    const bool is_missing = observer_.history().is_missing(pending.robot);
    if (!is_missing && pending.was_missing) return true;  // accepted
    pending.was_missing = is_missing;
    if (now > pending.begun + kAttestationTimeout) {
      problems_.push_back(problem_of(pending));
      return true;
    }
    if (is_missing && now >= pending.due) {
      msg::AbsenceAttestation attestation;
      attestation.robot(pending.robot);
      publish_(attestation);
      pending.due = now + kAttestationPeriod;
    }
    return false;
  });
}

FaultProblem AbsenceAttestations::problem_of(const Pending& pending) const {
  const char* const reason = pending.was_missing ? "the coordinator still waits for the robot"
                                                 : "the coordinator does not wait for the robot";
  return {to_seconds(pending.begun - *observer_.begin()),
          fmt::format("attest the absence of robot {}: {}", pending.robot, reason)};
}

std::vector<FaultProblem> AbsenceAttestations::problems() const {
  std::vector<FaultProblem> all = problems_;
  for (const Pending& pending : pending_) all.push_back(problem_of(pending));
  return all;
}

}  // namespace sidestep
