// SPDX-License-Identifier: Apache-2.0
#include "common/process/network_faults.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/drops.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::network_faults_test {

TEST_CASE("a malformed network fault is ignored, logged and counted") {
  DdsSettings settings = test_settings();
  settings.faults = true;
  DdsBus bus(settings), sender(test_settings("sender"));
  apply_network_faults(bus, 3);
  auto writer = sender.advertise(topics::kNetworkFault);
  msg::NetworkFault fault;
  fault.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
  fault.target(3);
  fault.loss(std::numeric_limits<double>::quiet_NaN());
  const CaptureStderr captured;
  const auto is_counted = [&] {
    writer.publish(fault, sender.now());
    return drops_of(bus).total(DropReason::kMalformedNetworkFault) > 0;
  };
  CHECK(run_until(is_counted, bus, sender));
  CHECK(captured.has("network fault: invalid, ignored"));
}

}  // namespace sidestep::network_faults_test
