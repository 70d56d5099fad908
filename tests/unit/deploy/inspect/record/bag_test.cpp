// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/bag.hpp"

#include <array>
#include <cmath>
#include <filesystem>

#include "common/file/temporary_folder.hpp"
#include "deploy/inspect/record/playback_bus.hpp"
#include "deploy/inspect/record/recording.hpp"
#include "tests/catch.hpp"

namespace sidestep::bag_test {

constexpr const char* kScenario = "robots:\n  - {id: 0, start_m: [0, 0], goals_m: [[1, 0]]}\n";

/// Records feedback of robots 0 and 1 and ground truth every 10 ms in [from_ms, to_ms].
void record(const std::string& file, int from_ms, int to_ms, const std::string& scenario = kScenario) {
  RecordingWriter writer(file, {"two", scenario, nullptr, true});
  msg::Feedback feedback;
  msg::GroundTruth truth;
  std::uint64_t number = 0;
  const std::array feedbacks{writer.add_channel(topics::kFeedback, "feedback/0"),
                             writer.add_channel(topics::kFeedback, "feedback/1")};
  const std::uint16_t truths = writer.add_channel(topics::kTruth, "truth");
  for (int ms = from_ms; ms <= to_ms; ms += 10) {
    const Time now = time_from_ns(std::int64_t{ms} * 1'000'000);
    for (std::uint32_t robot = 0; robot < 2; ++robot) {
      feedback.robot(robot);
      feedback.header().message_number(++number);
      writer.add(now, topics::kFeedback, feedbacks[robot], feedback.header(), &feedback);
    }
    writer.add(now, topics::kTruth, truths, truth.header(), &truth);
  }
  writer.add_event(time_from_ns(0), "bookmark", "a");
  writer.add_event(time_from_ns(0), "bookmark", "b");
  writer.add_report(time_from_ns(0), "{}");
  writer.close();
}

/// The times of a channel's messages, in ms.
std::vector<int> times_ms(const std::string& file, std::uint32_t robot) {
  PlaybackBus bus(file);
  std::vector<int> times;
  bus.observe<msg::Feedback>(topics::kFeedback, robot, [&](const msg::Feedback& feedback) {
    CHECK(feedback.robot() == robot);
    times.push_back(static_cast<int>(to_ns(bus.now()) / 1'000'000));
  });
  CHECK(bus.play().damage == "");
  return times;
}

TEST_CASE("bag info lists topics, attachments and metadata") {
  const TemporaryFolder folder;
  record(folder.file("a.mcap"), 1000, 2000);
  const BagInfo info = bag_info(folder.file("a.mcap"));
  CHECK(info.messages == 303);
  CHECK(info.first_ns == 1'000'000'000);
  CHECK(info.last_ns == 2'000'000'000);
  CHECK(info.channels.size() == 3);
  CHECK(info.channels.at("feedback/1").messages == 101);
  CHECK(info.channels.at("feedback/1").type == "sidestep::msg::Feedback");
  CHECK(info.attachments.size() == 2);
  CHECK(info.metadata.at("sidestep.scenario") == "two");
  CHECK(info.damage == "");
  const std::string text = to_text(info);
  CHECK_THAT(text, ContainsSubstring("303 messages, 1.000 s from 1.000 s") &&
                       ContainsSubstring("sidestep.complete: true") &&
                       ContainsSubstring("event at 0.000 s: bookmark: a\nevent at 0.000 s: bookmark: b\n") &&
                       ContainsSubstring("attachment: report.json (application/json), 2 bytes"));
  CHECK_THAT(text, Catch::Matchers::Matches("[^]*feedback/1 +sidestep::msg::Feedback +101 +100\\.0 [^]*"));
}

TEST_CASE("bag cut keeps the chosen interval and topics and marks the result as incomplete") {
  const TemporaryFolder folder;
  record(folder.file("a.mcap"), 1000, 2000);
  CHECK(PlaybackBus(folder.file("a.mcap")).header().is_complete);
  CHECK(cut_bag(folder.file("a.mcap"), {0.495, 0.51, {}}, folder.file("b.mcap")) == "");
  CHECK(times_ms(folder.file("b.mcap"), 0) == std::vector<int>{1500, 1510});
  CHECK(times_ms(folder.file("b.mcap"), 1) == std::vector<int>{1500, 1510});
  CHECK_FALSE(PlaybackBus(folder.file("b.mcap")).header().is_complete);
  CHECK(PlaybackBus(folder.file("b.mcap")).header().scenario_text == kScenario);
  CHECK(bag_info(folder.file("b.mcap")).attachments.size() == 2);
  CHECK(bag_info(folder.file("b.mcap")).events.size() == 2);

  CHECK(cut_bag(folder.file("a.mcap"), {0, INFINITY, {"feedback/1"}}, folder.file("c.mcap")) == "");
  CHECK(bag_info(folder.file("c.mcap")).channels.size() == 1);
  CHECK(times_ms(folder.file("c.mcap"), 1).size() == 101);
  CHECK(cut_bag(folder.file("a.mcap"), {0, INFINITY, {"feedback"}}, folder.file("c.mcap")) == "");
  CHECK(bag_info(folder.file("c.mcap")).channels.size() == 2);
}

TEST_CASE("bag cut that would leave no message says what the recording has, and writes nothing") {
  const TemporaryFolder folder;
  record(folder.file("a.mcap"), 1000, 2000);
  const std::string out = folder.file("b.mcap");
  const auto [cut, is_refused] =
      GENERATE(table<BagCut, bool>({{{5, 9, {}}, true},
                                    {{0.001, 0.002, {}}, true},
                                    {{0, INFINITY, {"nothing"}}, true},
                                    {{0, INFINITY, {"nothing", "truth"}}, false}}));
  if (is_refused) {
    CHECK_THROWS_WITH(cut_bag(folder.file("a.mcap"), cut, out),
                      "no message is left, so nothing is written: " + folder.file("a.mcap") +
                          " has 303 messages in 1.000 s, of the topics feedback/0, feedback/1, truth");
  } else {
    CHECK(cut_bag(folder.file("a.mcap"), cut, out) == "");
  }
  CHECK(std::filesystem::exists(out) != is_refused);
}

TEST_CASE("bag merge orders messages by their time of reception") {
  const TemporaryFolder folder;
  record(folder.file("a.mcap"), 1000, 1100);
  record(folder.file("b.mcap"), 1045, 1125);
  CHECK(merge_bags({folder.file("b.mcap"), folder.file("a.mcap")}, folder.file("c.mcap")) == "");
  const std::vector<int> times = times_ms(folder.file("c.mcap"), 1);
  CHECK(times.size() == 11 + 9);
  CHECK(std::ranges::is_sorted(times));
  CHECK(bag_info(folder.file("c.mcap")).channels.size() == 3);
  CHECK(bag_info(folder.file("c.mcap")).attachments.size() == 2);
  CHECK_FALSE(PlaybackBus(folder.file("c.mcap")).header().is_complete);
  record(folder.file("d.mcap"), 0, 10, "robots: []\n");
  CHECK_THROWS_WITH(merge_bags({folder.file("a.mcap"), folder.file("d.mcap")}, folder.file("e.mcap")),
                    ContainsSubstring("of a different scenario"));
  CHECK_FALSE(std::filesystem::exists(folder.file("e.mcap")));
}

TEST_CASE("bag cut copies a damaged recording up to the damage and reports the damage") {
  const TemporaryFolder folder;
  record(folder.file("a.mcap"), 1000, 2500);
  std::filesystem::resize_file(folder.file("a.mcap"), std::filesystem::file_size(folder.file("a.mcap")) / 2);
  CHECK(cut_bag(folder.file("a.mcap"), {}, folder.file("b.mcap")) ==
        "the file ends in the middle of a record");
  CHECK(times_ms(folder.file("b.mcap"), 0).size() > 50);
  CHECK(bag_info(folder.file("a.mcap")).damage == "the file ends in the middle of a record");
}

TEST_CASE("a cut or merge that does not fit on the disk ends with the cause") {
  const TemporaryFolder folder;
  record(folder.file("a.mcap"), 1000, 2000);
  CHECK_THROWS_WITH(cut_bag(folder.file("a.mcap"), {}, "/dev/full"), "/dev/full: No space left on device");
  CHECK_THROWS_WITH(merge_bags({folder.file("a.mcap")}, "/dev/full"), "/dev/full: No space left on device");
  CHECK_THROWS_WITH(cut_bag(folder.file("a.mcap"), {}, folder.file("none/b.mcap")),
                    ContainsSubstring("the folder " + folder.file("none") + " does not exist"));
}

}  // namespace sidestep::bag_test
