// SPDX-License-Identifier: Apache-2.0
// Sidestep together with another vendor's DDS. The peer shares only the IDL with Sidestep.
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <sstream>
#include <sys/wait.h>
#include <thread>

#include "common/json/json_text.hpp"
#include "deploy/inspect/topic/describe.hpp"
#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"
#include "tests/unit/deploy/inspect/topic/compare_described.hpp"

using namespace sidestep;

namespace {

struct PeerOutcome {
  int exit_code = -1;
  std::string output;
};

/// Runs the peer to its end; it ends by itself after at most 30 s.
PeerOutcome run_peer(const std::string& arguments) {
  constexpr const char* kLoopback =
      "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address=\"127.0.0.1\" multicast=\"true\"/>"
      "</Interfaces></General></Domain></CycloneDDS>";
  const std::string command =
      fmt::format("CYCLONEDDS_URI='{}' timeout 60 '{}' {} 2>&1", kLoopback, SIDESTEP_CYCLONE_PEER, arguments);
  std::FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  PeerOutcome outcome;
  char part[4096];
  for (std::size_t size; (size = std::fread(part, 1, sizeof part, pipe)) > 0;)
    outcome.output.append(part, size);
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

/// Publishes random messages of seven topics in its own thread, from construction to destruction.
class RandomPublisher {
 public:
  RandomPublisher() : bus_(test_settings("publisher")) {
    const auto robot = [](auto& message) { message.robot(3); };
    add(topics::kFeedback, 3, robot);
    add(topics::kVerdict, 3, [robot](msg::Verdict& verdict) {
      robot(verdict);
      // Cyclone refuses enum values that are not enumerators.
      verdict.reasons() = {msg::Reason::REASON_GRANTED, msg::Reason::REASON_CONFLICT,
                           msg::Reason::REASON_OBSTACLE, msg::Reason::REASON_MALFORMED,
                           msg::Reason::REASON_GRANTED};
    });
    add(topics::kLedger, 0, [](auto&) {});
    add(topics::kWorld, 0, [](auto&) {});
    add(topics::kTruth, 0, [](auto&) {});
    add(topics::kCourse, 0, robot);
    add(topics::kCourseOffer, 0, robot);
    tick();
    thread_ = std::thread([this] { bus_.run(); });
  }
  ~RandomPublisher() { stop(); }
  void stop() {
    bus_.stop();
    if (thread_.joinable()) thread_.join();
  }
  /// The message that was published on a channel with this number, as JSON. Call it after stop().
  const nlohmann::ordered_json& described(const std::string& channel, std::uint64_t number) {
    return described_[channel][number];
  }

 private:
  template <typename Message, typename Adjust>
  void add(const Topic<Message>& topic, RobotId robot, Adjust adjust) {
    auto writer = std::make_shared<Writer<Message>>(bus_.advertise(topic, robot));
    publish_.push_back([this, writer, topic, channel = channel_name(topic, robot), adjust] {
      const bool has_sequence = topic.type.max_elements > 0;
      Message message = random_message<Message>(rng_, has_sequence, has_sequence ? 3 : 0);
      adjust(message);
      writer->publish(message, bus_.now());
      described_[channel][message.header().message_number()] = describe(topic, &message);
    });
  }
  void tick() {
    for (const auto& publish : publish_) publish();
    bus_.at(bus_.now() + Duration{20'000'000}, [this] { tick(); });
  }

  DdsBus bus_;
  Rng rng_{1};
  std::vector<std::function<void()>> publish_;
  std::map<std::string, std::map<std::uint64_t, nlohmann::ordered_json>> described_;
  std::thread thread_;
};

}  // namespace

TEST_CASE("a Cyclone DDS program decodes every field of messages on seven topics") {
  RandomPublisher publisher;
  const PeerOutcome outcome = run_peer(fmt::format("read {} 3 20", test_settings().domain));
  publisher.stop();
  INFO(outcome.output);
  REQUIRE(outcome.exit_code == 0);
  std::istringstream lines(outcome.output);
  std::map<std::string, int> read;
  for (std::string channel, message; lines >> channel && std::getline(lines, message);) {
    CAPTURE(channel);
    const auto fields = parse_ordered_json(message);
    const auto& described =
        publisher.described(channel, fields["header"]["message_number"].get<std::uint64_t>());
    REQUIRE(described.is_object());
    REQUIRE(described.size() == fields.size());
    require_same_fields(described, fields);
    ++read[channel];
  }
  CHECK(read == std::map<std::string, int>{{"course", 20},
                                           {"course_offer", 20},
                                           {"feedback/3", 20},
                                           {"ledger", 20},
                                           {"truth", 20},
                                           {"verdict/3", 20},
                                           {"world", 20}});
}

TEST_CASE("a robot obeys the order of a Cyclone DDS program") {
  LaunchedRun run(shipped_scenario("on-demand"));
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  const std::vector<std::string> dds = run.dds_arguments();
  const auto domain = std::ranges::find(dds, "--domain");
  REQUIRE(domain != dds.end());
  const PeerOutcome outcome = run_peer(fmt::format("go {} 3 1.25 -0.5", *std::next(domain)));
  INFO(outcome.output);
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.output == "robot 3 has arrived\n");
  std::optional<Vec2> position_m;
  run.bus().subscribe<msg::GroundTruth>(topics::kTruth, [&](const msg::GroundTruth& truth) {
    for (const msg::TrueRobotState& robot : truth.robots())
      if (robot.robot() == 3) position_m = Vec2(robot.x_m(), robot.y_m());
  });
  CHECK(run.wait_until([&] { return position_m && (*position_m - Vec2(1.25, -0.5)).norm() < 0.05; }));
}
