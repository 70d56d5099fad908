// SPDX-License-Identifier: Apache-2.0
#include "common/league/multicast.hpp"

#include <algorithm>
#include <poll.h>
#include <sys/socket.h>

#include "common/messaging/dds/event_loop.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/second_sender.hpp"
#include "tests/test_endpoint.hpp"

namespace sidestep::league::multicast_test {

using Bytes = std::vector<std::byte>;

std::string parsed(const std::string& text) {
  try {
    return "accepted as " + to_text(parse_multicast_endpoint(text));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

Bytes random_bytes(Rng& rng, std::size_t size) {
  Bytes bytes(size);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(rng.bits());
  return bytes;
}

/// Receives `count` datagrams, or fewer if none arrives for 10 s.
std::vector<Bytes> received(MulticastReceiver& receiver, std::size_t count) {
  std::vector<Bytes> all;
  pollfd readable{receiver.descriptor(), POLLIN, 0};
  while (all.size() < count && poll(&readable, 1, 10'000) > 0) {
    receiver.receive([&](std::span<const std::byte> bytes, const Endpoint& from) {
      CHECK(from.address == 0x7f000001);
      all.emplace_back(bytes.begin(), bytes.end());
    });
  }
  return all;
}

bool is_readable(const MulticastReceiver& receiver) {
  pollfd readable{receiver.descriptor(), POLLIN, 0};
  return poll(&readable, 1, 0) > 0;
}

TEST_CASE("a multicast address with port is parsed, and the error for other text states the expected form") {
  CHECK(parsed("224.5.23.2:10006") == "accepted as 224.5.23.2:10006");
  CHECK(parsed("239.255.255.255:65535") == "accepted as 239.255.255.255:65535");
  for (const char* text : {kVisionEndpoint, kTrackedEndpoint, kRefereeEndpoint}) {
    CHECK(parsed(text) == std::string("accepted as ") + text);
  }
  for (const char* text : {"", "224.5.23.2", "10006"})
    CHECK_THAT(parsed(text), ContainsSubstring("expected ADDRESS:PORT"));
  for (const char* text : {":10006", "192.168.0.1:10006", "223.255.255.255:1", "240.0.0.0:1", "224.5.23:1",
                           "224.5.23.256:1", "vision:10006", "ff02::1:10006"}) {
    CHECK_THAT(parsed(text),
               ContainsSubstring(std::string("\"") + text + "\": expected a multicast address"));
  }
  for (const char* text : {"224.5.23.2:", "224.5.23.2:0", "224.5.23.2:65536", "224.5.23.2:-1",
                           "224.5.23.2:1x", "224.5.23.2: 1"}) {
    CHECK_THAT(parsed(text), ContainsSubstring("expected a port, 1 to 65535"));
  }
}

TEST_CASE("an unknown interface is rejected with a list of interfaces") {
  const TestEndpoint group;
  for (const char* interface : {"192.0.2.77", "lo", "", "256.0.0.1"}) {
    CAPTURE(interface);
    CHECK_THROWS_WITH(
        MulticastSender(group.endpoint(), interface),
        ContainsSubstring(std::string("\"") + interface + "\"") && ContainsSubstring("127.0.0.1 (lo)"));
    CHECK_THROWS_AS(MulticastReceiver(group.endpoint(), interface), std::invalid_argument);
  }
}

TEST_CASE("every receiver in a group gets all datagrams unchanged") {
  const TestEndpoint group;
  MulticastReceiver first(group.endpoint(), kLeagueInterface), second(group.endpoint(), kLeagueInterface);
  MulticastSender sender(group.endpoint(), kLeagueInterface);
  Rng rng(7);
  std::vector<Bytes> sent;
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{1500}, kMaxDatagramSize}) {
    sent.push_back(random_bytes(rng, size));
    REQUIRE(sender.send(sent.back()));
  }
  CHECK(sender.sent() == 4);
  CHECK_FALSE(sender.send(random_bytes(rng, kMaxDatagramSize + 1)));
  CHECK(sender.failed() == 1);
  CHECK(received(first, 4) == sent);
  CHECK(received(second, 4) == sent);
  CHECK_FALSE(is_readable(first));
}

TEST_CASE("a receiver gets neither another group's datagrams nor unicast datagrams") {
  const TestEndpoint group;
  const Endpoint other{group.endpoint().address ^ 0x100, group.endpoint().port};
  MulticastReceiver receiver(group.endpoint(), kLeagueInterface), of_other(other, kLeagueInterface);
  MulticastSender sender(group.endpoint(), kLeagueInterface), to_other(other, kLeagueInterface);
  // The destination is a unicast address.
  MulticastSender to_host({0x7f000001, group.endpoint().port}, kLeagueInterface);
  const Bytes wrong{std::byte{1}}, right{std::byte{2}};
  REQUIRE(to_other.send(wrong));
  (void)to_host.send(wrong);
  REQUIRE(sender.send(right));
  CHECK(received(receiver, 1) == std::vector<Bytes>{right});
  CHECK_FALSE(is_readable(receiver));
  CHECK(received(of_other, 1) == std::vector<Bytes>{wrong});
}

TEST_CASE("a receiver tells a second sender in its group by address and port") {
  const TestEndpoint group;
  MulticastReceiver receiver(group.endpoint(), kLeagueInterface);
  MulticastSender first(group.endpoint(), kLeagueInterface);
  const std::uint16_t port = group.unicast(1).port;
  SecondSender second(group.endpoint(), {0x7f000002, port}), third(group.endpoint(), {0x7f000001, port});
  VisionPacket packet;
  packet.detection.emplace();
  std::vector<std::pair<Endpoint, std::uint32_t>> all;  // sender and frame number
  for (std::uint32_t number = 1; number <= 3; ++number) {
    packet.detection->frame_number = number;
    if (number == 1) REQUIRE(first.send(encode(packet)));
    if (number == 2) REQUIRE(second.send(packet));
    if (number == 3) REQUIRE(third.send(packet));
  }
  pollfd readable{receiver.descriptor(), POLLIN, 0};
  while (all.size() < 3 && poll(&readable, 1, 10'000) > 0) {
    receiver.receive([&](std::span<const std::byte> bytes, const Endpoint& from) {
      const auto decoded = decode_vision(bytes);
      REQUIRE(decoded.packet);
      all.emplace_back(from, decoded.packet->detection->frame_number);
    });
  }
  REQUIRE(all.size() == 3);
  std::ranges::sort(all, {}, &std::pair<Endpoint, std::uint32_t>::second);
  CHECK(all[0].first.address == 0x7f000001);
  CHECK(all[0].first.port != port);
  CHECK(all[1] == std::pair(Endpoint{0x7f000002, port}, 2U));
  CHECK(all[2] == std::pair(Endpoint{0x7f000001, port}, 3U));
}

TEST_CASE("an event loop delivers datagrams in its thread and sleeps in between") {
  const TestEndpoint group;
  MulticastReceiver receiver(group.endpoint(), kLeagueInterface);
  MulticastSender sender(group.endpoint(), kLeagueInterface);
  EventLoop loop;
  constexpr int kDatagrams = 200;
  int count = 0, wakeups = 0;
  std::function<void()> send = [&] {
    REQUIRE(sender.send(Bytes(1)));
    if (sender.sent() < kDatagrams) loop.at(loop.now() + Duration{500'000}, send);
  };
  loop.watch(receiver.descriptor(), [&] {
    ++wakeups;
    receiver.receive([&](std::span<const std::byte>, const Endpoint&) { ++count; });
    if (count == kDatagrams) loop.stop();
  });
  loop.at(loop.now(), send);
  loop.run_until(loop.now() + std::chrono::seconds(30));
  CHECK(count == kDatagrams);
  CHECK(wakeups <= kDatagrams);
}

}  // namespace sidestep::league::multicast_test
