// SPDX-License-Identifier: Apache-2.0
#include "common/process/bases_bus.hpp"

#include <thread>

#include "common/messaging/ros/ros_messages.hpp"
#include "tests/catch.hpp"
#include "tests/test_domain.hpp"
#include "tests/test_keys.hpp"

namespace sidestep::bases_bus_test {

DdsSettings with_keys(const TestDomain& domain, const TestKeys& keys) {
  DdsSettings settings = domain.settings("robots");
  settings.keys = keys.folder_of("robot 0-1");
  return settings;
}

TEST_CASE("bases have no keys, so a process with keys needs a separate domain for their topics") {
  const TestDomain domain;
  const TestKeys keys({"robot", "0-1"});
  DdsBus bus(with_keys(domain, keys));
  CHECK(bus.has_keys());
  CHECK_THROWS_WITH(bases_bus(bus, {}),
                    ContainsSubstring("bases have no keys") && ContainsSubstring("expected --base-domain"));
  CHECK_THROWS_WITH(bases_bus(bus, {"robot", domain.number()}),
                    ContainsSubstring("DDS domain " + std::to_string(domain.number()) +
                                      " is already the domain of this process"));
}

TEST_CASE("without keys and without a separate domain, bases use the agents' network") {
  const TestDomain domain;
  DdsBus bus(domain.settings());
  CHECK_FALSE(bus.has_keys());
  CHECK(bases_bus(bus, {}).get() == &bus);
}

TEST_CASE("a process with keys exchanges twists with a keyless base in a separate domain and thread") {
  const TestDomain domain, of_bases;
  const TestKeys keys({"robot", "0-1"});
  DdsBus bus(with_keys(domain, keys));
  const std::shared_ptr<Bus> bases = bases_bus(bus, {"robot", of_bases.number()});
  DdsBus base(of_bases.settings("base"));
  DdsBus stranger(domain.settings("stranger"));

  const auto twists = bases->relay(ros::reliable(ros::kTwist), ros::command_channel("robot", 1));
  int odometries = 0, commands = 0;
  const std::thread::id thread = std::this_thread::get_id();
  bases->observe_channel<ros::Odometry>(ros::kOdometry, ros::odometry_channel("robot", 1),
                                        [&](const ros::Odometry&) {
                                          CHECK(std::this_thread::get_id() == thread);
                                          ++odometries;
                                        });
  const auto hear = [&commands](const ros::Twist& twist) { commands += twist.linear[0] == 0.5; };
  base.observe_channel<ros::Twist>(ros::kTwist, ros::command_channel("robot", 1), hear);
  const auto odometry = base.relay(ros::reliable(ros::kOdometry), ros::odometry_channel("robot", 1));
  int strange = 0;
  stranger.observe_channel<ros::Twist>(ros::kTwist, ros::command_channel("robot", 1),
                                       [&](const ros::Twist&) { ++strange; });

  ros::Twist twist;
  twist.linear[0] = 0.5;
  const ros::Odometry report;
  const Time deadline = bus.now() + std::chrono::seconds(30);
  while ((odometries < 10 || commands < 10) && bus.now() < deadline) {
    twists->write(&twist);
    odometry->write(&report);
    for (DdsBus* each : {&bus, &base, &stranger}) each->run_until(each->now() + std::chrono::milliseconds(2));
  }
  CHECK(odometries >= 10);
  CHECK(commands >= 10);
  CHECK(strange == 0);
}

}  // namespace sidestep::bases_bus_test
