// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/file/temporary_folder.hpp"
#include "common/json/json_text.hpp"
#include "deploy/inspect/record/recording.hpp"
#include "deploy/inspect/topic/describe.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep {

TEST_CASE("an independent reader of recordings agrees on every field of every topic") {
  const bool is_compressed = GENERATE(false, true);
  CAPTURE(is_compressed);
  const TemporaryFolder folder;
  std::filesystem::copy(SIDESTEP_READER_DIR, folder.path());
  std::size_t topics = 0;
  {
    RecordingWriter writer(folder.file("all.mcap"), {"all", "", nullptr, true},
                           {.is_compressed = is_compressed});
    std::ofstream lines(folder.file("all.json"));
    Rng rng(1);
    std::int64_t now_ns = 0;
    for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
      ++topics;
      std::array<std::uint16_t, 3> channels{};
      for (std::uint32_t robot = 0; robot < (topic.per_robot ? 3 : 1); ++robot)
        channels.at(robot) = writer.add_channel(topic, channel_name(topic, robot));
      for (std::uint32_t i = 0; i < 40; ++i) {
        const bool has_sequence = topic.type.max_elements > 0;
        const auto elements =
            static_cast<std::uint32_t>(std::min<std::size_t>(i % 5, topic.type.max_elements));
        const auto message = random_message<Message>(rng, has_sequence, elements);
        writer.add(time_from_ns(++now_ns), topic, channels.at(topic.per_robot ? i % 3 : 0), message.header(),
                   &message);
        lines << json_text(describe(topic, &message)) << '\n';
      }
    });
    writer.close();
  }
  const auto run = [&](const std::string& command) {
    return std::system(("cd '" + folder.path() + "' && " + command + " >out 2>&1").c_str());
  };
  const auto output = [&] {
    std::ifstream file(folder.file("out"));
    return std::string{std::istreambuf_iterator<char>(file), {}};
  };
  const int installed = run("npm ci --prefer-offline --no-audit --no-fund");
  INFO(output());
  REQUIRE(installed == 0);
  CHECK(run("node check.mjs all.mcap all.json") == 0);
  CHECK_THAT(output(), Matches(fmt::format("{} messages of {} topics, [0-9]{{5,}} fields agree\n",
                                           40 * topics, topics)));
  // Checks that the comparison itself works: it must find a changed digit.
  CHECK(run("sed -i '0,/\"robot\":[0-9]/s//\"robot\":9/' all.json && node check.mjs all.mcap all.json") != 0);
  CHECK_THAT(output(), ContainsSubstring("Sidestep has 9"));
}

}  // namespace sidestep
