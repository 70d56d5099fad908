// SPDX-License-Identifier: Apache-2.0
// The time that a robot takes to process one scan of its own laser, in a
// floor plan with people. Fails if a wall is tracked as moving or a person is lost.
#include <cstdlib>
#include <fmt/format.h>
#include <string>
#include <time.h>

#include "agents/perception/laser_tracks.hpp"
#include "agents/perception/visibility.hpp"
#include "tests/unit/agents/perception/scene.hpp"

namespace sidestep {
namespace {

constexpr LaserSettings kLaser{720, 2 * std::numbers::pi, 0.05, 8};
constexpr double kScan_s = 0.1;
constexpr int kScans = 1500;
constexpr int kPeople = 6;

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

/// The times of one processing step.
struct Series {
  std::string name;
  std::vector<double> times_us;

  template <typename Work>
  void measure(const Work& work) {
    const double before_us = thread_us();
    work();
    times_us.push_back(thread_us() - before_us);
  }
  void print() {
    std::ranges::sort(times_us);
    fmt::print("{:<28} {:>8.1f} {:>8.1f}\n", name, times_us[times_us.size() / 2],
               times_us[times_us.size() * 99 / 100]);
  }
};

/// Whether a moving track belongs to no person.
bool is_phantom(const LaserTrack& track, Time now, std::span<const Circle> people) {
  return track.is_moving && track.seen_at == now && std::ranges::none_of(people, [&](const Circle& person) {
           return (person.centre_m - track.position_m).norm() < 1;
         });
}

int run() {
  Rng rng(1);
  test::Scene scene(1, kLaser);
  test::Walker robot(scene, rng, 0.25, 0.8);
  std::vector<test::Walker> people;
  for (int i = 0; i < kPeople; ++i) people.emplace_back(scene, rng, 0.25, rng.uniform(0.5, 1.5));
  std::vector<Circle> discs(people.size());
  LaserBeams beams(kLaser);
  LocalGrid grid;
  LaserTracks tracks, tracks_with_map;
  Visibility visibility;
  const PriorMap walls{&scene.map()};
  Series reading{"LaserBeams::read", {}}, tracking{"LaserTracks::update", {}},
      tracking_map{"LaserTracks::update, map", {}}, mapping{"LocalGrid::update", {}},
      seeing{"Visibility::update", {}};
  int moving = 0, phantoms = 0;
  for (int i = 1; i <= kScans; ++i) {
    robot.step(scene, rng, kScan_s);
    for (std::size_t k = 0; k < people.size(); ++k) {
      people[k].step(scene, rng, kScan_s);
      discs[k] = people[k].disc();
    }
    const LaserScan scan = scene.scan(robot.at_m(), robot.heading_rad(), time_from_ns(i * 100'000'000LL),
                                      discs, {0.015, 0.03, 0.02}, rng);
    reading.measure([&] { beams.read(scan, {}); });
    tracking.measure([&] { tracks.update(beams, grid); });
    tracking_map.measure([&] { tracks_with_map.update(beams, grid, {&scene.map()}); });
    mapping.measure([&] { grid.update(beams); });
    seeing.measure([&] {
      visibility.update(beams, [&](const Vec2& p, double within_m) { return walls.nearest_m(p, within_m); });
    });
    for (const LaserTrack& track : tracks_with_map.tracks()) {
      moving += track.is_moving;
      phantoms += is_phantom(track, scan.captured_at, discs);
    }
  }
  fmt::print("{} scans of {} beams, microseconds   median      p99\n", kScans, kLaser.beams);
  for (Series* series : {&reading, &mapping, &tracking, &tracking_map, &seeing}) series->print();
  fmt::print("moving tracks: {}, of them without a person: {}\n", moving, phantoms);
  return moving > kScans / 2 && phantoms * 50 < moving ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace sidestep

int main() { return sidestep::run(); }
