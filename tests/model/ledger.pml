// SPDX-License-Identifier: Apache-2.0
/* Rules of the ledger. Agents use the same rules for the versions that their robots may execute. */
/* A robot off its reference executes a version that was not granted. */
#ifdef REPLACE_BY_OLD_FACT
#define MAY_REPLACE(set, i, f) IS_OWN_STOP(i, f)
#else
#define MAY_REPLACE(set, i, f) (IS_OWN_STOP(i, f) && (set) < BIT(f))
#endif
#define IS_INFORMATIVE(set, i, f, t) (HAS(set, f) || MAY_REPLACE(set, i, f) || IS_LIFTING(set, i, f, t))
#ifdef LIFT
/* Whether the fact "off the floor at t" removes a version. */
#define IS_LIFTING(set, i, f, t) \
  ((f) == LIFTED && (IS_STARTED(set, i, 0, t) || IS_STARTED(set, i, 1, t) || IS_STARTED(set, i, 2, t) || \
                     IS_STARTED(set, i, 3, t) || IS_STARTED(set, i, 4, t)))
#ifdef LIFT_REMOVES_ALL
#define IS_STARTED(set, i, v, t) HAS(set, v)
#else
#define IS_STARTED(set, i, v, t) (HAS(set, v) && starts[V(i, v)] <= (t))
#endif
#else
#define IS_LIFTING(set, i, f, t) false
#endif

/* Updates a set of versions by the fact "executing f_ at t_". */
inline forget(set, i) {
  if
#ifdef LIFT
  :: f_ == LIFTED ->
     v_ = 0;
     do
     :: v_ < NV ->
        if
#ifdef LIFT_REMOVES_ALL
        :: true -> set = set & ~BIT(v_)
#else
        :: starts[V(i, v_)] <= t_ -> set = set & ~BIT(v_)
        :: else
#endif
        fi;
        v_++
     :: else -> break
     od
#endif
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

/* Whether the fact "executing f at t" contradicts the ledger (rule 6). */
#define CONTRADICTS(i, e, f, t)                                                                            \
  ((f) < NV && !IS_LATE(i, e, t) && (!HAS(ledger[C(i, e)], f) || (IS_QUARANTINED(i, e) && IS_UNGRANTED(i, f))) &&   \
   !MAY_REPLACE(ledger[C(i, e)], i, f) && (ledger[C(i, e)] == 0 || (ledger[C(i, e)] & OLDER(f)) != 0))
#ifdef LATE_FACT_AFTER_LIFT
#define IS_LATE(i, e, t) false
#elif defined(LIFT)
#define IS_LATE(i, e, t) ((i) == 0 && (t) < lifted_before[(e) - 1])
#else
#define IS_LATE(i, e, t) false
#endif
#ifdef UNGRANTED
#define IS_UNGRANTED(i, f) ((i) == 0 && (f) == UNGRANTED)
#else
#define IS_UNGRANTED(i, f) false
#endif

#ifdef QUARANTINE
/* Stands for 60 consecutive facts that agree with the ledger: one fact later than the contradiction. */
#ifdef RELEASE_BY_LATE_FACT
#define RELEASES(e, t) true
#else
#define RELEASES(e, t) ((t) >= contradicted_at[(e) - 1])
#endif
#endif

#ifdef RELEASE_BY_EARLIER_LIFTING
#define HAS_ENDED(t) true
#else
#define HAS_ENDED(t) (starts[V(0, UNGRANTED)] <= (t))
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
#ifdef CHECK_FACTS
  assert(!CONTRADICTS(i, e, f_, t_));
#endif
#ifdef LIFT
  if
  :: f_ == LIFTED && lifted_before[e - 1] <= t_ -> lifted_before[e - 1] = t_ + 1
  :: else
  fi;
#endif
#ifdef QUARANTINE
  if
  :: IS_QUARANTINED(i, e) && f_ != LIFTED && !RELEASES(e, t_) ->
#ifdef QUARANTINE_FORGETS
     forget(ledger[C(i, e)], i);
     ledger[C(i, e)] = ledger[C(i, e)] | BIT(UNGRANTED);
#endif
     f_ = NONE
  :: IS_QUARANTINED(i, e) && f_ != LIFTED && RELEASES(e, t_) ->
     printf("        the quarantine ends\n");
     ledger[C(i, e)] = ledger[C(i, e)] & ~BIT(UNGRANTED);
     contradicted_at[e - 1] = 0; contradicted_incarnation[e - 1] = 0
  :: IS_QUARANTINED(i, e) && f_ == LIFTED && HAS_ENDED(t_) ->
     ledger[C(i, e)] = ledger[C(i, e)] & ~BIT(UNGRANTED);
     contradicted_at[e - 1] = 0; contradicted_incarnation[e - 1] = 0
  :: else
  fi;
  if
  :: f_ != NONE -> forget(ledger[C(i, e)], i)
  :: else
  fi
#else
  forget(ledger[C(i, e)], i)
#endif
}

#ifdef QUARANTINE
inline quarantine(o, e) {
  if
  :: contradicted_at[e - 1] <= t_ -> contradicted_at[e - 1] = t_ + 1
  :: else
  fi;
  if
  :: contradicted_incarnation[e - 1] < o -> contradicted_incarnation[e - 1] = o
  :: else
  fi;
#ifdef QUARANTINE_REPLACES
  ledger[C(0, e)] = 0;
#endif
#ifndef QUARANTINE_DROPS_CONTRADICTION
  ledger[C(0, e)] = ledger[C(0, e)] | BIT(UNGRANTED);
#endif
  if
  :: !is_reported ->
     is_reported = true;
     allow_conflicts(UNGRANTED, e)
  :: else
  fi
}
#endif
/* The registration lists the version that contradicted the ledger, or the robot had not yet been fenced by this agent
   when it executed that version. */
#ifdef QUARANTINE
#ifdef RELEASE_BY_ANY_REGISTRATION
#define ENDS_QUARANTINE(i, k, e, set) true
#else
#define ENDS_QUARANTINE(i, k, e, set) (contradicted_incarnation[(e) - 1] < (k) || HAS(set, UNGRANTED))
#endif
#else
#define ENDS_QUARANTINE(i, k, e, set) true
#endif

#ifdef UNGRANTED
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
/* If the base is already in conflict, its successor may be too. */
#define IS_ESCAPE(i, j, v, w) ((places[V(i, v)] & places[V(j, w)] & ~places[V(i, base_of[V(i, v)])]) == 0)
#else
#define IS_ESCAPE(i, j, v, w) false
#endif
#ifdef PLACE_UNCHECKED
#define IS_EXEMPT(i, e) IS_ABSENT(i, e)
#else
#define IS_EXEMPT(i, e) false
#endif
#define IN_CONFLICT(i, j, v, w) (!IS_EXEMPT(i, e) && (places[V(j, w)] & places[V(i, v)]) != 0 && !IS_ESCAPE(i, j, v, w))
