// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/laser_tracks.hpp"

#include "tests/catch.hpp"
#include "tests/unit/agents/perception/scene.hpp"

namespace sidestep::laser_tracks_test {

constexpr LaserSettings kLaser{540, 2 * std::numbers::pi, 0.05, 8};
constexpr double kScan_s = 1.0 / 15;
constexpr test::ScanNoise kNoise{0.015, 0.05, 0.03};

Time at_s(double seconds) { return time_from_ns(1'000'000'000) + from_seconds(seconds); }

/// A robot with a laser that drives among walls and people.
class Drive {
 public:
  Drive(std::uint64_t seed, int people, bool has_map) : rng_(seed), scene_(seed, kLaser), has_map_(has_map) {
    for (int i = 0; i < people; ++i) {
      const double radius_m = rng_.uniform(0.15, 0.3), speed = rng_.uniform(0.5, 1.5);
      people_.emplace_back(scene_, rng_, radius_m, speed);
    }
    robot_ = std::make_unique<test::Walker>(scene_, rng_, 0.25, 0.8);
  }

  void step() {
    now_s_ += kScan_s;
    robot_->step(scene_, rng_, kScan_s);
    discs_.clear();
    for (test::Walker& person : people_) {
      person.step(scene_, rng_, kScan_s);
      discs_.push_back(person.disc());
    }
    // The pose of the scan also has a small error.
    LaserScan scan = scene_.scan(robot_->at_m(), robot_->heading_rad(), at_s(now_s_), discs_, kNoise, rng_);
    scan.at_m += 0.005 * Vec2(rng_.uniform(-1, 1), rng_.uniform(-1, 1));
    scan.heading_rad += rng_.uniform(-0.003, 0.003);
    beams_.read(scan, {});
    REQUIRE(tracks_.update(beams_, grid_, has_map_ ? PriorMap{&scene_.map()} : PriorMap{}));
    REQUIRE(grid_.update(beams_));
  }
  /// Number of beams that end at a person.
  int beams_on(const test::Walker& person) const {
    return static_cast<int>(std::ranges::count_if(beams_.all(), [&](const Beam& beam) {
      return beam.end == BeamEnd::kHit &&
             std::abs((beams_.end_m(beam) - person.at_m()).norm() - person.disc().radius_m) < 0.06;
    }));
  }
  std::span<const test::Walker> people() const { return people_; }
  const test::Walker& robot() const { return *robot_; }
  const LaserTracks& tracks() const { return tracks_; }
  const LaserBeams& beams() const { return beams_; }
  double now_s() const { return now_s_; }

 private:
  Rng rng_;
  test::Scene scene_;
  bool has_map_;
  std::vector<test::Walker> people_;
  std::unique_ptr<test::Walker> robot_;
  std::vector<Circle> discs_;
  LaserBeams beams_{kLaser};
  LocalGrid grid_;
  LaserTracks tracks_;
  double now_s_ = 0;
};

TEST_CASE("walls do not appear to move while the robot drives and turns") {
  const bool has_map = GENERATE(false, true);
  int tracks = 0, moving = 0;
  double driven_m = 0, turned_rad = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    INFO("seed " << seed << ", map " << has_map);
    Drive drive(seed, 0, has_map);
    int moving_here = 0;
    for (int scan = 0; scan < 450; ++scan) {
      const Vec2 before = drive.robot().at_m();
      const double heading_rad = drive.robot().heading_rad();
      drive.step();
      driven_m += (drive.robot().at_m() - before).norm();
      turned_rad += std::abs(drive.robot().heading_rad() - heading_rad);
      for (const LaserTrack& track : drive.tracks().tracks()) {
        ++tracks;
        moving_here += track.is_moving;
      }
    }
    CHECK(moving_here == 0);
    moving += moving_here;
  }
  CHECK(driven_m > 100);
  CHECK(turned_rad > 100);
  // Without a map, newly seen parts of walls are tracked but recognised as stationary.
  if (!has_map) CHECK(tracks > 1000);
  WARN("map " << has_map << ": " << tracks << " tracks of walls, " << moving << " moving");
}

TEST_CASE("people who walk among walls are tracked") {
  const bool has_map = GENERATE(false, true);
  int visible = 0, tracked = 0, moving = 0, phantoms = 0, all = 0, all_moving = 0;
  double speed_error_mps = 0, radius_error_m = 0, position_error_m = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    INFO("seed " << seed << ", map " << has_map);
    Drive drive(seed, 5, has_map);
    std::vector<double> seen_s(drive.people().size(), 0);  // time for which each person has been seen walking
    for (int scan = 0; scan < 400; ++scan) {
      drive.step();
      const auto tracks = drive.tracks().tracks();
      for (std::size_t i = 0; i < drive.people().size(); ++i) {
        const test::Walker& person = drive.people()[i];
        const bool is_seen = drive.beams_on(person) >= 6 && person.velocity_mps().norm() > 0;
        seen_s[i] = is_seen ? seen_s[i] + kScan_s : 0;
        if (seen_s[i] < 1) continue;
        ++visible;
        const LaserTrack* nearest = nullptr;
        for (const LaserTrack& track : tracks)
          if (track.seen_at == at_s(drive.now_s()) &&
              (nearest == nullptr ||
               (track.position_m - person.at_m()).norm() < (nearest->position_m - person.at_m()).norm()))
            nearest = &track;
        if (nearest == nullptr || (nearest->position_m - person.at_m()).norm() > 0.4) continue;
        ++tracked;
        moving += nearest->is_moving;
        speed_error_mps += (nearest->velocity_mps - person.velocity_mps()).norm();
        position_error_m += (nearest->position_m - person.at_m()).norm();
        radius_error_m += std::abs(nearest->radius_m - person.disc().radius_m);
      }
      for (const LaserTrack& track : tracks) {
        ++all;
        all_moving += track.is_moving;
        if (track.is_moving && track.seen_at == at_s(drive.now_s()) &&
            std::ranges::none_of(drive.people(), [&](const test::Walker& person) {
              return (track.position_m - person.at_m()).norm() < 1;
            }))
          ++phantoms;
      }
    }
  }
  WARN("map " << has_map << ": visible " << visible << ", tracked " << 100.0 * tracked / visible
              << " %, moving " << 100.0 * moving / visible << " %, errors: velocity "
              << speed_error_mps / tracked << " m/s, position " << position_error_m / tracked << " m, radius "
              << radius_error_m / tracked << " m; moving tracks " << all_moving << " of " << all
              << ", phantoms " << phantoms);
  CHECK(visible > 2000);
  CHECK(tracked > 0.9 * visible);
  CHECK(moving > 0.8 * visible);
  CHECK(speed_error_mps < 0.3 * tracked);
  CHECK(phantoms < 0.01 * all_moving);
}

/// A robot at rest in the middle of an empty hall with one disc.
struct Hall {
  LaserScanner scanner{kLaser};
  LaserBeams beams{kLaser};
  LocalGrid grid;
  LaserTracks tracks;
  double now_s = 0;

  void scan(const Circle& disc, std::span<const Circle> robots = {}) {
    std::vector<float> ranges(540);
    const ObstacleWorld walls({Segment{{-4, -4}, {4, -4}}, Segment{{4, -4}, {4, 4}}, Segment{{4, 4}, {-4, 4}},
                               Segment{{-4, 4}, {-4, -4}}});
    scanner.scan({nullptr, nullptr, &walls, std::span(&disc, 1)}, {0, 0}, 0.1, ranges);
    beams.read({{0, 0}, 0.1, at_s(now_s), ranges}, robots);
    CHECK(tracks.update(beams, grid));
    CHECK(grid.update(beams));
    now_s += kScan_s;
  }
  /// The track near a point.
  const LaserTrack& at(const Vec2& p) const {
    const auto found = std::ranges::find_if(
        tracks.tracks(), [&](const LaserTrack& track) { return (track.position_m - p).norm() < 0.3; });
    REQUIRE(found != tracks.tracks().end());
    return *found;
  }
};

TEST_CASE("a person who stops keeps the same track and does not become a wall") {
  Hall hall;
  Vec2 at(3, -1.5);
  for (int i = 0; i < 45; ++i, at.y() += kScan_s) hall.scan({at, 0.25});
  const LaserTrack walking = hall.at(at);
  CHECK(walking.is_moving);
  CHECK((walking.velocity_mps - Vec2(0, 1)).norm() < 0.1);
  CHECK((walking.position_m - at).norm() < 0.15);
  CHECK(walking.radius_m == Approx(0.25).margin(0.04));
  for (int i = 0; i < 90; ++i) hall.scan({at, 0.25});
  const LaserTrack paused = hall.at(at);
  CHECK(paused.number == walking.number);
  CHECK_FALSE(paused.is_moving);
  int standing = 0, loose = 0;
  for (int beam = 0; beam < hall.beams.count(); ++beam)
    (hall.tracks.is_standing(beam) ? standing : loose) +=
        (hall.beams.end_m(hall.beams[beam]) - at).norm() < 0.3;
  CHECK(standing == 0);
  CHECK(loose > 5);
  for (int i = 0; i < 15; ++i, at.x() -= kScan_s) hall.scan({at, 0.25});
  CHECK(hall.at(at).number == walking.number);
  CHECK(hall.at(at).is_moving);
}

TEST_CASE("an object that has not moved since it was first seen counts as stationary") {
  Hall hall;
  for (int i = 0; i < 60; ++i) hall.scan({{2, 1}, 0.25});
  CHECK(hall.tracks.tracks().empty());
  for (int beam = 0; beam < hall.beams.count(); ++beam) CHECK(hall.tracks.is_standing(beam));
}

TEST_CASE("known robots are not tracked") {
  Hall hall;
  for (int i = 0; i < 60; ++i) {
    const Circle robot{{2, 1 + i * kScan_s}, 0.25};
    hall.scan(robot, std::span(&robot, 1));
    for (const LaserTrack& track : hall.tracks.tracks())
      CHECK((track.position_m - robot.centre_m).norm() > 0.4);
  }
}

TEST_CASE("a track ends when it has not been seen for some time") {
  Hall hall;
  Vec2 at(3, -1.5);
  for (int i = 0; i < 45; ++i, at.y() += kScan_s) hall.scan({at, 0.25});
  const LaserTrack last = hall.at(at);
  const auto is_kept = [&] {
    return std::ranges::any_of(hall.tracks.tracks(),
                               [&](const LaserTrack& track) { return track.number == last.number; });
  };
  for (int i = 0; i < 14; ++i) hall.scan({{50, 50}, 0.25});
  CHECK(is_kept());
  CHECK(hall.at(last.position_m).seen_at == last.seen_at);
  for (int i = 0; i < 3; ++i) hall.scan({{50, 50}, 0.25});
  CHECK_FALSE(is_kept());
}

TEST_CASE("old scans do not change tracks") {
  Hall hall;
  for (int i = 0; i < 5; ++i) hall.scan({{2, 1}, 0.25});
  CHECK_FALSE(hall.tracks.update(hall.beams, hall.grid));
}

}  // namespace sidestep::laser_tracks_test
