// SPDX-License-Identifier: Apache-2.0
/* Coordinators. */
#ifdef GRANT_BEFORE_ALL_REGISTERED
#define IS_GRANTING(i, e) (registered[C(i, e)] != 0)
#else
#define IS_GRANTING(i, e) ((registered[C(0, e)] != 0 || HAS_ATTESTATION(0, e)) && registered[C(1, e)] != 0)
#endif

#ifdef QUARANTINE
/* A fact that contradicts the ledger, reported while the robot obeyed agent o. */
#define COORDINATOR_RECEIVES_CONTRADICTION(o, e) \
  CHOICE(registered[C(0, e)] != 0 && base_of[V(0, UNGRANTED)] == UNGRANTED, EACH_T(CHOOSE_CONTRADICTION, o, e), \
         printf("%d: coordinator %d receives: robot 0 executes %d at %d, obeys %d\n", now, e, UNGRANTED, t_, o); quarantine(o, e))
#define CHOOSE_CONTRADICTION(o, e, t)                                                                      \
  ::d_step {                                                                                               \
    HAS(facts[F(0, o, 1)] | facts[F(0, o, 2)], FACT(UNGRANTED, t)) && CONTRADICTS(0, e, UNGRANTED, t) &&   \
        (contradicted_at[(e) - 1] <= (t) || contradicted_incarnation[(e) - 1] < (o)) -> v_ = 0; t_ = t           \
  }
#define CONTRADICTIONS(e) COORDINATOR_RECEIVES_CONTRADICTION(1, e) COORDINATOR_RECEIVES_CONTRADICTION(2, e)
#else
#define CONTRADICTIONS(e)
#endif
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
#ifdef WITHOUT_OTHER
     if
     :: IS_QUARANTINED(j, e) || HAS_ATTESTATION(j, e) -> granted_without_other = granted_without_other | BIT(v_)
     :: else
     fi;
#endif
#ifdef UNGRANTED
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

#ifdef QUARANTINE_GRANTS
#define IS_UNSUSPENDED(i, e) true
#else
#define IS_UNSUSPENDED(i, e) !IS_QUARANTINED(i, e)
#endif
/* Only grants are modelled, because a denial changes nothing. */
#define COORDINATOR_RECEIVES_PROPOSAL(i, j, e) \
  CHOICE(IS_GRANTING(i, e) && IS_UNSUSPENDED(i, e), EACH_V(CHOOSE_PROPOSAL, i, e), decide(i, j, e))
#define CHOOSE_PROPOSAL(i, e, v)                                                                           \
  CHOOSE_V(starts[V(i, v)] != 0 && epoch_of[V(i, v)] == (e) && !HAS(granted[i], v) &&                      \
               registered[C(i, e)] == MAKER(i, v) && \
               (HAS(ledger[C(i, e)], base_of[V(i, v)]) || (IS_ABSENT(i, e) && base_of[V(i, v)] == 0)), v)

#define COORDINATOR_RECEIVES_FACT(i, e) \
  CHOICE(registered[C(i, e)] != 0, EACH_FACT(CHOOSE_LEDGER_FACT, i, e), \
         printf("%d: coordinator %d receives: robot %d executes %d at %d\n", now, e, i, f_, t_); update_ledger(i, e))
#define CHOOSE_LEDGER_FACT(i, e, f, t)                                                                     \
  ::d_step {                                                                                               \
    HAS(facts[F(i, 1, 1)] | facts[F(i, 1, 2)] | facts[F(i, 2, 1)] | facts[F(i, 2, 2)], FACT(f, t)) &&      \
        (IS_INFORMATIVE(ledger[C(i, e)], i, f, t) || IS_NEW_LIFTING(i, e, f, t) || IS_CHECKED(i, e, f, t)) && !IS_LATE(i, e, t) && \
        !(IS_QUARANTINED(i, e) && IS_UNGRANTED(i, f)) -> v_ = 0; f_ = f; t_ = t                                                  \
  }

#ifdef LIFT
#define IS_NEW_LIFTING(i, e, f, t) ((f) == LIFTED && lifted_before[(e) - 1] <= (t))
#else
#define IS_NEW_LIFTING(i, e, f, t) false
#endif
#ifdef CHECK_FACTS
#define IS_CHECKED(i, e, f, t) (CONTRADICTS(i, e, f, t) && !IS_EVENT(i, f))
#ifdef QUARANTINE
#define IS_EVENT(i, f) IS_UNGRANTED(i, f)
#else
#define IS_EVENT(i, f) false
#endif
#else
#define IS_CHECKED(i, e, f, t) false
#endif

#ifdef FORGET_BY_TIMEOUT
#define COORDINATOR_TIMES_OUT(i, e)                                                                          \
  CHOICE(ledger[C(i, e)] != 0, EACH_V(CHOOSE_TIMEOUT, i, e), \
         printf("%d: coordinator %d times out %d of robot %d\n", now, e, v_, i); ledger[C(i, e)] = ledger[C(i, e)] & ~BIT(v_))
#define CHOOSE_TIMEOUT(i, e, v) CHOOSE_V(HAS(ledger[C(i, e)], v) && starts[V(i, v)] <= now, v)
#elif defined(LIFT_BY_SILENCE)
#define COORDINATOR_TIMES_OUT(i, e) \
  STEP(i == 0 && registered[C(i, e)] != 0 && ledger[C(i, e)] != 0, \
       printf("%d: coordinator %d takes robot %d to be absent\n", now, e, i); ledger[C(i, e)] = 0)
#else
#define COORDINATOR_TIMES_OUT(i, e)
#endif

#define COORDINATOR_RECEIVES_REGISTRATION(i, k, e)                                                            \
  CHOICE(registered[C(i, e)] < (k) && registrations[G(i, k, e)] != 0, EACH_SET(CHOOSE_REGISTRATION, i, k, e), \
         register_versions(i, k, e))
#define CHOOSE_REGISTRATION(i, k, e, set)                                                                  \
  CHOOSE_V(HAS(registrations[G(i, k, e)], set) &&                                                          \
               (registered[C(i, e)] == 0 ||                                                                  \
                (IS_QUARANTINED(i, e) -> ENDS_QUARANTINE(i, k, e, set) : ((set) & ~ledger[C(i, e)]) == 0)), set)
inline register_versions(i, k, e) {
  if
  :: registered[C(i, e)] == 0 ->
     ledger[C(i, e)] = v_
#ifdef ATTEST
     ; is_taken_as_absent = is_taken_as_absent && !(i == 0 && e == 2)
#endif
#ifdef QUARANTINE
  :: registered[C(i, e)] != 0 && IS_QUARANTINED(i, e) ->
     ledger[C(i, e)] = v_;
     contradicted_at[e - 1] = 0; contradicted_incarnation[e - 1] = 0
#endif
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

#ifdef ATTEST
#ifdef ATTEST_ON_FLOOR
#define IS_TRULY_ABSENT true
#else
#define IS_TRULY_ABSENT (EXECUTES_NOTHING(0) && !IS_UPCOMING(1) && !IS_UPCOMING(2) && !IS_UPCOMING(3) && !IS_UPCOMING(4))
#define IS_UPCOMING(v) (starts[V(0, v)] > now && base_of[V(0, v)] == 0) /* a place where the robot may be put down */
#endif
#ifdef ATTEST_REGISTERED
#define AWAITS_REGISTRATION true
#else
#define AWAITS_REGISTRATION (registered[C(0, 2)] == 0)
#endif
#define ATTESTATIONS                                                                                       \
  STEP(!is_attested && registered[C(0, 2)] == 0 && IS_TRULY_ABSENT, is_attested = true;                    \
       printf("%d: an operator attests that robot 0 is absent\n", now))                                    \
  STEP(is_attested && !is_taken_as_absent && AWAITS_REGISTRATION, is_taken_as_absent = true; ledger[C(0, 2)] = 0; \
       printf("%d: coordinator 2 takes robot 0 to be absent\n", now))
#else
#define ATTESTATIONS
#endif
