// SPDX-License-Identifier: Apache-2.0
#include "common/league/unicast.hpp"

#include <poll.h>

#include "tests/catch.hpp"
#include "tests/test_endpoint.hpp"

namespace sidestep::league {

TEST_CASE("a datagram reaches a socket, and the reply reaches the sender") {
  const TestEndpoint test;
  UnicastSocket server(test.unicast()), client(std::nullopt);
  const std::byte question[]{std::byte{1}, std::byte{2}}, answer[]{std::byte{3}};
  REQUIRE(client.send(question, test.unicast()));
  const auto wait = [](const UnicastSocket& socket) {
    pollfd event{socket.descriptor(), POLLIN, 0};
    return poll(&event, 1, 2000) == 1;
  };
  REQUIRE(wait(server));
  server.receive([&](std::span<const std::byte> datagram, const Endpoint& from) {
    CHECK(std::ranges::equal(datagram, question));
    REQUIRE(server.send(answer, from));
  });
  REQUIRE(wait(client));
  int answers = 0;
  client.receive([&](std::span<const std::byte> datagram, const Endpoint& from) {
    CHECK(std::ranges::equal(datagram, answer));
    CHECK(from == test.unicast());
    ++answers;
  });
  CHECK(answers == 1);
  CHECK_THROWS_WITH(UnicastSocket(test.unicast()), StartsWith(to_text(test.unicast()) + ": cannot listen"));
}

TEST_CASE("host addresses are parsed, and errors name the mistake") {
  CHECK(parse_unicast_endpoint("127.0.0.1:10301") == Endpoint{0x7f000001, 10301});
  CHECK_THROWS_WITH(parse_unicast_endpoint("127.0.0.1"),
                    "\"127.0.0.1\": expected ADDRESS:PORT, such as 127.0.0.1:10300");
  CHECK_THROWS_WITH(parse_unicast_endpoint("224.5.23.2:10006"),
                    ContainsSubstring("expected the IPv4 address of a machine"));
  CHECK_THROWS_WITH(parse_unicast_endpoint("localhost:1"),
                    ContainsSubstring("expected the IPv4 address of a machine"));
  for (const char* wrong : {"1.2.3.4:0", "1.2.3.4:65536", "1.2.3.4:x", "1.2.3.4:"})
    CHECK_THROWS_WITH(parse_unicast_endpoint(wrong), ContainsSubstring("expected a port, 1 to 65535"));
}

}  // namespace sidestep::league
