// SPDX-License-Identifier: Apache-2.0
/* Sizes, sets, and the state. */
#ifndef N0
#define N0 2 /* versions of robot 0 by its first agent ... */
#endif
#ifndef M0
#define M0 0 /* ... and by its second agent, which may run at the same time */
#endif
#ifndef N1
#define N1 1
#endif
#ifndef M1
#define M1 0
#endif
#ifndef T
#define T 2 /* the last tick of time; versions start at 1 .. T */
#endif
#ifndef EPOCHS
#define EPOCHS 2 /* coordinators */
#endif
#ifndef PLACES
#define PLACES 1 /* contested places: places that both robots may use */
#endif

#if defined(OWN_STOP) || defined(QUARANTINE)
/* Once, robot 0 executes a version that was not granted: with OWN_STOP its own stop after a push; with QUARANTINE any
   other version, or a forged fact claims so (FORGED). Its first agent then proposes up to AFTER versions. */
#define UNGRANTED (N0 + 1)
#ifdef OWN_STOP
#define AFTER OWN_STOP
#else
#define AFTER QUARANTINE
#endif
#define BY_FIRST_AGENT(i) ((i) == 0 -> N0 + 1 + AFTER : N1)
byte allowed_conflicts[5]; /* indexed by version of robot 0: the versions of robot 1 in conflict with it because of the event */
bool is_reported;
#else
#define BY_FIRST_AGENT(i) ((i) == 0 -> N0 : N1)
#endif
#define LAST(i) (BY_FIRST_AGENT(i) + ((i) == 0 -> M0 : M1))
#ifdef OWN_STOP
#define IS_OWN_STOP(i, v) ((i) == 0 && (v) == UNGRANTED)
#else
#define IS_OWN_STOP(i, v) false
#endif

#ifdef ATTEST
/* An operator may attest to the second coordinator that robot 0 is absent: attested, and accepted. Requires LIFT. */
bool is_attested, is_taken_as_absent;
#define HAS_ATTESTATION(i, e) ((i) == 0 && (e) == 2 && is_taken_as_absent)
/* The operator requests a place for the robot only after its agent has registered. */
#ifdef PLACE_UNREGISTERED
#define IS_KEPT_IN_HAND(i, v) false
#else
#define IS_KEPT_IN_HAND(i, v) ((i) == 0 && is_attested && epoch_of[V(i, v)] == 1)
#endif
#else
#define HAS_ATTESTATION(i, e) false
#define IS_KEPT_IN_HAND(i, v) false
#endif

#ifdef QUARANTINE
/* By coordinator: time of the latest fact that contradicts the ledger, plus 1, 0: not quarantined; and the latest agent
   that the robot obeyed then. */
byte contradicted_at[2], contradicted_incarnation[2];
#define IS_QUARANTINED(i, e) ((i) == 0 && contradicted_at[(e) - 1] != 0)
#else
#define IS_QUARANTINED(i, e) false
#endif

#ifdef LIFT
/* Robot 0 may be lifted once. While a person holds it, it executes nothing, and executing[0] is the highest version
   that it has executed. */
#define IN_HAND 1
#define PUT_DOWN 2
byte lifting;
bool told_lifted[2];  /* by agent of robot 0: knows that the robot was lifted */
byte lifted_before[2]; /* by coordinator: facts of robot 0 about times before this one are late */
#define EXECUTES_NOTHING(i) ((i) == 0 && lifting == IN_HAND)
#define IS_ABSENT(i, e) ((i) == 0 && ledger[C(i, e)] == 0)
#else
#define EXECUTES_NOTHING(i) false
#define IS_ABSENT(i, e) false
#endif

/* The version that the next version continues, and whose places are in use. */
#define REFERENCE(i) (EXECUTES_NOTHING(i) -> 0 : executing[i])

#define STEP(condition, body) :: d_step { (condition) -> body }
/* A step that begins with a choice. The choice sets scratch variables; v_ is NONE if there is no option. */
#define CHOICE(condition, options, body)         \
  ::atomic {                                     \
    (condition) ->                               \
    if options :: else -> v_ = NONE fi;          \
    if :: v_ != NONE -> d_step { body } :: else fi \
  }
#define CHOOSE_V(condition, v) :: d_step { (condition) -> v_ = v }

#define NV 5 /* version numbers 0 .. NV - 1 */
#define V(i, v) ((i) * NV + (v))
#define A(i, k) ((i) * 2 + (k) - 1)
#define C(i, e) ((i) * 2 + (e) - 1)
#define BIT(v) (1 << (v))
#define HAS(set, v) (((set) >> (v)) & 1)
#define FIRST_OF(i, k) ((k) == 1 -> 1 : 1 + BY_FIRST_AGENT(i))
#define LAST_OF(i, k) ((k) == 1 -> BY_FIRST_AGENT(i) : LAST(i))
#define MAKER(i, v) ((v) <= BY_FIRST_AGENT(i) -> 1 : 2)
#define BY_FIRST(i) ((1 << (1 + BY_FIRST_AGENT(i))) - 1) /* version 0 and the first agent's versions */
#define OLDER(v) ((1 << (v)) - 1)
#define F(i, k, e) ((i) * 4 + ((k) - 1) * 2 + (e) - 1)
#define G(i, k, e) F(i, k, e)
#define EXISTS(i, k) (LAST_OF(i, k) >= FIRST_OF(i, k) || (k) == 1)
#define LIFTED NV /* in facts: "off the floor, executing nothing" */
#define FACT(v, t) ((v) * (T + 1) + (t))

byte now;

/* Versions. places: contested places that the version may use from its start on, including its stop. starts: 0 if not
   yet proposed. */
byte places[2 * NV], starts[2 * NV], base_of[2 * NV], epoch_of[2 * NV];

/* Robots. */
byte executing[2], pending[2], obeyed[2], obeyed_epoch[2];
#ifdef LEAD
byte acknowledged_agent[2]; /* the agent that facts acknowledge: obeyed[i] or an earlier agent */
#endif

/* Agents: the first agent of each robot, and its successor. */
bool fenced[4];
byte held[4], epoch[4], acknowledged[4];

/* Coordinators: for each robot, a set of versions and the registered agent (0: none). */
byte ledger[2 * 2], registered[2 * 2];

/* The network. */
byte granted[2];             /* verdicts */
byte commands[2 * 2];        /* by the epoch of the command */
byte fences[2];              /* bit 3 (agent - 1) + epoch */
int facts[2 * 4];            /* by obeyed agent and epoch: a set of (executing, at) */
int registrations[2 * 2 * 2]; /* by agent and epoch: a set of sets of versions */

#if defined(GOAL_NEIGHBOUR) || defined(GOAL_ATTESTED)
#define WITHOUT_OTHER
byte granted_without_other; /* a version was granted while the other robot was quarantined, or attested as absent */
#endif

/* Scratch variables within one step. These are not part of the state, so they are valid only until the next choice ... */
hidden byte i_, v_, w_, f_, t_, u_, set_, conflict_;
/* ... and these remain valid over several choices; they are 0 between steps. */
byte number_, base_, start_;
#define NONE 255

/* Lists of choices. */
#define EACH_V(X, ...) X(__VA_ARGS__, 1) X(__VA_ARGS__, 2) X(__VA_ARGS__, 3) X(__VA_ARGS__, 4)
#define EACH_B(X, ...) X(__VA_ARGS__, 0) X(__VA_ARGS__, 1) X(__VA_ARGS__, 2) X(__VA_ARGS__, 3)
#define EACH_FACT(X, ...) \
  EACH_T(X, __VA_ARGS__, 0) EACH_T(X, __VA_ARGS__, 1) EACH_T(X, __VA_ARGS__, 2) EACH_T(X, __VA_ARGS__, 3) \
  EACH_T(X, __VA_ARGS__, 4) EACH_LIFTED(X, __VA_ARGS__)
#ifdef LIFT
#define EACH_LIFTED(X, ...) EACH_T(X, __VA_ARGS__, LIFTED)
#define EACH_EMPTY_SET(X, ...) X(__VA_ARGS__, 0)
#else
#define EACH_LIFTED(X, ...)
#define EACH_EMPTY_SET(X, ...)
#endif
#if PLACES == 1
#define EACH_U(X) X(0) X(1)
#else
#define EACH_U(X) X(0) X(1) X(2) X(3)
#endif
#if T == 1
#define EACH_T(X, ...) X(__VA_ARGS__, 0) X(__VA_ARGS__, 1)
#define EACH_S(X, ...) X(__VA_ARGS__, 1)
#elif T == 2
#define EACH_T(X, ...) X(__VA_ARGS__, 0) X(__VA_ARGS__, 1) X(__VA_ARGS__, 2)
#define EACH_S(X, ...) X(__VA_ARGS__, 1) X(__VA_ARGS__, 2)
#else
#define EACH_T(X, ...) X(__VA_ARGS__, 0) X(__VA_ARGS__, 1) X(__VA_ARGS__, 2) X(__VA_ARGS__, 3)
#define EACH_S(X, ...) X(__VA_ARGS__, 1) X(__VA_ARGS__, 2) X(__VA_ARGS__, 3)
#endif
#define EACH_SET(X, ...)                                                                               \
  X(__VA_ARGS__, 1) X(__VA_ARGS__, 2) X(__VA_ARGS__, 3) X(__VA_ARGS__, 4) X(__VA_ARGS__, 5)             \
  X(__VA_ARGS__, 6) X(__VA_ARGS__, 7) X(__VA_ARGS__, 8) X(__VA_ARGS__, 9) X(__VA_ARGS__, 10)            \
  X(__VA_ARGS__, 11) X(__VA_ARGS__, 12) X(__VA_ARGS__, 13) X(__VA_ARGS__, 14) X(__VA_ARGS__, 15)        \
  X(__VA_ARGS__, 16) X(__VA_ARGS__, 17) X(__VA_ARGS__, 18) X(__VA_ARGS__, 19) X(__VA_ARGS__, 20)        \
  X(__VA_ARGS__, 21) X(__VA_ARGS__, 22) X(__VA_ARGS__, 23) X(__VA_ARGS__, 24) X(__VA_ARGS__, 25)        \
  X(__VA_ARGS__, 26) X(__VA_ARGS__, 27) X(__VA_ARGS__, 28) X(__VA_ARGS__, 29) X(__VA_ARGS__, 30)        \
  X(__VA_ARGS__, 31) EACH_EMPTY_SET(X, __VA_ARGS__)
