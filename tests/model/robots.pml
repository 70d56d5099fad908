// SPDX-License-Identifier: Apache-2.0
/* Robots and time. */
#ifdef LIFT
#define REPORTED_NOTHING LIFTED
#define LIFTS \
  STEP(lifting == 0, lifting = IN_HAND; printf("%d: robot 0 is lifted\n", now); LIFT_DROPS_PENDING report(0); check()) PLACES_UNGRANTED
#ifdef LIFTED_KEEPS_PENDING
#define LIFT_DROPS_PENDING
#else
#define LIFT_DROPS_PENDING pending[0] = 0;
#endif
#ifdef PLACE_UNGRANTED
#define PLACES_UNGRANTED \
  STEP(EXECUTES_NOTHING(0) && places[V(0, 0)] == 0, printf("%d: robot 0 is put down anywhere\n", now); places[V(0, 0)] = 1; check())
#else
#define PLACES_UNGRANTED
#endif
#else
#define REPORTED_NOTHING 0
#define LIFTS
#endif
/* The motors of robot 0 obey so late that all versions that it holds have already been sent to them. A new agent does
   not discard these versions, and is acknowledged when the last of them has started. */
#ifdef LEAD
#define ACKNOWLEDGED(i) acknowledged_agent[i]
#ifdef ACKNOWLEDGE_EARLY
#define IS_STILL_TO_START(i) false
#else
#define IS_STILL_TO_START(i) ((pending[i] & BY_FIRST(i)) != 0)
#endif
inline acknowledge(i) {
  if
  :: !IS_STILL_TO_START(i) -> acknowledged_agent[i] = obeyed[i]
  :: else
  fi
}
inline discard(i) {
  if
  :: i == 1 -> pending[i] = pending[i] & ~BY_FIRST(i)
  :: else
  fi
}
#define MAY_COMMAND(i, k) ((k) == ACKNOWLEDGED(i))
#else
#define ACKNOWLEDGED(i) obeyed[i]
#define MAY_COMMAND(i, k) true
inline acknowledge(i) { skip }
inline discard(i) { pending[i] = pending[i] & ~BY_FIRST(i) }
#endif

inline report(i) {
  acknowledge(i);
  facts[F(i, ACKNOWLEDGED(i), obeyed_epoch[i])] = facts[F(i, ACKNOWLEDGED(i), obeyed_epoch[i])] | BIT(FACT((EXECUTES_NOTHING(i) -> REPORTED_NOTHING : executing[i]), now))
}

#ifdef LIFTED_GOES_BACK
#define MAY_GO_BACK(i) EXECUTES_NOTHING(i)
#else
#define MAY_GO_BACK(i) false
#endif

inline make_switches(i) {
  v_ = 1;
  do
  :: v_ <= LAST(i) ->
     if
     :: HAS(pending[i], v_) && starts[V(i, v_)] <= now ->
        pending[i] = pending[i] & ~BIT(v_);
        if
#ifdef NO_BASE_RULE
        :: true ->
#else
        :: base_of[V(i, v_)] == REFERENCE(i) && (v_ > executing[i] || MAY_GO_BACK(i)) ->
#endif
           executing[i] = v_;
#ifdef LIFT
           if
           :: EXECUTES_NOTHING(i) -> lifting = PUT_DOWN; printf("        robot 0 is put down\n")
           :: else
           fi;
#endif
           printf("        robot %d executes %d from %d on, places %d\n", i, v_, now, places[V(i, v_)])
        :: else
        fi
     :: else
     fi;
     v_++
  :: else -> break
  od
}

#ifdef UNGRANTED
#define EVENTS                                                                                             \
  CHOICE(executing[0] < UNGRANTED && base_of[V(0, UNGRANTED)] != UNGRANTED && !EXECUTES_NOTHING(0), EACH_U(EVENT), event())
#define EVENT(u) :: v_ = u
inline event() {
  places[V(0, UNGRANTED)] = v_;
  starts[V(0, UNGRANTED)] = now;
  base_of[V(0, UNGRANTED)] = UNGRANTED;
#ifdef FORGED
  printf("%d: a fact is forged: robot 0 executes %d, places %d\n", now, UNGRANTED, v_);
  facts[F(0, obeyed[0], obeyed_epoch[0])] = facts[F(0, obeyed[0], obeyed_epoch[0])] | BIT(FACT(UNGRANTED, now))
#else
  printf("%d: robot 0 executes %d, which was not granted, places %d\n", now, UNGRANTED, v_);
  executing[0] = UNGRANTED;
  pending[0] = 0;
  report(0);
  check()
#endif
}
#else
#define EVENTS
#endif

inline obey(i, k, e) {
  if
  :: k > obeyed[i] ->
     obeyed[i] = k;
#ifndef FENCE_KEEPS_PENDING
     discard(i)
#endif
  :: else
  fi;
  if
  :: e > obeyed_epoch[i] -> obeyed_epoch[i] = e
  :: else
  fi
}

#ifdef NO_INCARNATION_FENCE
#define OBEYS(i, k) true
#else
#define OBEYS(i, k) ((k) >= obeyed[i])
#endif
#ifdef NO_EPOCH_FENCE
#define OBEYS_EPOCH(i, e) true
#else
#define OBEYS_EPOCH(i, e) ((e) >= obeyed_epoch[i])
#endif
#ifdef LATE_START
#define IN_TIME(i, v) true
#else
#define IN_TIME(i, v) (starts[V(i, v)] > now)
#endif

#define ROBOT_RECEIVES_COMMAND(i, k, e)                                                                       \
  CHOICE(commands[C(i, e)] != 0 && OBEYS(i, k) && OBEYS_EPOCH(i, e), EACH_V(CHOOSE_COMMAND, i, k, e),      \
         printf("%d: robot %d receives command %d of agent %d, epoch %d\n", now, i, v_, k, e); w_ = v_;       \
         obey(i, k, e); pending[i] = pending[i] | BIT(w_); make_switches(i); report(i); check())
#define CHOOSE_COMMAND(i, k, e, v)                                                                         \
  CHOOSE_V(HAS(commands[C(i, e)], v) && MAKER(i, v) == (k) && IN_TIME(i, v) && MAY_COMMAND(i, k) && v != executing[i] &&        \
               !HAS(pending[i], v) && (v > executing[i] || MAYBE_OLDER || MAY_GO_BACK(i)) &&                                      \
               MAY_TAKE(i, v) && !IS_KEPT_IN_HAND(i, v), v)
#ifdef LIFTED_TAKES_ANY
#define MAY_TAKE(i, v) true
#else
#define MAY_TAKE(i, v) (!EXECUTES_NOTHING(i) || base_of[V(i, v)] == 0)
#endif
#ifdef NO_BASE_RULE
#define MAYBE_OLDER true
#else
#define MAYBE_OLDER false
#endif

#define ROBOT_RECEIVES_FENCE(i, k, e)                                                                         \
  STEP(HAS(fences[i], 3 * ((k) - 1) + (e)) && (k) >= obeyed[i] && ((k) > obeyed[i] || (e) > obeyed_epoch[i]), \
       printf("%d: robot %d is fenced by agent %d, epoch %d\n", now, i, k, e); obey(i, k, e); report(i))

#define TICK                                                                                               \
  STEP(now < T, now++; printf("%d: time passes\n", now); make_switches(0); make_switches(1); report(0);       \
       report(1); drop_late_commands(); check())
/* Commands whose start has passed are always refused; removing them only reduces the number of states. */
#ifdef LATE_START
inline drop_late_commands() { skip }
#else
inline drop_late_commands() {
  i_ = 0;
  do
  :: i_ < 2 ->
     set_ = 0;
     v_ = 1;
     do
     :: v_ <= LAST(i_) ->
        if
        :: starts[V(i_, v_)] <= now -> set_ = set_ | BIT(v_)
        :: else
        fi;
        v_++
     :: else -> break
     od;
     commands[C(i_, 1)] = commands[C(i_, 1)] & ~set_;
     commands[C(i_, 2)] = commands[C(i_, 2)] & ~set_;
     i_++
  :: else -> break
  od;
  skip
}
#endif
