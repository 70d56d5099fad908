// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/open_network.hpp"

#include "tests/catch.hpp"

namespace sidestep::open_network_test {

TEST_CASE("without keys a process starts only if other machines cannot reach it, unless it may be insecure") {
  DdsSettings settings;
  CHECK_NOTHROW(require_safe_network(settings));
  settings.interface = "127.0.0.2";
  CHECK_NOTHROW(require_safe_network(settings));
  for (const char* interface : {"all", "10.1.2.3", "192.168.127.0"}) {
    settings.interface = interface;
    settings.insecure = false;
    CAPTURE(interface);
    CHECK_THROWS_WITH(
        require_safe_network(settings),
        ContainsSubstring("could command the robots; expected --keys") && ContainsSubstring("--insecure"));
    settings.insecure = true;
    CHECK_NOTHROW(require_safe_network(settings));
  }
}

}  // namespace sidestep::open_network_test
