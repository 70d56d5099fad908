// SPDX-License-Identifier: Apache-2.0
/* The property, and goal states. */
#ifdef UNGRANTED
#define IS_CONFLICT_ALLOWED \
  ((REFERENCE(0) == UNGRANTED && !is_reported) || HAS(allowed_conflicts[REFERENCE(0)], executing[1]))
#else
#define IS_CONFLICT_ALLOWED false
#endif

inline check() {
#ifndef WITNESS
#define WITNESS true
#endif
  assert(!((places[V(0, REFERENCE(0))] & places[V(1, executing[1])]) != 0 && !IS_CONFLICT_ALLOWED && (WITNESS)))
#ifdef GOAL_PASSING /* one robot uses a place that the other has left */
#define GOAL executing[0] == 2 && places[V(0, 1)] == 1 && executing[1] == 1 && places[V(1, 1)] == 1
#endif
#ifdef GOAL_TAKEOVER /* one robot has moved under the first coordinator, the other moves under the second */
#define GOAL executing[0] == 1 && epoch_of[V(0, 1)] == 1 && executing[1] == 1 && epoch_of[V(1, 1)] == 2
#endif
#ifdef GOAL_LIFT /* a robot is lifted, put down and moves again */
#define GOAL lifting == PUT_DOWN && base_of[V(0, executing[0])] != 0 && places[V(0, executing[0])] == 1
#endif
#ifdef GOAL_FREE_PLACE /* one robot uses a place that the other would use if it had not been lifted */
#define GOAL lifting == IN_HAND && places[V(0, executing[0])] == 1 && executing[1] == 1 && places[V(1, 1)] == 1
#endif
#ifdef GOAL_NEIGHBOUR /* the other robot moves by a version granted during the quarantine */
#define GOAL executing[1] != 0 && HAS(granted_without_other, executing[1]) && places[V(1, executing[1])] == 1
#endif
#ifdef GOAL_RELEASED /* a new agent moves the robot on from the version that was not granted */
#define GOAL executing[0] != 0 && base_of[V(0, executing[0])] == UNGRANTED && executing[0] != UNGRANTED && places[V(0, UNGRANTED)] == 1
#endif
#ifdef GOAL_RELEASED_BY_FACTS /* the robot moves on after a forged fact */
#define GOAL is_reported && contradicted_at[0] == 0 && executing[0] != 0 && starts[V(0, executing[0])] > starts[V(0, UNGRANTED)] + 1
#endif
#ifdef GOAL_ATTESTED /* the other robot moves while robot 0 is attested as absent; then robot 0 returns and moves */
#define GOAL lifting == PUT_DOWN && executing[1] != 0 && HAS(granted_without_other, executing[1])
#endif
#ifdef GOAL
  ; assert(!(GOAL))
#endif
}
