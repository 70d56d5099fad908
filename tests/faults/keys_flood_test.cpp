// SPDX-License-Identifier: Apache-2.0
// Ten thousand hostile datagrams a second, on every port of a run with keys.
#include <algorithm>
#include <fmt/format.h>
#include <map>

#include "common/random/rng.hpp"
#include "tests/faults/datagrams.hpp"
#include "tests/faults/keyed_run.hpp"
#include "tests/faults/process_usage.hpp"
#include "tests/participant_datagram.hpp"

namespace sidestep::keys_flood_test {

using std::chrono::seconds;

constexpr int kPerSecond = 10'000;
constexpr double kStanding_mps = 0.05;
constexpr std::uint8_t kFormerProcesses = 100;
constexpr Duration kFormerAge = std::chrono::minutes(10);
/// A process that stored the flood's datagrams would grow by more than this in the shortest flood.
constexpr double kMaxGrowth_mb = 6;

/// Sends the flood. Some of its senders know a genuine announcement.
class FloodSenders {
 public:
  FloodSenders(const KeyedRun& keyed, std::uint64_t seed) : rng_(seed), domain_(keyed.domain()) {
    const TestKeys others({"agent", "0"});
    foreign_ = keyed.with_keys(others.folder_of("agent 0")).announced({});
    for (const char* identity : {"agent 0", "coordinator 0", "vision", "simulator"}) {
      const AttackerSettings genuine = keyed.with_keys(keyed.keys.folder_of(identity), kFormerAge);
      const Certificate certificate = Certificate::load(genuine.keys->certificate);
      // Includes the announcements of earlier processes.
      for (std::uint8_t i = 0; i < kFormerProcesses; ++i) {
        const ParticipantId id = certificate.guid_prefix({i});
        genuine_.emplace_back(id, genuine.announced(id));
      }
    }
  }

  void send(const std::vector<std::uint16_t>& ports) {
    const std::uint16_t port = ports[rng_.below(ports.size())];
    ParticipantId id{};
    for (std::uint8_t& byte : id) byte = random_byte();
    const auto& [former, announced] = genuine_[rng_.below(genuine_.size())];
    const auto prefix = std::span(former).first<6>();
    switch (rng_.below(7)) {
      case 0:
        return sender_.announce(domain_, participant_datagram(id, random_bytes(rng_.below(600))));
      case 1:
        return sender_.announce(domain_, participant_datagram(id, foreign_));
      case 2:
        return sender_.announce(domain_, participant_datagram(former, announced));
      case 3:
        std::ranges::copy(prefix, id.begin());
        return sender_.announce(domain_, participant_datagram(id, announced));
      case 4: {
        std::ranges::copy(prefix, id.begin());
        std::vector<std::uint8_t> datagram = participant_datagram(id, announced);
        for (std::uint64_t i = rng_.below(20); i > 0; --i)
          datagram[20 + rng_.below(datagram.size() - 20)] = random_byte();
        return sender_.send(port, datagram);
      }
      case 5: {
        std::vector<std::uint8_t> datagram{'R', 'T', 'P', 'S', 2, 2, 1, 15};
        std::ranges::copy(prefix, id.begin());
        datagram.insert(datagram.end(), id.begin(), id.end());
        const auto body = random_bytes(rng_.below(1400));
        datagram.insert(datagram.end(), body.begin(), body.end());
        return sender_.send(port, datagram);
      }
      default:
        return sender_.send(port, random_bytes(rng_.below(1400)));
    }
  }

 private:
  std::uint8_t random_byte() { return static_cast<std::uint8_t>(rng_.bits()); }
  std::vector<std::uint8_t> random_bytes(std::uint64_t size) {
    std::vector<std::uint8_t> result(size);
    for (std::uint8_t& byte : result) byte = random_byte();
    return result;
  }

  Rng rng_;
  int domain_;
  DatagramSender sender_;
  std::vector<std::uint8_t> foreign_;
  std::vector<std::pair<ParticipantId, std::vector<std::uint8_t>>> genuine_;
};

void run_flood(Duration duration) {
  KeyedRun keyed;
  LaunchedRun& run = keyed.run;
  Shuttle shuttle(keyed);
  const std::uint64_t seed = 7;
  CAPTURE(seed);
  FloodSenders strangers(keyed, seed);
  INFO(run.output());
  REQUIRE(run.wait_until([&] { return shuttle.drive() >= 3; }));
  const std::vector<std::uint16_t> ports = open_ports(keyed.domain());
  REQUIRE(ports.size() > 10);
  double total_rest_s = 0, longest_s = 0, current_s = 0;
  std::map<std::string, std::vector<MemorySample>> memory;
  int sent = 0;
  const auto flood = [&](Duration length) {
    const Time begin = run.bus().now();
    Time last = begin;
    int count = 0;
    REQUIRE(run.wait_until([&] {
      shuttle.drive();
      const Time now = run.bus().now();
      const double step_s = to_seconds(now - last);
      last = now;
      const bool is_standing = run.max_speed_mps() < kStanding_mps;
      total_rest_s += is_standing ? step_s : 0;
      current_s = is_standing ? current_s + step_s : 0;
      longest_s = std::max(longest_s, current_s);
      // If this process was delayed, it does not catch up in one burst.
      count = std::max(count, static_cast<int>(to_seconds(now - begin) * kPerSecond) - kPerSecond / 10);
      for (; count < to_seconds(now - begin) * kPerSecond; ++count, ++sent) strangers.send(ports);
      return now - begin > length;
    }));
  };
  flood(seconds(5));
  const Time begin = run.bus().now();
  const int arrived_before = shuttle.drive();
  total_rest_s = longest_s = current_s = 0;
  sent = 0;
  const auto sample = [&] {
    for (const auto& [process, usage] : usage_of(run))
      memory[process].push_back({to_seconds(run.bus().now() - begin), usage.memory_mb});
  };
  sample();
  for (Duration left = duration; left > Duration{0}; left -= seconds(5)) {
    flood(std::min<Duration>(left, seconds(5)));
    sample();
  }
  const double flooded_s = to_seconds(run.bus().now() - begin);
  for (const auto& [process, samples] : memory) {
    const double growth_mb = samples.back().memory_mb - samples.front().memory_mb;
    const double second_half_mb = samples.back().memory_mb - samples[samples.size() / 2].memory_mb;
    WARN(fmt::format("{}: {:.1f} MB, grown by {:.2f} MB, of which {:.2f} MB in the second half", process,
                     samples.front().memory_mb, growth_mb, second_half_mb));
    CHECK(growth_mb < kMaxGrowth_mb);
  }
  WARN(fmt::format(
      "{:.0f} datagrams a second to {} ports for {:.0f} s; orders carried out meanwhile: {}; robots stood "
      "still for {:.1f} s, for at most {:.1f} s at a time",
      sent / flooded_s, ports.size(), flooded_s, shuttle.drive() - arrived_before, total_rest_s, longest_s));
  CHECK(sent / flooded_s > 0.8 * kPerSecond);
  const int arrived = shuttle.drive();
  CHECK(run.wait_until([&] { return shuttle.drive() > arrived + 3; }));
  keyed.check_operator_orders();
  const nlohmann::json report = run.report();
  int refused = 0;
  for (const auto& [process, counts] : report["counters"].items())
    refused += counts.value("refused_participant", 0);
  WARN(refused << " announcements refused");
  CHECK(refused > sent);  // several processes receive each multicast announcement
}

TEST_CASE(
    "a flood of unauthorised packets on every port delays robots but causes no contact and no memory growth",
    "[both-cores][slow]") {
  run_flood(seconds(15));
}

TEST_CASE("a flood of unauthorised packets on every port for five minutes does not fill memory",
          "[.long][slow]") {
  run_flood(std::chrono::minutes(5));
}

}  // namespace sidestep::keys_flood_test
