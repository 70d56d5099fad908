// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds_lease.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <memory>
#include <thread>

#include "tests/unit/common/messaging/dds_test_support.hpp"

namespace sidestep {

using namespace std::chrono_literals;
namespace dds = eprosima::fastdds::dds;

namespace {

/// Joins the domain for so long, with a lease so short that the others' timers fire all the while. Whether it
/// could.
bool visit(const DdsSettings& settings, Duration stay) {
  dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.push_back(settings.interface);
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  auto& builtin = qos.wire_protocol().builtin;
  builtin.mutation_tries = 250;
  builtin.discovery_config.leaseDuration = {0, 4'000'000};
  builtin.discovery_config.leaseDuration_announcementperiod = {0, 1'000'000};
  auto* const factory = dds::DomainParticipantFactory::get_instance();
  auto* const visitor = factory->create_participant(static_cast<dds::DomainId_t>(settings.domain), qos);
  if (visitor == nullptr) return false;
  std::this_thread::sleep_for(stay);
  factory->delete_participant(visitor);
  return true;
}

}  // namespace

// With the library's own check this ended the process within half a minute beside a compiler.
TEST_CASE("others leave while the timers of their leases fire, and nobody dies of it") {
  REQUIRE(is_lease_check_ours());
  const DdsSettings settings = test_settings();
  std::vector<std::unique_ptr<DdsBus>> residents;
  for (int i = 0; i < 6; ++i) residents.push_back(std::make_unique<DdsBus>(settings));
  const Time end = EventLoop::now() + 3s;
  std::atomic<int> visits = 0;
  std::vector<std::thread> hosts;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    hosts.emplace_back([&, seed] {
      Rng rng(seed);
      while (EventLoop::now() < end)
        visits += visit(settings, 12ms + std::chrono::duration_cast<Duration>(rng.uniform() * 10ms));
    });
  }
  for (std::thread& host : hosts) host.join();
  CHECK(visits >= 3);
}

}  // namespace sidestep
