// SPDX-License-Identifier: Apache-2.0
// A program of another vendor's DDS, built from ROS 2's message definitions alone.
//   ros_peer read DOMAIN ROBOT COUNT   prints COUNT twists and COUNT odometries of a robot, as lines
//                                      "twist VX VY WZ" and "odom FRAME CHILD X Y YAW VX VY WZ"
//   ros_peer write DOMAIN ROBOT VX     sends twists to a robot and odometry of it, until it is killed
#include <dds/dds.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "velocity_messages.h"

static const dds_duration_t kTimeout = DDS_SECS(30);

static void check(dds_return_t result, const char* what) {
  if (result >= 0) return;
  fprintf(stderr, "ros_peer: %s: %s\n", what, dds_strretcode(-result));
  exit(1);
}

// The profile that ROS 2's subscriptions and publishers have by default.
static dds_qos_t* default_profile(void) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
  dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
  const dds_data_representation_id_t plain = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos, 1, &plain);
  return qos;
}

static dds_entity_t topic(dds_entity_t participant, const dds_topic_descriptor_t* type, int robot, const char* name) {
  char text[64];
  snprintf(text, sizeof text, "rt/robot%d/%s", robot, name);
  const dds_entity_t entity = dds_create_topic(participant, type, text, NULL, NULL);
  check(entity, text);
  return entity;
}

static void print_twist(const geometry_msgs_msg_dds__Twist_* m) {
  printf("twist %.6f %.6f %.6f\n", m->linear_.x_, m->linear_.y_, m->angular_.z_);
}

static void print_odometry(const nav_msgs_msg_dds__Odometry_* m) {
  const geometry_msgs_msg_dds__Pose_* pose = &m->pose_.pose_;
  printf("odom %s %s %.6f %.6f %.6f %.6f %.6f %.6f\n", m->header_.frame_id_, m->child_frame_id_, pose->position_.x_,
         pose->position_.y_, 2 * atan2(pose->orientation_.z_, pose->orientation_.w_), m->twist_.twist_.linear_.x_,
         m->twist_.twist_.linear_.y_, m->twist_.twist_.angular_.z_);
}

static int read_some(dds_entity_t reader, int wanted, void (*print)(const void*)) {
  void* sample = NULL;
  dds_sample_info_t info;
  int count = 0;
  while (count < wanted && dds_take(reader, &sample, &info, 1, 1) > 0) {
    if (info.valid_data) print(sample), ++count;
    dds_return_loan(reader, &sample, 1);
    sample = NULL;
  }
  return count;
}

static int read_both(dds_entity_t participant, int robot, int count) {
  dds_qos_t* qos = default_profile();
  const dds_entity_t twists = dds_create_reader(participant, topic(participant, &geometry_msgs_msg_dds__Twist__desc, robot, "cmd_vel"), qos, NULL);
  const dds_entity_t odometry = dds_create_reader(participant, topic(participant, &nav_msgs_msg_dds__Odometry__desc, robot, "odom"), qos, NULL);
  check(twists, "reader of twists");
  check(odometry, "reader of odometry");
  int missing_twists = count, missing_odometry = count;
  const dds_time_t deadline = dds_time() + kTimeout;
  while ((missing_twists > 0 || missing_odometry > 0) && dds_time() < deadline) {
    missing_twists -= read_some(twists, missing_twists, (void (*)(const void*))print_twist);
    missing_odometry -= read_some(odometry, missing_odometry, (void (*)(const void*))print_odometry);
    dds_sleepfor(DDS_MSECS(5));
  }
  return missing_twists > 0 || missing_odometry > 0;
}

static int write_both(dds_entity_t participant, int robot, double vx) {
  dds_qos_t* qos = default_profile();
  const dds_entity_t twists = dds_create_writer(participant, topic(participant, &geometry_msgs_msg_dds__Twist__desc, robot, "cmd_vel"), qos, NULL);
  const dds_entity_t odometry = dds_create_writer(participant, topic(participant, &nav_msgs_msg_dds__Odometry__desc, robot, "odom"), qos, NULL);
  check(twists, "writer of twists");
  check(odometry, "writer of odometry");
  for (int i = 0; i < 1500; ++i) {
    geometry_msgs_msg_dds__Twist_ twist;
    memset(&twist, 0, sizeof twist);
    twist.linear_.x_ = vx;
    check(dds_write(twists, &twist), "twist");
    nav_msgs_msg_dds__Odometry_ odom;
    memset(&odom, 0, sizeof odom);
    odom.header_.frame_id_ = (char*)"odom";
    odom.child_frame_id_ = (char*)"base_footprint";
    odom.pose_.pose_.position_.x_ = 0.02 * vx * i;
    odom.pose_.pose_.orientation_.w_ = 1;
    check(dds_write(odometry, &odom), "odometry");
    dds_sleepfor(DDS_MSECS(20));
  }
  return 0;
}

int main(int argc, char** argv) {
  if (argc != 5) {
    fprintf(stderr, "usage: ros_peer read|write DOMAIN ROBOT COUNT|VX\n");
    return 2;
  }
  setvbuf(stdout, NULL, _IOLBF, 0);
  const dds_entity_t participant = dds_create_participant((dds_domainid_t)atoi(argv[2]), NULL, NULL);
  check(participant, "participant");
  const int robot = atoi(argv[3]);
  const int result = strcmp(argv[1], "read") == 0 ? read_both(participant, robot, atoi(argv[4])) : write_both(participant, robot, atof(argv[4]));
  dds_delete(participant);
  return result;
}
