// SPDX-License-Identifier: Apache-2.0
/* The safety protocol, see README.md here. One process makes one step at a time; the network is the set of all
   messages ever sent, of which anybody may take any one at any time, again, or never. */
#include "state.pml"
#include "robots.pml"
#include "agents.pml"
#include "coordinators.pml"

#define FOR_AGENTS(X, i) X(i, 1) X(i, 2)
#define FOR_EPOCHS(X, i) X(i, 1, 1) X(i, 1, 2) X(i, 2, 1) X(i, 2, 2)
#define FOR_FACTS(i) \
  AGENT_HEARS_FACT(i, 1, 1, 1) AGENT_HEARS_FACT(i, 1, 1, 2) AGENT_HEARS_FACT(i, 2, 2, 1) AGENT_HEARS_FACT(i, 2, 2, 2) FOR_FOREIGN_FACTS(i)
#ifdef NO_FENCE_FIRST
#define FOR_FOREIGN_FACTS(i) AGENT_HEARS_FACT(i, 2, 1, 1) AGENT_HEARS_FACT(i, 2, 1, 2)
#else
#define FOR_FOREIGN_FACTS(i)
#endif
#if EPOCHS == 1
#define HEARD(i, k) AGENT_HEARS_EPOCH(i, k, 1)
#else
#define HEARD(i, k) AGENT_HEARS_EPOCH(i, k, 1) AGENT_HEARS_EPOCH(i, k, 2)
#endif

#define ROBOT_STEPS(i) FOR_EPOCHS(ROBOT_HEARS_COMMAND, i) FOR_EPOCHS(ROBOT_HEARS_FENCE, i) ROBOT_HEARS_FENCE(i, 2, 0)
#define AGENT_STEPS(i) \
  FOR_AGENTS(HEARD, i) FOR_FACTS(i) FOR_AGENTS(AGENT_PROPOSES, i) FOR_AGENTS(AGENT_HEARS_VERDICT, i)
#define COORDINATOR_STEPS(i, j, e)                                                                         \
  COORDINATOR_HEARS_PROPOSAL(i, j, e) COORDINATOR_HEARS_FACT(i, e) COORDINATOR_GUESSES(i, e)               \
  COORDINATOR_HEARS_REGISTRATION(i, 1, e) COORDINATOR_HEARS_REGISTRATION(i, 2, e)

init {
  /* Everybody has registered with the first coordinator, and rests out of the way. */
  d_step {
    obeyed[0] = 1; obeyed[1] = 1;
    obeyed_epoch[0] = 1; obeyed_epoch[1] = 1;
    fenced[A(0, 1)] = true; fenced[A(1, 1)] = true;
    held[A(0, 1)] = BIT(0); held[A(1, 1)] = BIT(0);
    epoch[A(0, 1)] = 1; epoch[A(1, 1)] = 1;
    acknowledged[A(0, 1)] = 1; acknowledged[A(1, 1)] = 1;
    ledger[C(0, 1)] = BIT(0); ledger[C(1, 1)] = BIT(0);
    registered[C(0, 1)] = 1; registered[C(1, 1)] = 1;
    fences[0] = BIT(1) | (M0 > 0 -> BIT(3) : 0);
    fences[1] = BIT(1) | (M1 > 0 -> BIT(3) : 0);
    emit(0);
    emit(1)
  }
end:
  do
  TICK
  PUSHES
  ROBOT_STEPS(0) ROBOT_STEPS(1)
  AGENT_STEPS(0) AGENT_STEPS(1)
  COORDINATOR_STEPS(0, 1, 1) COORDINATOR_STEPS(0, 1, 2)
  COORDINATOR_STEPS(1, 0, 1) COORDINATOR_STEPS(1, 0, 2)
  od
}
