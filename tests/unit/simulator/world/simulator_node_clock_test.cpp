// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/messaging/robot_codec.hpp"
#include "simulator/world/simulator_node.hpp"
#include "tests/catch.hpp"
#include "tests/unit/simulator/world/commands.hpp"
#include "tests/unit/simulator/world/random_drive.hpp"

namespace sidestep::simulator_node_clock_test {

using std::chrono::milliseconds;
using test::separated_robots;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

// A bus whose clock is set by the test.
class ManualBus : public Bus {
 public:
  Time now() const override { return now_; }
  void at(Time when, std::function<void()> callback) override { timers_.emplace(when, std::move(callback)); }
  void set(Time now) { now_ = now; }
  void run_due() {
    while (!timers_.empty() && timers_.begin()->first <= now_) {
      const auto callback = std::move(timers_.begin()->second);
      timers_.erase(timers_.begin());
      callback();
    }
  }
  void deliver_command(const Command& command) {
    const msg::Command message = encode(command);
    on_command_(&message);
  }
  std::vector<msg::Feedback> robot_reports;

 protected:
  struct Recorder : RawWriter {
    ManualBus* bus = nullptr;
    bool is_robot_report = false;
    void write(const void* message) override {
      if (is_robot_report) bus->robot_reports.push_back(*static_cast<const msg::Feedback*>(message));
    }
  };
  std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string&) override {
    auto writer = std::make_unique<Recorder>();
    writer->bus = this;
    writer->is_robot_report = std::string(topic.name) == topics::kFeedback.name;
    return writer;
  }
  void make_reader(const TopicInfo& topic, const std::string&,
                   std::function<void(const void*)> callback) override {
    if (std::string(topic.name) == topics::kCommand.name) on_command_ = std::move(callback);
  }

 private:
  Time now_ = kBegin;
  std::multimap<Time, std::function<void()>> timers_;
  std::function<void(const void*)> on_command_;
};

TEST_CASE("a simulator catches up after a long pause and continues") {
  const Scenario scenario = separated_robots(1);
  ManualBus bus;
  SimulatorNode node(bus, scenario, 1, 1);
  bus.run_due();
  Trajectory trajectory(kBegin + milliseconds(10), {scenario.robots[0].start_m, {0, 0}});
  trajectory.append(milliseconds(300), Vec2(3, 0));
  append_stop(trajectory, 5);
  bus.deliver_command(test::command_with({0, 1, 1, 0, trajectory}));
  for (const Duration pause : {Duration(milliseconds(900)), Duration(std::chrono::hours(24))}) {
    bus.set(bus.now() + pause);
    bus.run_due();
    CHECK(bus.now() - node.world().time() < milliseconds(2));
    CHECK(bus.robot_reports.back().executing().version_number() == 1);
    CHECK(node.world().reference_error_m(0) < 0.005);
  }
  const Time start = bus.now() + milliseconds(20);
  bus.deliver_command(
      test::command_with({0, 1, 2, 1, Trajectory::resting(start, trajectory.rest_position_m())}));
  bus.set(start + milliseconds(5));
  bus.run_due();
  CHECK(bus.robot_reports.back().executing().version_number() == 2);
  CHECK(node.world().firmware_violations() == 0);
}

TEST_CASE("robots whose host's clock is set back make own stops in a new incarnation") {
  const Scenario scenario = separated_robots(1);
  ManualBus bus;
  SimulatorNode node(bus, scenario, 1, 1);
  bus.set(kBegin + milliseconds(500));
  bus.run_due();
  const msg::Feedback before = bus.robot_reports.back();
  bus.set(kBegin + milliseconds(400));
  const Vec2 mark = scenario.robots[0].start_m;
  // The robot leaves this version's base because of the jump.
  bus.deliver_command(
      test::command_with({0, 1, 1, 0, Trajectory::resting(kBegin + milliseconds(450), mark)}));
  bus.set(kBegin + milliseconds(600));
  bus.run_due();
  const msg::Feedback& after = bus.robot_reports.back();
  CHECK(after.header().incarnation() > before.header().incarnation());
  CHECK(after.is_off_reference());
  CHECK(after.executing().version_number() > 1);
  CHECK(node.world().firmware(0).own_stops() == 1);
  CHECK(node.world().firmware_violations() == 0);
}

}  // namespace sidestep::simulator_node_clock_test
