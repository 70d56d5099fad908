// SPDX-License-Identifier: Apache-2.0
/* Agents. */
#define IS_REGISTERING(i, k) (fenced[A(i, k)] && epoch[A(i, k)] != 0 && HAS_ACKNOWLEDGED(i, k))
#if defined(REGISTER_UNACKNOWLEDGED) || defined(NO_EPOCH_FENCE)
#define HAS_ACKNOWLEDGED(i, k) true
#else
#define HAS_ACKNOWLEDGED(i, k) (acknowledged[A(i, k)] == epoch[A(i, k)])
#endif

/* The messages that an agent sends whenever its state changes: fences, commands, its registration. */
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

/* An agent adopts a version that it does not know, unless it holds one that continues it. */
#ifdef AGENT_ADOPTS_LATE_FACT
#define MAY_ADOPT(set, i, f) ((i) == 0 && (f) < NV && !HAS(set, f) && ((set) & OLDER(f)) == 0)
#elif defined(QUARANTINE) && !defined(FORGED)
#define MAY_ADOPT(set, i, f) \
  ((i) == 0 && (f) == UNGRANTED && !HAS(set, UNGRANTED) && !IS_CONTINUATION(set, 3) && !IS_CONTINUATION(set, 4))
#define IS_CONTINUATION(set, v) (HAS(set, v) && base_of[V(0, v)] >= UNGRANTED)
#else
#define MAY_ADOPT(set, i, f) false
#endif

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
        (!fenced[A(i, k)] || acknowledged[A(i, k)] < (e) || IS_INFORMATIVE(held[A(i, k)], i, f, t) || MAY_ADOPT(held[A(i, k)], i, f)) && IS_TRUE(f) -> v_ = 0; f_ = f; t_ = t \
  }
#ifdef LIFT
#define SET_OF(f) ((f) == LIFTED -> 0 : BIT(f))
#define IS_IN_HAND(i, k, b) ((i) == 0 && (b) == 0 && told_lifted[(k) - 1])
#else
#define SET_OF(f) BIT(f)
#define IS_IN_HAND(i, k, b) false
#endif
#ifdef FORGED /* only the coordinator receives the forged fact */
#define IS_TRUE(f) ((f) != UNGRANTED)
#else
#define IS_TRUE(f) true
#endif
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
  :: !fenced[A(i, k)] -> fenced[A(i, k)] = true; held[A(i, k)] = SET_OF(f_)
#if defined(QUARANTINE) || defined(AGENT_ADOPTS_LATE_FACT)
  :: fenced[A(i, k)] && MAY_ADOPT(held[A(i, k)], i, f_) -> held[A(i, k)] = BIT(f_)
#endif
  :: else -> forget(held[A(i, k)], i)
  fi;
#ifdef LIFT
  if
  :: f_ == LIFTED -> told_lifted[k - 1] = true
  :: else
  fi;
#endif
  send(i, k)
}

/* The agent proposes its next version, with any version that its robot may execute as the base. */
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
#define CHOOSE_BASE(i, k, b) :: (HAS(held[A(i, k)], b) || IS_IN_HAND(i, k, b)) && number_ > b && NUMBERED_AFTER(i, k, b) && starts[V(i, b)] < T -> base_ = b
#define CHOOSE_START(i, s) :: s > now && s > starts[V(i, base_)] -> start_ = s
#define CHOOSE_PLACES(u) :: u_ = u
inline next_number(i, k) {
  number_ = FIRST_OF(i, k);
#ifdef UNGRANTED
  if
  :: i == 0 && k == 1 && held[A(i, k)] >= BIT(UNGRANTED) -> number_ = UNGRANTED + 1
  :: else
  fi;
#endif
  do
  :: number_ <= LAST(i) && starts[V(i, number_)] != 0 -> number_++
  :: else -> break
  od
}
/* A version that the agent numbered before it knew of the robot's own stop has a lower number than that stop. */
#ifdef UNGRANTED
#define NUMBERED_AFTER(i, k, b) \
  (number_ <= LAST_OF(i, k) && ((i) == 1 || (k) == 2 || (number_ != UNGRANTED && (b >= UNGRANTED || number_ < UNGRANTED))))
#else
#define NUMBERED_AFTER(i, k, b) true
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
