// SPDX-License-Identifier: Apache-2.0
// Malformed, hostile and random messages.
#include <limits>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/unit/coordinator/coordinator_fixture.hpp"

namespace sidestep::coordinator_test {

TEST_CASE("hostile proposals are refused or not answered, and change nothing") {
  Floor floor;
  floor.register_both();
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto good = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  const auto spoil = [&](auto change) {
    auto proposal = good;
    change(proposal);
    return floor.ask(proposal).reasons[0];
  };
  auto malformed = msg::Reason::REASON_MALFORMED;
  CHECK(spoil([&](auto& p) { p.candidates()[0].x_m(nan); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].vy_mps(inf); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].phases()[0].ax_mps2(nan); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].phases()[1].duration_ns(-1); }) == malformed);
  CHECK(spoil([&](auto& p) {
          p.candidates()[0].phases()[1].duration_ns(std::numeric_limits<std::int64_t>::max());
        }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].phase_count(200); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].start_ns(-5); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].start_ns(std::numeric_limits<std::int64_t>::max()); }) ==
        malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].robot(2); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].incarnation(2); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidate_count(0); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidate_count(255); }) == malformed);
  for (const auto change :
       {+[](msg::Proposal& p) { p.robot(3); }, +[](msg::Proposal& p) { p.robot(4'000'000'000); },
        +[](msg::Proposal& p) { p.header().sender(2); },
        +[](msg::Proposal& p) {
          p.robot(3);
          p.header().sender(3);
        }}) {
    auto proposal = good;
    change(proposal);
    CHECK_FALSE(floor.receive(proposal));
  }
  CHECK(floor.coordinator.ledger().versions(1).size() == 1);
  CHECK(floor.coordinator.ledger().versions(2).size() == 1);
}

TEST_CASE("random messages of every kind leave the coordinator consistent") {
  int contradictions = 0;
  const std::uint64_t seed = 7;
  CAPTURE(seed);
  Rng rng(seed);
  Floor floor;
  floor.register_both();
  const auto noise = [&](msg::Version& v) {
    switch (rng.below(8)) {
      case 0:
        v.x_m(rng.normal() * 1e6);
        break;
      case 1:
        v.phase_count(static_cast<std::uint8_t>(rng.bits()));
        break;
      case 2:
        v.start_ns(static_cast<std::int64_t>(rng.bits() >> rng.below(40)));
        break;
      case 3:
        v.phases()[0].duration_ns(static_cast<std::int64_t>(rng.bits()));
        break;
      case 4:
        v.base(rng.bits() >> rng.below(64));
        break;
      case 5:
        v.version_number(rng.bits() >> rng.below(64));
        break;
      case 6:
        v.robot(static_cast<std::uint32_t>(rng.bits() >> rng.below(32)));
        break;
      default:
        v.vx_mps(rng.normal());
        break;
    }
  };
  for (int i = 0; i < 100'000; ++i) {
    auto proposal = proposal_of({continued(floor.a, static_cast<VersionNumber>(i), 1, {0, 3})}, kEpoch);
    noise(proposal.candidates()[0]);
    floor.receive(proposal);
    auto registration = registration_of(floor.b, kEpoch, rng.below(3));
    noise(registration.versions()[0]);
    registration.version_count(static_cast<std::uint8_t>(rng.bits()));
    floor.receive(registration);
    auto robot_report = make_report(floor.a, 1);
    noise(robot_report.executing());
    robot_report.valid_at_ns(static_cast<std::int64_t>(rng.bits() >> (16 + rng.below(16))));
    robot_report.is_off_reference(rng.chance(0.5));
    floor.receive(robot_report);
    const bool is_quarantined = floor.coordinator.ledger().is_quarantined(1);
    contradictions += is_quarantined;
    // An own stop with a very high number would make all later facts stale.
    if (is_quarantined || i % 100 == 0) {
      floor.coordinator.begin_epoch(kEpoch);
      floor.register_both();
    }
    REQUIRE_FALSE(floor.coordinator.ledger().versions(1).empty());
    REQUIRE_FALSE(floor.coordinator.ledger().versions(2).empty());
  }
  CHECK(contradictions > 3000);
  CHECK(floor.coordinator.state().grants() > 3000);
}

}  // namespace sidestep::coordinator_test
