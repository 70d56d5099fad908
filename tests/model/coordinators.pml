// SPDX-License-Identifier: Apache-2.0
/* Coordinators. */
#ifdef GRANT_BEFORE_ALL_REGISTERED
#define IS_GRANTING(i, e) (registered[C(i, e)] != 0)
#else
#define IS_GRANTING(i, e) (registered[C(0, e)] != 0 && registered[C(1, e)] != 0)
#endif

inline learn(i, e) {
#ifdef OWN
  if
  :: IS_OWN(i, f_) && !HAS(ledger[C(i, e)], f_) && !is_reported ->
     is_reported = true;
     excuse(f_, e)
  :: else
  fi;
#endif
  forget(ledger[C(i, e)], i)
}
#ifdef OWN
/* Everything of robot 1 that version v of robot 0 comes too near to: knowingly. */
inline excuse(v, e) {
  w_ = 0;
  do
  :: w_ <= LAST(1) ->
     if
     :: HAS(ledger[C(1, e)], w_) && (uses[V(0, v)] & uses[V(1, w_)]) != 0 -> excused[v] = excused[v] | BIT(w_)
     :: else
     fi;
     w_++
  :: else -> break
  od
}
/* Where the base is too near already, its successor may be as near. */
#define IS_ESCAPE(i, j, v, w) ((uses[V(i, v)] & uses[V(j, w)] & ~uses[V(i, base_of[V(i, v)])]) == 0)
#else
#define IS_ESCAPE(i, j, v, w) false
#endif
#define ARE_TOO_NEAR(i, j, v, w) ((uses[V(j, w)] & uses[V(i, v)]) != 0 && !IS_ESCAPE(i, j, v, w))

inline judge(i, j, e) {
  conflict_ = false;
  w_ = LAST(j);
  do
  :: HAS(ledger[C(j, e)], w_) && ARE_TOO_NEAR(i, j, v_, w_) -> conflict_ = true; break
#ifdef ONLY_NEWEST_COUNTS
  :: HAS(ledger[C(j, e)], w_) && !ARE_TOO_NEAR(i, j, v_, w_) -> break
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
#ifdef OWN
     if
     :: i == 0 -> excuse(v_, e)
     :: else ->
        set_ = 0;
        do
        :: set_ <= LAST(0) ->
           if
           :: HAS(ledger[C(0, e)], set_) && (uses[V(0, set_)] & uses[V(1, v_)]) != 0 -> excused[set_] = excused[set_] | BIT(v_)
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

/* Only a grant makes a difference. */
#define COORDINATOR_HEARS_PROPOSAL(i, j, e) \
  CHOICE(IS_GRANTING(i, e), EACH_V(CHOOSE_PROPOSAL, i, e), judge(i, j, e))
#define CHOOSE_PROPOSAL(i, e, v)                                                                           \
  CHOOSE_V(starts[V(i, v)] != 0 && epoch_of[V(i, v)] == (e) && !HAS(granted[i], v) &&                      \
               registered[C(i, e)] == MAKER(i, v) && HAS(ledger[C(i, e)], base_of[V(i, v)]), v)

#define COORDINATOR_HEARS_FACT(i, e) \
  CHOICE(registered[C(i, e)] != 0, EACH_FACT(CHOOSE_LEDGER_FACT, i, e), \
         printf("%d: coordinator %d hears: robot %d executes %d at %d\n", now, e, i, f_, t_); learn(i, e))
#define CHOOSE_LEDGER_FACT(i, e, f, t)                                                                     \
  ::d_step {                                                                                               \
    HAS(facts[F(i, 1, 1)] | facts[F(i, 1, 2)] | facts[F(i, 2, 1)] | facts[F(i, 2, 2)], FACT(f, t)) &&      \
        IS_NEWS(ledger[C(i, e)], i, f) -> v_ = 0; f_ = f; t_ = t                                                  \
  }

#ifdef FORGET_BY_TIME_OUT
#define COORDINATOR_GUESSES(i, e)                                                                          \
  CHOICE(ledger[C(i, e)] != 0, EACH_V(CHOOSE_GUESS, i, e), \
         printf("%d: coordinator %d gives up %d of robot %d\n", now, e, v_, i); ledger[C(i, e)] = ledger[C(i, e)] & ~BIT(v_))
#define CHOOSE_GUESS(i, e, v) CHOOSE_V(HAS(ledger[C(i, e)], v) && starts[V(i, v)] <= now, v)
#else
#define COORDINATOR_GUESSES(i, e)
#endif

#define COORDINATOR_HEARS_REGISTRATION(i, k, e)                                                            \
  CHOICE(registered[C(i, e)] < (k) && registrations[G(i, k, e)] != 0, EACH_SET(CHOOSE_REGISTRATION, i, k, e), \
         enter(i, k, e))
#define CHOOSE_REGISTRATION(i, k, e, set)                                                                  \
  CHOOSE_V(HAS(registrations[G(i, k, e)], set) &&                                                          \
               (registered[C(i, e)] == 0 || ((set) & ~ledger[C(i, e)]) == 0), set)
inline enter(i, k, e) {
  if
  :: registered[C(i, e)] == 0 -> ledger[C(i, e)] = v_
  :: else
  fi;
  registered[C(i, e)] = k;
  printf("%d: coordinator %d registers agent %d of robot %d with the set %d\n", now, e, k, i, v_);
  /* Registrations of this agent and earlier ones are ignored from now on: left out. */
  registrations[G(i, 1, e)] = 0;
  if
  :: k == 2 -> registrations[G(i, 2, e)] = 0
  :: else
  fi
}
