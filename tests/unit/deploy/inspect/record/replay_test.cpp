// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/replay.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <thread>

#include "common/file/temporary_folder.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "deploy/inspect/record/recording.hpp"
#include "deploy/inspect/record/replay_command.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::replay_test {

constexpr const char* kScenario = "robots:\n  - {id: 0, start_m: [0, 0], goals_m: [[1, 0]]}\n";

/// A recording of ten messages of feedback and ten of ground truth, 20 ms apart.
struct RecordedFile {
  TemporaryFolder folder;
  std::string path = folder.file("run.mcap");

  RecordedFile() {
    RecordingWriter writer(path, {"one", kScenario, nullptr, true});
    const std::uint16_t feedbacks = writer.add_channel(topics::kFeedback, "feedback/0");
    const std::uint16_t truths = writer.add_channel(topics::kTruth, "truth");
    msg::Feedback feedback;
    msg::GroundTruth truth;
    for (std::uint64_t i = 1; i <= 10; ++i) {
      const Time now = time_from_ns(static_cast<std::int64_t>(i * 20'000'000));
      feedback.header().sender(7);
      feedback.header().message_number(i);
      feedback.header().stamp_ns(to_ns(now));
      truth.header() = feedback.header();
      writer.add(now, topics::kFeedback, feedbacks, feedback.header(), &feedback);
      writer.add(now, topics::kTruth, truths, truth.header(), &truth);
    }
    writer.close();
  }
};

int replay(std::vector<std::string> arguments) {
  CommandLine command_line("test", "test");
  std::function<int()> action;
  add_replay_command(command_line.root(), action);
  const DdsSettings settings = test_settings();
  arguments.insert(arguments.begin(), "replay");
  for (const std::string& argument : {std::string("--domain"), std::to_string(settings.domain),
                                      std::string("--interface"), settings.interface})
    arguments.push_back(argument);
  command_line.parse(arguments);
  return action();
}

/// Runs a replay in a new thread, and a bus of the same domain in this thread. Returns the exit code.
int replay_beside(DdsBus& bus, const std::vector<std::string>& arguments) {
  std::atomic<bool> is_over = false;
  int exit_code = -1;
  std::thread thread([&] {
    exit_code = replay(arguments);
    is_over = true;
  });
  CHECK(run_until([&] { return is_over.load(); }, bus));
  thread.join();
  bus.run_until(bus.now() + Duration(200'000'000));
  return exit_code;
}

TEST_CASE("a replay writes each message as recorded at its recorded time") {
  const RecordedFile file;
  DdsBus bus(test_settings());
  std::vector<msg::Header> headers;
  std::vector<Time> received;
  int truths = 0;
  bus.observe<msg::Feedback>(topics::kFeedback, 0, [&](const msg::Feedback& feedback) {
    headers.push_back(feedback.header());
    received.push_back(bus.now());
  });
  bus.observe<msg::GroundTruth>(topics::kTruth, 0, [&](const msg::GroundTruth&) { ++truths; });
  CHECK(replay_beside(bus, {file.path, "--speed", "0.5"}) == 0);
  CHECK(truths == 10);
  REQUIRE(headers.size() == 10);
  for (std::size_t i = 0; i < headers.size(); ++i) {
    CHECK(headers[i].sender() == 7);
    CHECK(headers[i].message_number() == i + 1);
    CHECK(headers[i].stamp_ns() == static_cast<std::int64_t>((i + 1) * 20'000'000));
  }
  // The recording has 9 intervals of 20 ms and is played at half speed.
  CHECK(to_seconds(received.back() - received.front()) > 0.3);
}

TEST_CASE("a replay writes no commanding messages while another process drives or coordinates") {
  const RecordedFile file;
  DdsBus bus(test_settings());
  auto writer = bus.advertise(topics::kVerdict, 3);
  int feedbacks = 0, truths = 0;
  bus.observe<msg::Feedback>(topics::kFeedback, 0, [&](const msg::Feedback&) { ++feedbacks; });
  bus.observe<msg::GroundTruth>(topics::kTruth, 0, [&](const msg::GroundTruth&) { ++truths; });
  CHECK(replay_beside(bus, {file.path}) == kExitFailure);
  CHECK(feedbacks == 0);
  CHECK(truths == 0);
  CHECK(replay_beside(bus, {file.path, "--topics", "truth"}) == 0);
  CHECK(feedbacks == 0);
  CHECK(truths == 10);
}

TEST_CASE("a replay ends when a process that drives or coordinates appears") {
  const RecordedFile file;
  DdsBus bus(test_settings());
  std::optional<Writer<msg::Verdict>> writer;
  int feedbacks = 0;
  bus.observe<msg::Feedback>(topics::kFeedback, 0, [&](const msg::Feedback&) {
    ++feedbacks;
    if (!writer) writer.emplace(bus.advertise(topics::kVerdict, 3));
  });
  // The last message would be due after 9 s.
  CHECK(replay_beside(bus, {file.path, "--speed", "0.02"}) == kExitFailure);
  CHECK(feedbacks > 0);
  CHECK(feedbacks < 10);
}

TEST_CASE("messages that agents, coordinators, robots and operators write count as commanding") {
  std::string names;
  for (const TopicInfo& topic : all_topics())
    if (is_commanding(topic)) names += std::string(topic.name) + " ";
  CHECK(names ==
        "command feedback registration proposal verdict ledger coordinator attestation order order_memory "
        "agent_orders course course_offer shared_course shared_course_offer disturbance network_fault ");
}

TEST_CASE("a replay of unknown topics or at zero speed is rejected") {
  CHECK_THROWS_AS(replay({"file.mcap", "--topics", "nothing"}), UsageError);
  CHECK_THROWS_AS(replay({"file.mcap", "--speed", "0"}), UsageError);
}

}  // namespace sidestep::replay_test
