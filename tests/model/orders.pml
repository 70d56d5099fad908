// SPDX-License-Identifier: Apache-2.0
// Models which processes remember a hold: two robots, an agent for each, which may restart, and two coordinators, of
// which the second may be the first one after a restart. Messages are lost, repeated and reordered: each may be
// received at any time after it was sent. One client holds robot 0. See coordinator/ORDERS.md.

#define RUNS 2

byte robot_epoch[2];          // run r has epoch r + 1
bool agent_knows[2];          // the agent remembers the hold
bool agent_has_restarted[2];
bool is_told[4];              // 2 * run + agent: the run has told all that the agent remembers
bool knows[RUNS];             // the run remembers the hold
bool has_begun[RUNS];
bool registered[4];           // 2 * run + agent
bool is_confirmed;
bool is_witness[2];            // the agent has remembered the hold since its confirmation, when its robot obeyed that run
// Messages that were sent.
bool sent_with[RUNS], sent_without[RUNS];  // whole memories, with and without the hold
bool sent_missing;                         // an agent has told coordinators of the hold
bool sent_held;                            // the agent of robot 0 has reported that the robot is held
bool sent_registration[4];

#define TOLD(run, agent) is_told[2 * (run) + (agent)]

inline remember(a, r) {
  if
  :: !agent_knows[a] ->
     agent_knows[a] = true;
     TOLD(0, a) = false; TOLD(1, a) = false
  :: else
  fi;
  TOLD(r, a) = true
}

inline hear_without(a, r) {
  if
  :: agent_knows[a] ->
#ifdef FORGET_MISSING
     agent_knows[a] = false; TOLD(r, a) = true
#else
     TOLD(r, a) = false; sent_missing = true
#endif
  :: else -> TOLD(r, a) = true
  fi
}

#ifdef REGISTER_UNTOLD
#define MAY_REGISTER(r, a) true
#else
#define MAY_REGISTER(r, a) (TOLD(r, a) || !agent_knows[a])
#endif

// A run grants versions to robot 0, whose agent proposes.
#define GRANTS(r) (registered[2 * (r)] && registered[2 * (r) + 1] && robot_epoch[0] == (r) + 1 && !knows[r])
#define PROPOSES (!agent_knows[0])

#ifdef CONFIRM_ALONE
#define MAY_CONFIRM(r) true
#else
#ifdef CONFIRM_SUPERSEDED
#define MAY_CONFIRM(r) sent_held
#else
// The agent of robot 0 has reported the hold, and the robot has afterwards obeyed the run.
#define MAY_CONFIRM(r) (sent_held && robot_epoch[0] == (r) + 1)
#endif
#endif

init {
  byte r, a;
  do
  :: atomic {
       select (r : 0 .. 1);
       select (a : 0 .. 1);
       if
       // Coordinators.
       :: !has_begun[r] -> has_begun[r] = true
       :: has_begun[r] && !knows[r] && !is_confirmed -> knows[r] = true  // hears the client
       :: knows[r] && !sent_with[r] -> sent_with[r] = true
       :: !knows[r] && !sent_without[r] -> sent_without[r] = true
       :: sent_missing && !knows[r] -> knows[r] = true
       :: has_begun[r] && knows[r] && !is_confirmed && MAY_CONFIRM(r) ->
          is_confirmed = true;
          is_witness[0] = agent_knows[0] && robot_epoch[0] == r + 1;
          is_witness[1] = agent_knows[1] && robot_epoch[1] == r + 1
       :: sent_registration[2 * r + a] && !registered[2 * r + a] -> registered[2 * r + a] = true
       // Robots and agents.
       :: has_begun[r] && robot_epoch[a] < r + 1 -> robot_epoch[a] = r + 1
       :: sent_with[r] -> remember(a, r)
       :: sent_without[r] -> hear_without(a, r)
       :: agent_knows[0] && !sent_held -> sent_held = true
       :: robot_epoch[a] == r + 1 && MAY_REGISTER(r, a) && !sent_registration[2 * r + a] ->
          sent_registration[2 * r + a] = true
       :: !agent_has_restarted[a] ->
          agent_has_restarted[a] = true; agent_knows[a] = false; is_witness[a] = false;
          TOLD(0, a) = false; TOLD(1, a) = false;
          if
          :: a == 0 -> sent_held = false  // the report counts only as long as that agent lives
          :: else
          fi
       :: else
       fi;
#ifdef GOAL_HELD
       assert(!(is_confirmed && registered[2] && registered[3] && robot_epoch[0] == 2 && knows[1]))
#else
       // Nothing is granted against a hold as long as an agent lives that remembered the hold at its confirmation.
       assert(!((is_witness[0] || is_witness[1]) && PROPOSES && (GRANTS(0) || GRANTS(1))));
#ifdef CHECK_WITNESS
       // At the confirmation of a hold there is such an agent.
       assert(!is_confirmed || is_witness[0] || is_witness[1] || agent_has_restarted[0])
#endif
#endif
     }
  od
}
