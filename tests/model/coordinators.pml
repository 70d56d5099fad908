// SPDX-License-Identifier: Apache-2.0
/* Coordinators. */
#ifdef GRANT_BEFORE_ALL_REGISTERED
#define IS_GRANTING(i, e) (registered[C(i, e)] != 0)
#else
#define IS_GRANTING(i, e) (registered[C(0, e)] != 0 && registered[C(1, e)] != 0)
#endif

inline update_ledger(i, e) {
#ifdef OWN_STOP
  if
  :: IS_OWN_STOP(i, f_) && !HAS(ledger[C(i, e)], f_) && !is_reported ->
     is_reported = true;
     allow_conflicts(f_, e)
  :: else
  fi;
#endif
  forget(ledger[C(i, e)], i)
}
#ifdef OWN_STOP
/* Allows the conflicts of version v of robot 0 with the versions of robot 1 in the ledger. */
inline allow_conflicts(v, e) {
  w_ = 0;
  do
  :: w_ <= LAST(1) ->
     if
     :: HAS(ledger[C(1, e)], w_) && (places[V(0, v)] & places[V(1, w_)]) != 0 -> allowed_conflicts[v] = allowed_conflicts[v] | BIT(w_)
     :: else
     fi;
     w_++
  :: else -> break
  od
}
/* Where the base is in conflict already, its successor may be too. */
#define IS_ESCAPE(i, j, v, w) ((places[V(i, v)] & places[V(j, w)] & ~places[V(i, base_of[V(i, v)])]) == 0)
#else
#define IS_ESCAPE(i, j, v, w) false
#endif
#define IN_CONFLICT(i, j, v, w) ((places[V(j, w)] & places[V(i, v)]) != 0 && !IS_ESCAPE(i, j, v, w))

inline decide(i, j, e) {
  conflict_ = false;
  w_ = LAST(j);
  do
  :: HAS(ledger[C(j, e)], w_) && IN_CONFLICT(i, j, v_, w_) -> conflict_ = true; break
#ifdef ONLY_NEWEST_COUNTS
  :: HAS(ledger[C(j, e)], w_) && !IN_CONFLICT(i, j, v_, w_) -> break
#endif
  :: else ->
     if
     :: w_ == 0 -> break
     :: else -> w_--
     fi
  od;
  if
  :: !conflict_ ->
#ifdef GRANT_REMOVES
     ledger[C(i, e)] = 0;
#endif
     ledger[C(i, e)] = ledger[C(i, e)] | BIT(v_);
     granted[i] = granted[i] | BIT(v_);
#ifdef OWN_STOP
     if
     :: i == 0 -> allow_conflicts(v_, e)
     :: else ->
        set_ = 0;
        do
        :: set_ <= LAST(0) ->
           if
           :: HAS(ledger[C(0, e)], set_) && (places[V(0, set_)] & places[V(1, v_)]) != 0 -> allowed_conflicts[set_] = allowed_conflicts[set_] | BIT(v_)
           :: else
           fi;
           set_++
        :: else -> break
        od
     fi;
#endif
     printf("%d: coordinator %d grants %d of robot %d\n", now, e, v_, i)
  :: else
  fi
}

/* A denial changes nothing, so only grants are modelled. */
#define COORDINATOR_RECEIVES_PROPOSAL(i, j, e) \
  CHOICE(IS_GRANTING(i, e), EACH_V(CHOOSE_PROPOSAL, i, e), decide(i, j, e))
#define CHOOSE_PROPOSAL(i, e, v)                                                                           \
  CHOOSE_V(starts[V(i, v)] != 0 && epoch_of[V(i, v)] == (e) && !HAS(granted[i], v) &&                      \
               registered[C(i, e)] == MAKER(i, v) && HAS(ledger[C(i, e)], base_of[V(i, v)]), v)

#define COORDINATOR_RECEIVES_FACT(i, e) \
  CHOICE(registered[C(i, e)] != 0, EACH_FACT(CHOOSE_LEDGER_FACT, i, e), \
         printf("%d: coordinator %d receives: robot %d executes %d at %d\n", now, e, i, f_, t_); update_ledger(i, e))
#define CHOOSE_LEDGER_FACT(i, e, f, t)                                                                     \
  ::d_step {                                                                                               \
    HAS(facts[F(i, 1, 1)] | facts[F(i, 1, 2)] | facts[F(i, 2, 1)] | facts[F(i, 2, 2)], FACT(f, t)) &&      \
        IS_INFORMATIVE(ledger[C(i, e)], i, f) -> v_ = 0; f_ = f; t_ = t                                                  \
  }

#ifdef FORGET_BY_TIMEOUT
#define COORDINATOR_TIMES_OUT(i, e)                                                                          \
  CHOICE(ledger[C(i, e)] != 0, EACH_V(CHOOSE_TIMEOUT, i, e), \
         printf("%d: coordinator %d times out %d of robot %d\n", now, e, v_, i); ledger[C(i, e)] = ledger[C(i, e)] & ~BIT(v_))
#define CHOOSE_TIMEOUT(i, e, v) CHOOSE_V(HAS(ledger[C(i, e)], v) && starts[V(i, v)] <= now, v)
#else
#define COORDINATOR_TIMES_OUT(i, e)
#endif

#define COORDINATOR_RECEIVES_REGISTRATION(i, k, e)                                                            \
  CHOICE(registered[C(i, e)] < (k) && registrations[G(i, k, e)] != 0, EACH_SET(CHOOSE_REGISTRATION, i, k, e), \
         register_versions(i, k, e))
#define CHOOSE_REGISTRATION(i, k, e, set)                                                                  \
  CHOOSE_V(HAS(registrations[G(i, k, e)], set) &&                                                          \
               (registered[C(i, e)] == 0 || ((set) & ~ledger[C(i, e)]) == 0), set)
inline register_versions(i, k, e) {
  if
  :: registered[C(i, e)] == 0 -> ledger[C(i, e)] = v_
  :: else
  fi;
  registered[C(i, e)] = k;
  printf("%d: coordinator %d registers agent %d of robot %d with the set %d\n", now, e, k, i, v_);
  /* Registrations of this agent and earlier ones are ignored from now on; removing them reduces the number of states. */
  registrations[G(i, 1, e)] = 0;
  if
  :: k == 2 -> registrations[G(i, 2, e)] = 0
  :: else
  fi
}
