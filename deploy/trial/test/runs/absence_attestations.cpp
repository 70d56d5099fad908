// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/absence_attestations.hpp"

#include <fmt/format.h>

namespace sidestep {

void AbsenceAttestations::update(Time now) {
  std::erase_if(pending_, [&](AttestationExchange& exchange) {
    if (exchange.update(observer_.history().is_missing(exchange.robot()), now)) {
      msg::AbsenceAttestation attestation;
      attestation.robot(exchange.robot());
      publish_(attestation);
    }
    if (exchange.state() == AttestationExchange::State::kTimedOut) problems_.push_back(problem_of(exchange));
    return exchange.state() != AttestationExchange::State::kPending;
  });
}

FaultProblem AbsenceAttestations::problem_of(const AttestationExchange& exchange) const {
  return {to_seconds(exchange.begun() - *observer_.begin()),
          fmt::format("attest the absence of robot {}: {}", exchange.robot(), exchange.reason())};
}

std::vector<FaultProblem> AbsenceAttestations::problems() const {
  std::vector<FaultProblem> all = problems_;
  for (const AttestationExchange& exchange : pending_) all.push_back(problem_of(exchange));
  return all;
}

}  // namespace sidestep
