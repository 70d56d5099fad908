// SPDX-License-Identifier: Apache-2.0
/* The safety protocol; see README.md in this folder. One process makes one step at a time. The network is the set of
   all messages ever sent; any message may be received by its addressee at any time, repeatedly, or never. */
#include "state.pml"
#include "property.pml"
#include "robots.pml"
#include "ledger.pml"
#include "agents.pml"
#include "coordinators.pml"

#define FOR_AGENTS(X, i) X(i, 1) X(i, 2)
#define FOR_EPOCHS(X, i) X(i, 1, 1) X(i, 1, 2) X(i, 2, 1) X(i, 2, 2)
#define FOR_FACTS(i) \
  AGENT_RECEIVES_FACT(i, 1, 1, 1) AGENT_RECEIVES_FACT(i, 1, 1, 2) AGENT_RECEIVES_FACT(i, 2, 2, 1) AGENT_RECEIVES_FACT(i, 2, 2, 2) FOR_OTHER_FACTS(i)
#ifdef NO_FENCE_FIRST
#define FOR_OTHER_FACTS(i) AGENT_RECEIVES_FACT(i, 2, 1, 1) AGENT_RECEIVES_FACT(i, 2, 1, 2)
#else
#define FOR_OTHER_FACTS(i)
#endif
#if EPOCHS == 1
#define FOR_EPOCH_MESSAGES(i, k) AGENT_RECEIVES_EPOCH(i, k, 1)
#else
#define FOR_EPOCH_MESSAGES(i, k) AGENT_RECEIVES_EPOCH(i, k, 1) AGENT_RECEIVES_EPOCH(i, k, 2)
#endif

#define ROBOT_STEPS(i) FOR_EPOCHS(ROBOT_RECEIVES_COMMAND, i) FOR_EPOCHS(ROBOT_RECEIVES_FENCE, i) ROBOT_RECEIVES_FENCE(i, 2, 0)
#define AGENT_STEPS(i) \
  FOR_AGENTS(FOR_EPOCH_MESSAGES, i) FOR_FACTS(i) FOR_AGENTS(AGENT_PROPOSES, i) FOR_AGENTS(AGENT_RECEIVES_VERDICT, i)
#define COORDINATOR_STEPS(i, j, e)                                                                         \
  COORDINATOR_RECEIVES_PROPOSAL(i, j, e) COORDINATOR_RECEIVES_FACT(i, e) COORDINATOR_TIMES_OUT(i, e)               \
  COORDINATOR_RECEIVES_REGISTRATION(i, 1, e) COORDINATOR_RECEIVES_REGISTRATION(i, 2, e)

init {
  /* All robots have registered with the first coordinator, and rest outside the contested places. */
  d_step {
    obeyed[0] = 1; obeyed[1] = 1;
#ifdef LEAD
    acknowledged_agent[0] = 1; acknowledged_agent[1] = 1;
#endif
    obeyed_epoch[0] = 1; obeyed_epoch[1] = 1;
    fenced[A(0, 1)] = true; fenced[A(1, 1)] = true;
    held[A(0, 1)] = BIT(0); held[A(1, 1)] = BIT(0);
    epoch[A(0, 1)] = 1; epoch[A(1, 1)] = 1;
    acknowledged[A(0, 1)] = 1; acknowledged[A(1, 1)] = 1;
    ledger[C(0, 1)] = BIT(0); ledger[C(1, 1)] = BIT(0);
    registered[C(0, 1)] = 1; registered[C(1, 1)] = 1;
    fences[0] = BIT(1) | (M0 > 0 -> BIT(3) : 0);
    fences[1] = BIT(1) | (M1 > 0 -> BIT(3) : 0);
    report(0);
    report(1)
  }
end:
  do
  TICK
  EVENTS
  LIFTS
  ROBOT_STEPS(0) ROBOT_STEPS(1)
  AGENT_STEPS(0) AGENT_STEPS(1)
  ATTESTATIONS
  CONTRADICTIONS(1) CONTRADICTIONS(2)
  COORDINATOR_STEPS(0, 1, 1) COORDINATOR_STEPS(0, 1, 2)
  COORDINATOR_STEPS(1, 0, 1) COORDINATOR_STEPS(1, 0, 2)
  od
}
