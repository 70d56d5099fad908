// SPDX-License-Identifier: Apache-2.0
#include "agents/tactics/referee_rules.hpp"

#include "common/geometry/convex_polygon.hpp"
#include "tests/catch.hpp"

namespace sidestep::referee_rules_test {

using league::RefereeCommand;

constexpr Field kDivisionA{12, 9};

league::RefereePacket packet(RefereeCommand command, std::optional<Vec2> position_m = {}) {
  return {Duration{0}, command, 0, {}, position_m};
}

/// The distance of a point from a zone; negative inside.
double distance_m(const Zone& zone, const Vec2& p) {
  if (zone.corners_m.size() < 3)
    return std::sqrt(squared_distance(p, Segment{zone.corners_m.front(), zone.corners_m.back()})) -
           zone.radius_m;
  return signed_distance(p, zone.corners_m) - zone.radius_m;
}

TEST_CASE("every command either stops play and limits the speed, or does neither") {
  const RefereeRules rules(kDivisionA, {});
  for (std::size_t i = 0; i < league::kRefereeCommands; ++i) {
    const auto command = static_cast<RefereeCommand>(i);
    CAPTURE(name_of(command));
    const RefereeDemands demands = rules.demands(packet(command), BallState{{1, 2}});
    const bool is_stopped = i <= 1 || (i >= 12 && i <= 15);
    CHECK(demands.holds == (command == RefereeCommand::kHalt));
    CHECK(demands.zones.contains(kFloorZone) == is_stopped);
    CHECK(demands.zones.contains(kBallZone) == (is_stopped || i >= 16));
    CHECK_FALSE(demands.zones.contains(kLeftAreaZone));
  }
}

TEST_CASE(
    "after STOP robots drive slowly everywhere and keep half a metre between their edges and the ball's") {
  const RefereeRules rules(kDivisionA, {});
  const RefereeDemands demands = rules.demands(packet(RefereeCommand::kStop), BallState{{1, 2}});
  const Zone& floor = demands.zones.at(kFloorZone);
  REQUIRE(floor.speed_limit_mps);
  CHECK(*floor.speed_limit_mps < 1.5);
  CHECK(*floor.speed_limit_mps > 1.3);
  for (const Vec2& corner : {Vec2(6, 4.5), Vec2(-6, 4.5), Vec2(6, -4.5), Vec2(0, 0)})
    CHECK(distance_m(floor, corner) < -0.5);
  const Zone& ball = demands.zones.at(kBallZone);
  CHECK_FALSE(ball.speed_limit_mps);
  REQUIRE(ball.corners_m.size() == 1);
  CHECK(ball.corners_m[0] == Vec2(1, 2));
  CHECK(ball.radius_m > 0.0215 + 0.5 + kZoneTolerance_m);
  CHECK(ball.radius_m < 0.6);
}

TEST_CASE("robots leave the line along which the ball rolls") {
  const RefereeRules rules(kDivisionA, {});
  const auto zones = [&](const Vec2& velocity_mps) {
    return rules.demands(packet(RefereeCommand::kStop), BallState{{1, 2}, velocity_mps}).zones;
  };
  CHECK_FALSE(zones({0.05, 0}).contains(kBallPathZone));
  const auto end_m = [&](const Vec2& velocity_mps) {
    const Zone zone = zones(velocity_mps).at(kBallPathZone);
    REQUIRE(zone.corners_m.size() == 2);
    CHECK(zone.corners_m[0] == Vec2(1, 2));
    CHECK(zone.radius_m == zones(velocity_mps).at(kBallZone).radius_m);
    return zone.corners_m[1];
  };
  CHECK((end_m({0, -1}) - Vec2(1, 1)).norm() < 1e-9);
  CHECK((end_m({8, 0}) - Vec2(3, 2)).norm() < 1e-9);
}

TEST_CASE("ball placement closes the area between the ball and its target to the other team") {
  const auto demands = [](RefereeCommand command, std::optional<Team> team,
                          std::optional<BallState> ball = BallState{{1, 2}}) {
    RefereeSettings settings;
    settings.team = team;
    return RefereeRules(kDivisionA, settings).demands(packet(command, Vec2(-1, 2)), ball);
  };
  const Zone zone = demands(RefereeCommand::kBallPlacementBlue, {}).zones.at(kBallZone);
  CHECK(distance_m(zone, {0, 2.5}) < -0.02);
  CHECK(distance_m(zone, {-1.5, 2}) < -0.02);
  CHECK(distance_m(zone, {0, 2.7}) > 0);
  CHECK(demands(RefereeCommand::kBallPlacementBlue, Team::kYellow).zones.contains(kBallZone));
  CHECK_FALSE(demands(RefereeCommand::kBallPlacementBlue, Team::kBlue).zones.contains(kBallZone));
  CHECK(demands(RefereeCommand::kBallPlacementYellow, Team::kBlue).zones.contains(kBallZone));
  const Zone place = demands(RefereeCommand::kBallPlacementBlue, {}, std::nullopt).zones.at(kBallZone);
  REQUIRE(place.corners_m.size() == 1);
  CHECK(place.corners_m[0] == Vec2(-1, 2));
}

TEST_CASE("a team keeps away from the ball before the other team's kicks but not before its own") {
  RefereeSettings settings;
  settings.team = Team::kBlue;
  const RefereeRules rules(kDivisionA, settings);
  const auto keeps_off = [&](RefereeCommand command) {
    return rules.demands(packet(command), BallState{}).zones.contains(kBallZone);
  };
  CHECK(keeps_off(RefereeCommand::kDirectFreeYellow));
  CHECK(keeps_off(RefereeCommand::kPrepareKickoffYellow));
  CHECK_FALSE(keeps_off(RefereeCommand::kDirectFreeBlue));
  CHECK_FALSE(keeps_off(RefereeCommand::kPreparePenaltyBlue));
  CHECK_FALSE(keeps_off(RefereeCommand::kNormalStart));
}

TEST_CASE("there is no zone around a ball that was never seen") {
  const RefereeRules rules(kDivisionA, {});
  const RefereeDemands demands = rules.demands(packet(RefereeCommand::kStop), std::nullopt);
  CHECK_FALSE(demands.zones.contains(kBallZone));
  CHECK(demands.zones.contains(kFloorZone));
}

TEST_CASE("defence areas are closed on request, with extra distance while the ball is out of play") {
  RefereeSettings settings;
  settings.closes_defence_areas = true;
  const RefereeRules rules(kDivisionA, settings);
  for (const auto command : {RefereeCommand::kStop, RefereeCommand::kForceStart}) {
    const auto zones = rules.demands(packet(command), std::nullopt).zones;
    const double extra_m = command == RefereeCommand::kStop ? 0.2 : 0;
    for (const double side : {-1, 1}) {
      CAPTURE(name_of(command), side);
      const Zone& area = zones.at(side < 0 ? kLeftAreaZone : kRightAreaZone);
      CHECK(distance_m(area, {side * 5.9, 0}) < 0);
      CHECK(distance_m(area, {side * 4.2, 0}) == Approx(-extra_m));
      CHECK(distance_m(area, {side * 5, 1.8}) == Approx(-extra_m));
      CHECK(distance_m(area, {side * 5, -1.8}) == Approx(-extra_m));
      CHECK(distance_m(area, {side * 3.9, 0}) > 0);
    }
  }
}

}  // namespace sidestep::referee_rules_test
