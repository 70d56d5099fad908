// SPDX-License-Identifier: Apache-2.0
// Bases with ROS 2's topics for velocities and odometry, also with
// another vendor's DDS.
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

#include "common/json/json_text.hpp"
#include "common/messaging/ros/ros_messages.hpp"
#include "tests/catch.hpp"
#include "tests/faults/keyed_run.hpp"
#include "tests/faults/launched_run.hpp"

using namespace sidestep;

namespace {

using namespace std::chrono_literals;

constexpr const char* kLoopback =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address=\"127.0.0.1\" multicast=\"true\"/>"
    "</Interfaces></General></Domain></CycloneDDS>";

constexpr int kRead = 40;

/// A reader of another vendor's DDS, with ROS 2's default profile, for robot 2.
class RosReader {
 public:
  explicit RosReader(int domain)
      : path_(std::filesystem::temp_directory_path() / fmt::format("sidestep-ros-{}", getpid())) {
    const std::string command =
        fmt::format("CYCLONEDDS_URI='{}' timeout 40 '{}' read {} 2 {} >'{}' 2>&1; echo $? >>'{}' &",
                    kLoopback, SIDESTEP_ROS_PEER, domain, kRead, path_.string(), path_.string());
    REQUIRE(std::system(command.c_str()) == 0);
  }
  ~RosReader() { std::filesystem::remove(path_); }
  RosReader(const RosReader&) = delete;
  RosReader& operator=(const RosReader&) = delete;

  /// Checks that the reader has read odometry and twists of a moving robot.
  void check() const {
    std::ifstream file(path_);
    int twists = 0, odometries = 0;
    double max_speed_mps = 0;
    std::string kind, text;
    while (file >> kind) {
      if (kind == "twist") {
        double vx = 0, vy = 0, wz = 0;
        file >> vx >> vy >> wz;
        max_speed_mps = std::max(max_speed_mps, std::hypot(vx, vy));
        ++twists;
      } else if (kind == "odom") {
        std::string frame, child;
        double value = 0;
        file >> frame >> child;
        CHECK(frame == "odom");
        CHECK(child == "base_link");
        for (int i = 0; i < 6; ++i) file >> value;
        ++odometries;
      } else {
        text += kind + " ";
      }
    }
    INFO(text);
    CHECK(twists == kRead);
    CHECK(odometries == kRead);
    CHECK(max_speed_mps > 0.1);
    CHECK(text == "0 ");
  }

 private:
  std::filesystem::path path_;
};

/// Starts simulated bases alongside a run.
void start_bases(LaunchedRun& run, const std::vector<std::string>& options) {
  std::vector<std::string> arguments{"--scenario", run.scenario_file(), "--velocity", "--latency-ms", "40"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const auto dds = run.dds_arguments();
  arguments.insert(arguments.end(), dds.begin(), dds.end());
  run.start("bases", "sidestep-simulator", arguments);
}

}  // namespace

TEST_CASE("a run with keys drives ROS 2 bases, which have no keys, in a separate domain", "[both-cores]") {
  const auto keys = keys_for(shipped_scenario("bases/four-bases"));
  const TestDomain bases;
  const std::string domain = std::to_string(bases.number());
  LaunchedRun run(
      shipped_scenario("bases/four-bases"),
      {"--driver", "velocity", "--robots=--latency-ms 58 --base-domain " + domain, "--keys", keys->folder()});
  start_bases(run, {"--keys", keys->folder(), "--base-domain", domain});
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.3; }));
  const RosReader reader(bases.number());
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  require_no_violations(run.report());
  CHECK(run.report()["arrived"] == 4);
  reader.check();
}

TEST_CASE(
    "four velocity-controlled bases all arrive without contact, and ROS 2 programs can read their topics",
    "[both-cores]") {
  LaunchedRun run(shipped_scenario("bases/four-bases"), {"--driver", "velocity", "--robots=--latency-ms 58"});
  start_bases(run, {"--odometry-drift", "0.02"});
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.3; }));
  const RosReader reader(std::stoi(run.dds_arguments()[1]));
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 4);
  reader.check();
  WARN("four bases, odometry 2 % off, vision at 10 Hz: makespan "
       << json_text(report["makespan_s"]) << " s, minimum clearance " << json_text(report["min_clearance_m"])
       << " m");
}

TEST_CASE("the template for drivers drives its ideal bases through a whole run", "[both-cores]") {
  LaunchedRun run(shipped_scenario("bases/four-bases"), {"--driver", "skeleton", "--robots=--latency-ms 0"});
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 4);
}

TEST_CASE("twists and odometry published by another vendor's DDS are decoded") {
  const TestDomain domain;
  DdsBus bus(domain.settings("test"));
  std::vector<ros::Odometry> odometry;
  std::vector<ros::Twist> twists;
  bus.observe_channel<ros::Odometry>(ros::kOdometry, ros::odometry_channel("robot", 5),
                                     [&](const ros::Odometry& m) { odometry.push_back(m); });
  bus.observe_channel<ros::Twist>(ros::kTwist, ros::command_channel("robot", 5),
                                  [&](const ros::Twist& m) { twists.push_back(m); });
  const std::string command = fmt::format("CYCLONEDDS_URI='{}' exec timeout 40 '{}' write {} 5 0.75",
                                          kLoopback, SIDESTEP_ROS_PEER, domain.number());
  std::FILE* const peer = popen(("echo $$; " + command).c_str(), "r");
  REQUIRE(peer != nullptr);
  int pid = 0;
  REQUIRE(std::fscanf(peer, "%d", &pid) == 1);
  const Time deadline = bus.now() + 30s;
  while ((odometry.size() < 20 || twists.size() < 20) && bus.now() < deadline)
    bus.run_until(bus.now() + 20ms);
  kill(pid, SIGTERM);
  pclose(peer);
  REQUIRE(odometry.size() >= 20);
  REQUIRE(twists.size() >= 20);
  CHECK(twists.front().linear[0] == 0.75);
  CHECK(odometry.front().child_frame_id == "base_footprint");
  CHECK(odometry.front().orientation[3] == 1);
  CHECK(odometry.back().position[0] - odometry.front().position[0] > 0.1);
}
