// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/domain/plan.hpp"

namespace sidestep {

const char* name_of(PlanReason reason) {
  switch (reason) {
    case PlanReason::kSolved:
      return "solved";
    case PlanReason::kImproved:
      return "improved";
    case PlanReason::kBudgetSpent:
      return "budget spent";
    case PlanReason::kUnreachable:
      return "unreachable";
  }
  return "?";
}

}  // namespace sidestep
