// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "common/messaging/reliability.hpp"
#include "common/messaging/topics.hpp"
#include "tests/catch.hpp"

namespace sidestep {

/// Tests of messages on a reliable topic (Qos::kEvent). They run on the simulated network and over DDS, which
/// must behave alike. A rig has a process that writes and a process that reads:
///
///     void start_writer(), kill_writer(), start_reader(), kill_reader()   kill as by kill -9
///     void write(number, key)            makes the writer publish a message, and waits until it has
///     std::vector<std::uint64_t> received     the numbers that the reader has received, except 0
///     int markers                             how often the reader has received 0
///     void cut(), heal()                 block and unblock the writer's messages
///     void lose(fraction)                lose this fraction of messages at random
///     void run_for(duration)
///     bool wait_until(condition)         false if the condition stays false for very long
///     void stop_writer(duration)         SIGSTOP, then SIGCONT; then immediately publishes 1
namespace reliable_topics {

using std::chrono::milliseconds;
using Numbers = std::vector<std::uint64_t>;

inline Numbers range(std::uint64_t first, std::uint64_t last) {
  Numbers result(last + 1 - first);
  std::iota(result.begin(), result.end(), first);
  return result;
}

/// Waits until the reader hears the writer.
template <typename Rig>
void connect(Rig& rig) {
  rig.markers = 0;
  REQUIRE(rig.wait_until([&] {
    rig.write(0, 0);
    return rig.markers > 0;
  }));
}

template <typename Rig>
void start_both(Rig& rig) {
  rig.start_reader();
  rig.start_writer();
  connect(rig);
}

/// Writes the numbers with the keys 0 to `keys` - 1 in turn.
template <typename Rig>
void write_all(Rig& rig, const Numbers& numbers, std::uint32_t keys = 1) {
  for (const std::uint64_t number : numbers) rig.write(number, static_cast<std::uint32_t>(number) % keys);
}

/// Writes a message with this number. Returns whether the reader receives it.
template <typename Rig>
bool hears(Rig& rig, std::uint64_t number) {
  rig.write(number, 0);
  return rig.wait_until([&] { return !rig.received.empty() && rig.received.back() == number; });
}

template <typename Rig>
void check_resend_after_cut(Rig& rig) {
  start_both(rig);
  rig.cut();
  write_all(rig, range(1, 10));
  rig.run_for(milliseconds(300));
  CHECK(rig.received.empty());
  rig.heal();
  REQUIRE(hears(rig, 11));
  CHECK(rig.received == range(1, 11));
}

template <typename Rig>
void check_loss_with_writer(Rig& rig) {
  start_both(rig);
  rig.cut();
  write_all(rig, range(1, 10));
  rig.run_for(milliseconds(300));
  rig.kill_writer();
  rig.heal();
  rig.start_writer();
  connect(rig);
  REQUIRE(hears(rig, 11));
  CHECK(rig.received == Numbers{11});
}

template <typename Rig>
void check_history_of_one_key(Rig& rig) {
  start_both(rig);
  rig.cut();
  write_all(rig, range(1, 100));
  rig.run_for(milliseconds(300));
  rig.heal();
  REQUIRE(rig.wait_until([&] { return rig.received.size() >= kEventDepth; }));
  REQUIRE(hears(rig, 101));
  CHECK(rig.received == range(101 - kEventDepth, 101));
}

template <typename Rig>
void check_history_of_two_keys(Rig& rig) {
  start_both(rig);
  rig.cut();
  write_all(rig, range(1, 2 * kEventDepth), 2);
  rig.run_for(milliseconds(300));
  rig.heal();
  REQUIRE(rig.wait_until([&] { return rig.received.size() >= 2 * kEventDepth; }));
  // Fast DDS delivers waiting messages to a reader key by key.
  const auto is_even = [](std::uint64_t number) { return number % 2 == 0; };
  Numbers received = rig.received;
  std::ranges::stable_partition(received, is_even);
  Numbers expected = range(1, 2 * kEventDepth);
  std::ranges::stable_partition(expected, is_even);
  CHECK(received == expected);
}

template <typename Rig>
void nothing_for_a_late_reader(Rig& rig) {
  rig.start_writer();
  write_all(rig, range(1, 10));
  rig.run_for(milliseconds(500));
  rig.start_reader();
  connect(rig);
  REQUIRE(hears(rig, 11));
  CHECK(rig.received == Numbers{11});
}

template <typename Rig>
void nothing_for_a_restarted_reader(Rig& rig) {
  start_both(rig);
  rig.kill_reader();
  write_all(rig, range(1, 10));
  rig.start_reader();
  connect(rig);
  REQUIRE(hears(rig, 11));
  CHECK(rig.received == Numbers{11});
}

template <typename Rig>
void nothing_before_discovery(Rig& rig) {
  rig.start_reader();
  rig.run_for(milliseconds(500));
  rig.start_writer();
  rig.write(1, 0);
  connect(rig);
  REQUIRE(hears(rig, 2));
  CHECK(rig.received == Numbers{2});
}

template <typename Rig>
void late_but_in_order_with_losses(Rig& rig) {
  start_both(rig);
  rig.lose(0.3);
  for (const std::uint64_t number : range(1, 200)) {
    rig.write(number, 0);
    rig.run_for(milliseconds(20));
  }
  REQUIRE(rig.wait_until([&] { return !rig.received.empty() && rig.received.back() == 200; }));
  CHECK(rig.received == range(1, 200));
}

template <typename Rig>
void lost_after_a_long_stop(Rig& rig) {
  start_both(rig);
  rig.stop_writer(kSilenceLimit + milliseconds(2000));
  connect(rig);
  REQUIRE(hears(rig, 2));
  CHECK(rig.received == Numbers{2});
}

}  // namespace reliable_topics
}  // namespace sidestep

/// Defines the tests for a rig.
#define SIDESTEP_TEST_RELIABLE_TOPICS(Rig, network)                                                    \
  TEST_CASE("reliable messages are sent again in order after a cut, " network) {                       \
    Rig rig;                                                                                           \
    reliable_topics::check_resend_after_cut(rig);                                                      \
  }                                                                                                    \
  TEST_CASE("undelivered reliable messages are lost with their writer, " network) {                    \
    Rig rig;                                                                                           \
    reliable_topics::check_loss_with_writer(rig);                                                      \
  }                                                                                                    \
  TEST_CASE("a writer keeps its last 64 messages of a key for a reader that is cut off, " network) {   \
    Rig rig;                                                                                           \
    reliable_topics::check_history_of_one_key(rig);                                                    \
  }                                                                                                    \
  TEST_CASE("a writer keeps the last messages of each key and their order within the key, " network) { \
    Rig rig;                                                                                           \
    reliable_topics::check_history_of_two_keys(rig);                                                   \
  }                                                                                                    \
  TEST_CASE("a reader that starts late gets no earlier reliable messages, " network) {                 \
    Rig rig;                                                                                           \
    reliable_topics::nothing_for_a_late_reader(rig);                                                   \
  }                                                                                                    \
  TEST_CASE("a restarted reader misses the reliable messages sent while it was down, " network) {      \
    Rig rig;                                                                                           \
    reliable_topics::nothing_for_a_restarted_reader(rig);                                              \
  }                                                                                                    \
  TEST_CASE("messages written before other processes have discovered the writer are lost, " network) { \
    Rig rig;                                                                                           \
    reliable_topics::nothing_before_discovery(rig);                                                    \
  }                                                                                                    \
  TEST_CASE("with random losses all reliable messages arrive late but in order, " network) {           \
    Rig rig;                                                                                           \
    reliable_topics::late_but_in_order_with_losses(rig);                                               \
  }                                                                                                    \
  TEST_CASE("messages written right after a stop of eight seconds are lost, " network) {               \
    Rig rig;                                                                                           \
    reliable_topics::lost_after_a_long_stop(rig);                                                      \
  }
