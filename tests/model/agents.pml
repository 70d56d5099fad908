// SPDX-License-Identifier: Apache-2.0
/* Agents. */
#define IS_REGISTERING(i, k) (fenced[A(i, k)] && epoch[A(i, k)] != 0 && HAS_ACKNOWLEDGED(i, k))
#if defined(REGISTER_UNACKNOWLEDGED) || defined(NO_EPOCH_FENCE)
#define HAS_ACKNOWLEDGED(i, k) true
#else
#define HAS_ACKNOWLEDGED(i, k) (acknowledged[A(i, k)] == epoch[A(i, k)])
#endif

/* Messages that the agent sends whenever its state changes: fences, commands, its registration. */
inline send(i, k) {
  fences[i] = fences[i] | BIT(3 * ((k) - 1) + epoch[A(i, k)]);
  if
  :: epoch[A(i, k)] != 0 ->
     set_ = held[A(i, k)] & (k == 1 -> BY_FIRST(i) & 254 : 255 & ~BY_FIRST(i));
     v_ = 1;
     do
     :: v_ <= LAST(i) ->
        if
        :: HAS(set_, v_) && !IN_TIME(i, v_) -> set_ = set_ & ~BIT(v_)
        :: else
        fi;
        v_++
     :: else -> break
     od;
     commands[C(i, epoch[A(i, k)])] = commands[C(i, epoch[A(i, k)])] | set_
  :: else
  fi;
  if
  :: IS_REGISTERING(i, k) && registered[C(i, epoch[A(i, k)])] < k ->
     set_ = held[A(i, k)];
#ifdef REGISTER_EXECUTING_ONLY
     v_ = 0;
     do
     :: HAS(set_, v_) -> set_ = BIT(v_); break
     :: else -> v_++
     od;
#endif
     registrations[G(i, k, epoch[A(i, k)])] = registrations[G(i, k, epoch[A(i, k)])] | BIT(set_)
  :: else
  fi
}

#define AGENT_RECEIVES_EPOCH(i, k, e)                                                                         \
  STEP(EXISTS(i, k) && (epoch[A(i, k)] < (e) || (epoch[A(i, k)] != (e) && MAY_LOWER_EPOCH)),                    \
       printf("%d: agent %d of robot %d learns of epoch %d\n", now, k, i, e); epoch[A(i, k)] = e; send(i, k))
#ifdef FOLLOW_LOWER_EPOCH
#define MAY_LOWER_EPOCH true
#else
#define MAY_LOWER_EPOCH false
#endif

/* Off its reference the robot executes a version that was not granted. */
#ifdef REPLACE_BY_OLD_FACT
#define MAY_REPLACE(set, i, f) IS_OWN_STOP(i, f)
#else
#define MAY_REPLACE(set, i, f) (IS_OWN_STOP(i, f) && (set) < BIT(f))
#endif
#define IS_INFORMATIVE(set, i, f) (HAS(set, f) || MAY_REPLACE(set, i, f))

/* Updates a set of versions by the fact "executing f_ at t_". */
inline forget(set, i) {
  if
#ifdef OWN_STOP
  :: !HAS(set, f_) && MAY_REPLACE(set, i, f_) -> set = BIT(f_)
#endif
  :: HAS(set, f_) ->
     set_ = set & ~OLDER(f_);
     v_ = f_ + 1;
     do
     :: v_ <= LAST(i) ->
        if
#ifdef FORGET_ALL_NEWER
        :: true -> set_ = set_ & ~BIT(v_)
#else
        :: starts[V(i, v_)] <= t_ -> set_ = set_ & ~BIT(v_)
        :: else
#endif
        fi;
        v_++
     :: else -> break
     od;
     set = set_
  :: else
  fi
}

#ifdef NO_FENCE_FIRST
#define ADDRESSES(i, k, o) (o) == (k) || !fenced[A(i, k)]
#else
#define ADDRESSES(i, k, o) (o) == (k)
#endif
/* A fact "executing f at t, obeying agent o and epoch e". */
#define AGENT_RECEIVES_FACT(i, k, o, e)                                                                       \
  CHOICE(EXISTS(i, k) && facts[F(i, o, e)] != 0 && (ADDRESSES(i, k, o)), EACH_FACT(CHOOSE_FACT, i, k, o, e), \
         printf("%d: agent %d of robot %d receives: executes %d at %d, obeys %d, epoch %d\n", now, k, i, f_, t_, o, e); process_fact(i, k, e))
#define CHOOSE_FACT(i, k, o, e, f, t)                                                                      \
  ::d_step {                                                                                               \
    HAS(facts[F(i, o, e)], FACT(f, t)) &&                                                                  \
        (!fenced[A(i, k)] || acknowledged[A(i, k)] < (e) || IS_INFORMATIVE(held[A(i, k)], i, f)) -> v_ = 0; f_ = f; t_ = t \
  }
inline process_fact(i, k, e) {
  if
  :: e > acknowledged[A(i, k)] -> acknowledged[A(i, k)] = e
  :: else
  fi;
#ifndef NO_EPOCH_FENCE
  if
  :: e > epoch[A(i, k)] -> epoch[A(i, k)] = e
  :: else
  fi;
#endif
  if
  :: !fenced[A(i, k)] -> fenced[A(i, k)] = true; held[A(i, k)] = BIT(f_)
  :: else -> forget(held[A(i, k)], i)
  fi;
  send(i, k)
}

/* The agent proposes its next version on any version that its robot may execute. */
#define AGENT_PROPOSES(i, k)                                                                               \
  ::atomic {                                                                                               \
    now < T && LAST_OF(i, k) >= FIRST_OF(i, k) && starts[V(i, LAST_OF(i, k))] == 0 && IS_REGISTERING(i, k) ->                  \
    d_step { next_number(i, k) }                                                                           \
    if                                                                                                     \
    :: if EACH_B(CHOOSE_BASE, i, k) fi;                                                                    \
       if EACH_S(CHOOSE_START, i) fi;                                                                      \
       if EACH_U(CHOOSE_PLACES) fi;                                                                           \
       d_step { propose(i, k) }                                                                            \
    :: else -> number_ = 0                                                                                 \
    fi                                                                                                     \
  }
#define CHOOSE_BASE(i, k, b) :: HAS(held[A(i, k)], b) && number_ > b && NUMBERED_AFTER(i, b) && starts[V(i, b)] < T -> base_ = b
#define CHOOSE_START(i, s) :: s > now && s > starts[V(i, base_)] -> start_ = s
#define CHOOSE_PLACES(u) :: u_ = u
inline next_number(i, k) {
  number_ = FIRST_OF(i, k);
#ifdef OWN_STOP
  if
  :: i == 0 && held[A(i, k)] >= BIT(OWN_NUMBER) -> number_ = OWN_NUMBER + 1
  :: else
  fi;
#endif
  do
  :: number_ <= LAST(i) && starts[V(i, number_)] != 0 -> number_++
  :: else -> break
  od
}
/* A version numbered before the agent knows of the robot's own stop has a lower number than that stop. */
#ifdef OWN_STOP
#define NUMBERED_AFTER(i, b) (number_ <= LAST(i) && ((i) == 1 || (number_ != OWN_NUMBER && (b >= OWN_NUMBER || number_ < OWN_NUMBER))))
#else
#define NUMBERED_AFTER(i, b) true
#endif
inline propose(i, k) {
  printf("%d: agent %d of robot %d proposes %d on %d from %d on, places %d, epoch %d\n", now, k, i, number_, base_,
         start_, u_, epoch[A(i, k)]);
  starts[V(i, number_)] = start_;
  base_of[V(i, number_)] = base_;
  places[V(i, number_)] = u_;
  epoch_of[V(i, number_)] = epoch[A(i, k)];
  number_ = 0; base_ = 0; start_ = 0
}

#ifdef LATE_VERDICT
#define IS_AWAITED(i, v) (epoch_of[V(i, v)] <= epoch[A(i, MAKER(i, v))])
#else
#define IS_AWAITED(i, v) (epoch_of[V(i, v)] == epoch[A(i, MAKER(i, v))])
#endif
#ifdef FORWARD_UNGRANTED
#define IS_GRANTED(i, v) (starts[V(i, v)] != 0)
#else
#define IS_GRANTED(i, v) HAS(granted[i], v)
#endif
#define AGENT_RECEIVES_VERDICT(i, k)                                                                          \
  CHOICE(EXISTS(i, k) && starts[V(i, FIRST_OF(i, k))] != 0, EACH_V(CHOOSE_VERDICT, i, k),                   \
         printf("%d: agent %d of robot %d forwards %d\n", now, k, i, v_);                                   \
         held[A(i, k)] = held[A(i, k)] | BIT(v_); send(i, k))
#define CHOOSE_VERDICT(i, k, v)                                                                            \
  CHOOSE_V(MAKER(i, v) == (k) && IS_GRANTED(i, v) && IS_AWAITED(i, v) && starts[V(i, v)] > now &&          \
               !HAS(held[A(i, k)], v), v)
