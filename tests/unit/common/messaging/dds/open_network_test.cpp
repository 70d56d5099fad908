// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/open_network.hpp"

#include "tests/catch.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::open_network_test {

// One test case, because a process warns only once.
TEST_CASE(
    "without keys a process that other machines can reach starts only if it may be insecure, and warns "
    "once") {
  DdsSettings settings;
  const CaptureStderr captured;
  for (const char* interface : {"127.0.0.1", "127.0.0.2"}) {
    settings.interface = interface;
    for (const bool insecure : {false, true}) {
      settings.insecure = insecure;
      CAPTURE(interface, insecure);
      CHECK_NOTHROW(require_safe_network(settings));
    }
  }
  CHECK(captured.text().empty());
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
  const std::string text = captured.text(), warning = "no keys: any machine on this network can command";
  const auto at = text.find(warning);
  REQUIRE(at != std::string::npos);
  CHECK(text.find(warning, at + 1) == std::string::npos);
}

}  // namespace sidestep::open_network_test
