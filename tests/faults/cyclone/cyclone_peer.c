// SPDX-License-Identifier: Apache-2.0
// A program of another vendor's DDS, built from the IDL alone.
//   cyclone_peer read DOMAIN ROBOT COUNT   prints COUNT messages of each of seven topics, as lines "TOPIC
//   JSON" cyclone_peer go DOMAIN ROBOT X Y       sends a robot somewhere; ends when it has arrived
#include <dds/dds.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "course.h"
#include "monitor.h"
#include "negotiation.h"
#include "order.h"
#include "robot.h"
#include "vision.h"

static const dds_duration_t kTimeout = DDS_SECS(30);
static const uint32_t kClient = 1234567;

static void check(dds_return_t result, const char* what) {
  if (result >= 0) return;
  fprintf(stderr, "cyclone_peer: %s: %s\n", what, dds_strretcode(-result));
  exit(1);
}

// JSON members; `m` points to the struct.
static bool is_first = true;
static void comma(void) {
  if (!is_first) putchar(',');
  is_first = false;
}
static void begin(const char* name, char bracket) {
  comma();
  printf("\"%s\":%c", name, bracket);
  is_first = true;
}
static void end(char bracket) {
  putchar(bracket);
  is_first = false;
}
#define MEMBER(f, ...) (comma(), printf("\"" #f "\":" __VA_ARGS__))
#define BOOL(m, f) MEMBER(f, "%s", (m)->f ? "true" : "false")
#define UNSIGNED(m, f) MEMBER(f, "%" PRIu64, (uint64_t)(m)->f)
#define SIGNED(m, f) MEMBER(f, "%" PRId64, (int64_t)(m)->f)
#define REAL(m, f) MEMBER(f, "%.17g", (double)(m)->f)
#define OBJECT(m, f, print) (begin(#f, '{'), print(&(m)->f), end('}'))
#define OBJECTS(f, elements, count, print)                                      \
  do {                                                                          \
    begin(#f, '[');                                                             \
    for (uint32_t i_ = 0; i_ < (count); ++i_)                                   \
      comma(), putchar('{'), is_first = true, print(&(elements)[i_]), end('}'); \
    end(']');                                                                   \
  } while (0)
#define NUMBERS(m, f, count)                                                                     \
  do {                                                                                           \
    begin(#f, '[');                                                                              \
    for (uint32_t i_ = 0; i_ < (count); ++i_) comma(), printf("%" PRIu64, (uint64_t)(m)->f[i_]); \
    end(']');                                                                                    \
  } while (0)

static void print_header(const sidestep_msg_Header* m) {
  UNSIGNED(m, sender), UNSIGNED(m, incarnation), UNSIGNED(m, rules), UNSIGNED(m, message_number),
      SIGNED(m, stamp_ns);
}
static void print_intent(const sidestep_msg_Intent* m) {
  REAL(m, vx_mps), REAL(m, vy_mps), REAL(m, velocity_duration_s), REAL(m, via_x_m), REAL(m, via_y_m);
  REAL(m, goal_x_m), REAL(m, goal_y_m), REAL(m, target_x_m), REAL(m, target_y_m), SIGNED(m, due_ns);
}
static void print_phase(const sidestep_msg_MotionPhase* m) {
  SIGNED(m, duration_ns), REAL(m, ax_mps2), REAL(m, ay_mps2);
}
static void print_version(const sidestep_msg_Version* m) {
  UNSIGNED(m, robot), UNSIGNED(m, incarnation), UNSIGNED(m, version_number), UNSIGNED(m, base),
      SIGNED(m, start_ns);
  REAL(m, x_m), REAL(m, y_m), REAL(m, vx_mps), REAL(m, vy_mps), REAL(m, inflation_m), BOOL(m, has_intent);
  OBJECT(m, intent, print_intent), UNSIGNED(m, phase_count);
  OBJECTS(phases, m->phases, 4, print_phase);
}
static void print_feedback(const sidestep_msg_Feedback* m) {
  UNSIGNED(m, robot), OBJECT(m, header, print_header), UNSIGNED(m, obeyed_incarnation),
      UNSIGNED(m, obeyed_epoch);
  SIGNED(m, valid_at_ns), OBJECT(m, executing, print_version), BOOL(m, is_off_reference), BOOL(m, is_lifted);
  SIGNED(m, command_stamp_ns), SIGNED(m, command_received_at_ns), REAL(m, x_m), REAL(m, y_m), REAL(m, vx_mps);
  REAL(m, vy_mps), REAL(m, heading_rad), REAL(m, tracking_error_m), REAL(m, position_error_rms_m);
  REAL(m, odometry_scale_stddev), BOOL(m, has_moved), UNSIGNED(m, activated), SIGNED(m, lead_ns);
}
static void print_verdict(const sidestep_msg_Verdict* m) {
  UNSIGNED(m, robot), OBJECT(m, header, print_header), UNSIGNED(m, epoch), UNSIGNED(m, proposal_number);
  SIGNED(m, request_stamp_ns), UNSIGNED(m, granted_version);
  NUMBERS(m, reasons, 5);
  NUMBERS(m, blockers, 5);
}
static void print_page(const sidestep_msg_LedgerPage* m) {
  UNSIGNED(m, page_index), OBJECT(m, header, print_header), UNSIGNED(m, epoch), UNSIGNED(m, page_count);
  REAL(m, min_x_m), REAL(m, min_y_m), REAL(m, max_x_m), REAL(m, max_y_m);
  OBJECTS(versions, m->versions._buffer, m->versions._length, print_version);
}
static void print_point(const sidestep_msg_CoursePoint* m) {
  REAL(m, x_m), REAL(m, y_m), REAL(m, vx_mps), REAL(m, vy_mps);
}
static void print_course(const sidestep_msg_Course* m) {
  UNSIGNED(m, robot), OBJECT(m, header, print_header), SIGNED(m, planned_at_ns), SIGNED(m, due_ns);
  SIGNED(m, start_ns), BOOL(m, continues);
  OBJECTS(points, m->points._buffer, m->points._length, print_point);
}
static void print_offer(const sidestep_msg_CourseOffer* m) {
  UNSIGNED(m, robot), OBJECT(m, header, print_header), UNSIGNED(m, by), SIGNED(m, replaces_ns);
  SIGNED(m, planned_at_ns), SIGNED(m, due_ns), SIGNED(m, start_ns), BOOL(m, continues);
  OBJECTS(points, m->points._buffer, m->points._length, print_point);
}
static void print_ball(const sidestep_msg_TrackedBall* m) {
  BOOL(m, is_visible), REAL(m, x_m), REAL(m, y_m), REAL(m, vx_mps), REAL(m, vy_mps);
}
static void print_tracked(const sidestep_msg_TrackedRobot* m) {
  UNSIGNED(m, robot), REAL(m, x_m), REAL(m, y_m), REAL(m, heading_rad), REAL(m, vx_mps), REAL(m, vy_mps);
  REAL(m, angular_radps), REAL(m, position_variance_m2), REAL(m, velocity_variance_m2ps2),
      SIGNED(m, observed_at_ns);
  REAL(m, observed_x_m), REAL(m, observed_y_m), REAL(m, observed_heading_rad);
  BOOL(m, is_seen_elsewhere);
}
static void print_world(const sidestep_msg_WorldState* m) {
  UNSIGNED(m, vision), OBJECT(m, header, print_header), SIGNED(m, valid_at_ns), UNSIGNED(m, frames);
  OBJECT(m, ball, print_ball);
  OBJECTS(robots, m->robots._buffer, m->robots._length, print_tracked);
}
static void print_pair(const sidestep_msg_ContactPair* m) { UNSIGNED(m, first), UNSIGNED(m, second); }
static void print_true(const sidestep_msg_TrueRobotState* m) {
  UNSIGNED(m, robot), REAL(m, x_m), REAL(m, y_m), REAL(m, heading_rad), REAL(m, vx_mps), REAL(m, vy_mps);
  REAL(m, reference_error_m), SIGNED(m, disturbance_end_ns);
}
static void print_truth(const sidestep_msg_GroundTruth* m) {
  UNSIGNED(m, simulator), OBJECT(m, header, print_header), SIGNED(m, valid_at_ns), UNSIGNED(m, contacts);
  OBJECTS(recent_contacts, m->recent_contacts, 8, print_pair);
  REAL(m, penetration_m_s), REAL(m, min_clearance_m), UNSIGNED(m, firmware_violations), UNSIGNED(m, crashes);
  UNSIGNED(m, crashes_while_moving);
  NUMBERS(m, recent_moving_crashes, 8);
  REAL(m, max_crash_speed_mps), REAL(m, max_robot_crash_speed_mps), REAL(m, ball_x_m), REAL(m, ball_y_m);
  OBJECTS(robots, m->robots._buffer, m->robots._length, print_true);
}

static dds_entity_t participant, wait_set;

/// The same reliability as in Sidestep: best effort for states, reliable for events. XCDR version 1.
static dds_qos_t* make_qos(bool is_event) {
  dds_qos_t* qos = dds_create_qos();
  const dds_data_representation_id_t version_1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos, 1, &version_1);
  dds_qset_reliability(qos, is_event ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_SECS(1));
  dds_qset_history(qos, is_event ? DDS_HISTORY_KEEP_ALL : DDS_HISTORY_KEEP_LAST, 32);
  return qos;
}

static dds_entity_t make_reader(const char* name, const dds_topic_descriptor_t* type) {
  const dds_entity_t topic = dds_create_topic(participant, type, name, NULL, NULL);
  check(topic, name);
  dds_qos_t* qos = make_qos(false);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  check(reader, name);
  dds_delete_qos(qos);
  check(dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS), name);
  check(dds_waitset_attach(wait_set, reader, 0), name);
  return reader;
}

struct input {
  const char* name;
  const dds_topic_descriptor_t* type;
  void (*print)(const void* message);
  dds_entity_t reader;
  int left;
};
#define PRINTER(name, type) \
  static void name##_of(const void* message) { name((const type*)message); }
PRINTER(print_feedback, sidestep_msg_Feedback)
PRINTER(print_verdict, sidestep_msg_Verdict)
PRINTER(print_page, sidestep_msg_LedgerPage)
PRINTER(print_world, sidestep_msg_WorldState)
PRINTER(print_truth, sidestep_msg_GroundTruth)
PRINTER(print_course, sidestep_msg_Course)
PRINTER(print_offer, sidestep_msg_CourseOffer)

/// Prints the wanted number of messages. Returns how many are missing.
static int print_messages(struct input* input) {
  void* samples[8] = {NULL};
  dds_sample_info_t infos[8];
  const int count = dds_take(input->reader, samples, infos, 8, 8);
  check(count, input->name);
  for (int i = 0; i < count; ++i) {
    if (!infos[i].valid_data || input->left == 0) continue;
    --input->left;
    printf("%s {", input->name);
    is_first = true;
    input->print(samples[i]);
    printf("}\n");
  }
  if (count > 0) check(dds_return_loan(input->reader, samples, count), input->name);
  return input->left;
}

static int read_topics(const char* robot, int count) {
  char feedback[32], verdict[32];
  snprintf(feedback, sizeof feedback, "feedback/%s", robot);
  snprintf(verdict, sizeof verdict, "verdict/%s", robot);
  struct input inputs[] = {{feedback, &sidestep_msg_Feedback_desc, print_feedback_of, 0, count},
                           {verdict, &sidestep_msg_Verdict_desc, print_verdict_of, 0, count},
                           {"ledger", &sidestep_msg_LedgerPage_desc, print_page_of, 0, count},
                           {"world", &sidestep_msg_WorldState_desc, print_world_of, 0, count},
                           {"truth", &sidestep_msg_GroundTruth_desc, print_truth_of, 0, count},
                           {"course", &sidestep_msg_Course_desc, print_course_of, 0, count},
                           {"course_offer", &sidestep_msg_CourseOffer_desc, print_offer_of, 0, count}};
  const int topics = sizeof inputs / sizeof *inputs;
  for (int i = 0; i < topics; ++i) inputs[i].reader = make_reader(inputs[i].name, inputs[i].type);
  const dds_time_t deadline = dds_time() + kTimeout;
  for (;;) {
    int left = 0;
    for (int i = 0; i < topics; ++i) left += print_messages(&inputs[i]);
    if (left == 0) return 0;
    if (dds_time() > deadline) {
      for (int i = 0; i < topics; ++i)
        if (inputs[i].left > 0)
          fprintf(stderr, "cyclone_peer: %s: %d messages are missing\n", inputs[i].name, inputs[i].left);
      return 1;
    }
    check(dds_waitset_wait(wait_set, NULL, 0, DDS_MSECS(100)), "waiting");
  }
}

static void send_order(dds_entity_t writer, uint32_t robot, uint64_t number, double x_m, double y_m) {
  sidestep_msg_OrderPose pose = {.x_m = x_m, .y_m = y_m};
  sidestep_msg_Order order = {.robot = robot};
  order.header.sender = kClient;
  order.header.incarnation = number;
  order.header.message_number = 1;
  order.header.stamp_ns = dds_time();
  order.terms.order_kind = sidestep_msg_ORDER_GO;
  order.terms.order_number = number;
  order.poses._length = order.poses._maximum = 1;
  order.poses._buffer = &pose;
  check(dds_write(writer, &order), "order");
}

static int go(uint32_t robot, double x_m, double y_m) {
  const dds_entity_t status = make_reader("order_status", &sidestep_msg_OrderStatus_desc);
  const dds_entity_t topic = dds_create_topic(participant, &sidestep_msg_Order_desc, "order", NULL, NULL);
  check(topic, "order");
  dds_qos_t* qos = make_qos(true);
  const dds_entity_t writer = dds_create_writer(participant, topic, qos, NULL);
  check(writer, "order");
  dds_delete_qos(qos);
  const uint64_t number = (uint64_t)dds_time();
  const dds_time_t deadline = dds_time() + kTimeout;
  bool is_sent = false;
  dds_time_t next_sending = 0;
  while (dds_time() < deadline) {
    dds_publication_matched_status_t matched;
    check(dds_get_publication_matched_status(writer, &matched), "order");
    // Repeats the order, which changes nothing, because DDS may discover the coordinator late.
    if (matched.current_count > 0 && dds_time() >= next_sending) {
      send_order(writer, robot, number, x_m, y_m);
      is_sent = true;
      next_sending = dds_time() + DDS_MSECS(500);
    }
    sidestep_msg_OrderStatus* sample = NULL;
    void* samples[1] = {NULL};
    dds_sample_info_t info;
    int count;
    while ((count = dds_take(status, samples, &info, 1, 1)) > 0) {
      sample = samples[0];
      const bool has_arrived = info.valid_data && sample->robot == robot && sample->client == kClient &&
                               sample->order_number == number &&
                               sample->order_state == sidestep_msg_ORDER_ARRIVED;
      check(dds_return_loan(status, samples, count), "order_status");
      if (has_arrived) {
        printf("robot %" PRIu32 " has arrived\n", robot);
        return 0;
      }
    }
    check(count, "order_status");
    check(dds_waitset_wait(wait_set, NULL, 0, DDS_MSECS(50)), "waiting");
  }
  fprintf(stderr, "cyclone_peer: the robot did not arrive; the order was %s\n",
          is_sent ? "sent" : "not sent");
  return 1;
}

int main(int argc, char** argv) {
  const bool reads = argc == 5 && strcmp(argv[1], "read") == 0;
  const bool goes = argc == 6 && strcmp(argv[1], "go") == 0;
  if (!reads && !goes) {
    fprintf(stderr, "usage: cyclone_peer read DOMAIN ROBOT COUNT | go DOMAIN ROBOT X Y\n");
    return 2;
  }
  participant = dds_create_participant((dds_domainid_t)atoi(argv[2]), NULL, NULL);
  check(participant, "participant");
  wait_set = dds_create_waitset(participant);
  check(wait_set, "wait set");
  const int result =
      reads ? read_topics(argv[3], atoi(argv[4])) : go((uint32_t)atoi(argv[3]), atof(argv[4]), atof(argv[5]));
  dds_delete(participant);
  return result;
}
