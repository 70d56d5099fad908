// SPDX-License-Identifier: Apache-2.0
/* Robots and time. */
inline report(i) {
  facts[F(i, obeyed[i], obeyed_epoch[i])] = facts[F(i, obeyed[i], obeyed_epoch[i])] | BIT(FACT(executing[i], now))
}

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
        :: base_of[V(i, v_)] == executing[i] && v_ > executing[i] ->
#endif
           executing[i] = v_;
           printf("        robot %d executes %d from %d on, places %d\n", i, v_, now, places[V(i, v_)])
        :: else
        fi
     :: else
     fi;
     v_++
  :: else -> break
  od
}

#ifdef OWN_STOP
#define IS_CONFLICT_ALLOWED ((executing[0] == OWN_NUMBER && !is_reported) || HAS(allowed_conflicts[executing[0]], executing[1]))
#define PUSHES CHOICE(executing[0] < OWN_NUMBER, EACH_U(PUSH), push())
#define PUSH(u) :: v_ = u
inline push() {
  printf("%d: robot 0 is pushed to places %d\n", now, v_);
  places[V(0, OWN_NUMBER)] = v_;
  starts[V(0, OWN_NUMBER)] = now;
  base_of[V(0, OWN_NUMBER)] = executing[0];
  executing[0] = OWN_NUMBER;
  pending[0] = 0;
  report(0);
  check()
}
#else
#define IS_CONFLICT_ALLOWED false
#define PUSHES
#endif

inline check() {
#ifndef WITNESS
#define WITNESS true
#endif
  assert(!((places[V(0, executing[0])] & places[V(1, executing[1])]) != 0 && !IS_CONFLICT_ALLOWED && (WITNESS)))
#ifdef GOAL_PASSING /* one robot uses a place that the other has left */
#define GOAL executing[0] == 2 && places[V(0, 1)] == 1 && executing[1] == 1 && places[V(1, 1)] == 1
#endif
#ifdef GOAL_TAKEOVER /* one robot has moved under the first coordinator, the other moves under the second */
#define GOAL executing[0] == 1 && epoch_of[V(0, 1)] == 1 && executing[1] == 1 && epoch_of[V(1, 1)] == 2
#endif
#ifdef GOAL
  ; assert(!(GOAL))
#endif
}

inline obey(i, k, e) {
  if
  :: k > obeyed[i] ->
     obeyed[i] = k;
#ifndef FENCE_KEEPS_PENDING
     pending[i] = pending[i] & ~BY_FIRST(i)
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
  CHOOSE_V(HAS(commands[C(i, e)], v) && MAKER(i, v) == (k) && IN_TIME(i, v) && v != executing[i] &&        \
               !HAS(pending[i], v) && (v > executing[i] || MAYBE_OLDER), v)
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
/* A command whose start has passed is always refused; removing it only reduces the number of states. */
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
