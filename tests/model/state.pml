// SPDX-License-Identifier: Apache-2.0
/* Sizes, sets, and the state. */
#ifndef N0
#define N0 2 /* versions of robot 0 by its first agent ... */
#endif
#ifndef M0
#define M0 0 /* ... and by its second, which may run at the same time */
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

#ifdef OWN_STOP
/* Robot 0 may be pushed off its reference once, and then executes a stop of its own. Its agent proposes up to OWN_STOP
   versions after that. Requires M0 == 0. */
#define OWN_NUMBER (N0 + 1)
#define LAST(i) ((i) == 0 -> N0 + 1 + OWN_STOP : N1 + M1)
#define IS_OWN_STOP(i, v) ((i) == 0 && (v) == OWN_NUMBER)
byte allowed_conflicts[5]; /* by version of robot 0: versions of robot 1 in conflict with it because of the push */
bool is_reported;
#else
#define LAST(i) ((i) == 0 -> N0 + M0 : N1 + M1)
#define IS_OWN_STOP(i, v) false
#endif

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
#ifdef OWN_STOP
#define BY_FIRST_AGENT(i) ((i) == 0 -> LAST(0) : N1)
#else
#define BY_FIRST_AGENT(i) ((i) == 0 -> N0 : N1)
#endif
#define LAST_OF(i, k) ((k) == 1 -> BY_FIRST_AGENT(i) : LAST(i))
#define MAKER(i, v) ((v) <= BY_FIRST_AGENT(i) -> 1 : 2)
#define BY_FIRST(i) ((1 << (1 + BY_FIRST_AGENT(i))) - 1) /* version 0 and the first agent's versions */
#define OLDER(v) ((1 << (v)) - 1)
#define F(i, k, e) ((i) * 4 + ((k) - 1) * 2 + (e) - 1)
#define G(i, k, e) F(i, k, e)
#define EXISTS(i, k) (LAST_OF(i, k) >= FIRST_OF(i, k) || (k) == 1)
#define FACT(v, t) ((v) * (T + 1) + (t))

byte now;

/* Versions. places: contested places that the version may use from its start on, including its stop. starts: 0 if not
   yet proposed. */
byte places[2 * NV], starts[2 * NV], base_of[2 * NV], epoch_of[2 * NV];

/* Robots. */
byte executing[2], pending[2], obeyed[2], obeyed_epoch[2];

/* Agents: the first of each robot, and its successor. */
bool fenced[4];
byte held[4], epoch[4], acknowledged[4];

/* Coordinators: per robot, a set of versions and the registered agent, 0: none. */
byte ledger[2 * 2], registered[2 * 2];

/* The network. */
byte granted[2];             /* verdicts */
byte commands[2 * 2];        /* by their epoch */
byte fences[2];              /* bit 3 (agent - 1) + epoch */
int facts[2 * 4];            /* by obeyed agent and epoch: a set of (executing, at) */
int registrations[2 * 2 * 2]; /* by agent and epoch: a set of sets of versions */

/* Scratch variables within one step. These are not part of the state, so they are valid only until the next choice ... */
hidden byte i_, v_, w_, f_, t_, u_, set_, conflict_;
/* ... and these last over several choices; they are 0 between steps. */
byte number_, base_, start_;
#define NONE 255

/* Lists of choices. */
#define EACH_V(X, ...) X(__VA_ARGS__, 1) X(__VA_ARGS__, 2) X(__VA_ARGS__, 3) X(__VA_ARGS__, 4)
#define EACH_B(X, ...) X(__VA_ARGS__, 0) X(__VA_ARGS__, 1) X(__VA_ARGS__, 2) X(__VA_ARGS__, 3)
#define EACH_FACT(X, ...) \
  EACH_T(X, __VA_ARGS__, 0) EACH_T(X, __VA_ARGS__, 1) EACH_T(X, __VA_ARGS__, 2) EACH_T(X, __VA_ARGS__, 3) \
  EACH_T(X, __VA_ARGS__, 4)
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
  X(__VA_ARGS__, 31)
