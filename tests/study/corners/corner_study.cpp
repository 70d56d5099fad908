// SPDX-License-Identifier: Apache-2.0
#include "tests/study/corners/corner_study.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <map>
#include <span>
#include <string>

#include "tests/study/corners/corner_scene.hpp"
#include "tests/study/corners/doorway_scene.hpp"
#include "tests/study/table/experiment.hpp"

namespace sidestep {
namespace {

constexpr std::uint64_t kBatch = 50, kComparisonInterval = 10;  // every tenth case is repeated with cameras

/// The sums over a batch of cases.
struct Batch {
  int arrived = 0, blocked = 0;
  std::uint64_t contacts = 0, crashes = 0, crashes_in_motion = 0;
  int failed_audits = 0;
  double laser_s = 0, camera_s = 0;  // over cases in which the robot arrived with laser and with cameras
};

/// Makes a random scene of the given kind.
using SceneOf = Scenario (*)(std::size_t kind, std::uint64_t seed);

Batch run_batch(SceneOf scene_of, std::size_t kind, std::uint64_t first, std::uint64_t count) {
  Batch sum;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const Scenario scenario = scene_of(kind, seed);
    const CornerResult result = run_corner(scenario, seed, true);
    sum.arrived += result.has_arrived;
    sum.blocked += !result.has_arrived && result.was_blocked;
    sum.contacts += result.contacts;
    sum.crashes += result.crashes;
    sum.crashes_in_motion += result.crashes_in_motion;
    sum.failed_audits += !result.audit_passed;
    if (seed % kComparisonInterval != 0 || !result.has_arrived) continue;
    const CornerResult camera = run_corner(scenario, seed, false);
    if (!camera.has_arrived) continue;
    sum.laser_s += result.seconds;
    sum.camera_s += camera.seconds;
  }
  return sum;
}

double number(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// Prints a row per kind. Returns whether there was no crash in motion, no contact and no failed audit.
bool summarise(const StudyTable& table) {
  std::map<std::string, std::vector<double>> sums;
  for (const auto& row : table.rows) {
    auto& sum = sums[row[0]];
    sum.resize(row.size());
    for (std::size_t i = 2; i < row.size(); ++i) sum[i] += number(row[i]);
  }
  bool is_safe = true;
  fmt::print("kind      cases arrived blocked contacts crashes_at_rest crashes_in_motion time_ratio\n");
  for (const auto& [kind, s] : sums) {
    // Columns: kind, first, cases, time ratio, laser_s, camera_s, arrived, blocked, contacts, crashes, in
    // motion, audits.
    fmt::print("{:<9} {:5} {:7} {:7} {:8} {:15} {:17} {:10.2f}\n", kind, s[2], s[6], s[7], s[8], s[9] - s[10],
               s[10], s[4] / s[5]);
    is_safe = is_safe && s[8] == 0 && s[10] == 0 && s[11] == 0;
  }
  return is_safe;
}

int study_scenes(const std::string& name, std::span<const char* const> kinds, SceneOf scene_of,
                 const StudyOptions& options) {
  require_study_output(options);
  const std::uint64_t of_kind =
      options.is_quick ? 2 : std::max<std::uint64_t>(options.cases / kinds.size(), 1);
  Experiment experiment;
  experiment.jobs = options.jobs;
  experiment.table.name = name;
  experiment.table.columns = {
      "kind",    "first_seed", "cases",    "time_ratio", "laser_s",           "camera_s",
      "arrived", "blocked",    "contacts", "crashes",    "crashes_in_motion", "failed_audits"};
  Plot plot{"time with a laser over time with cameras above the floor", "kind of scene", "ratio"};
  plot.categories.assign(kinds.begin(), kinds.end());
  experiment.table.plots.push_back(plot);
  const std::string line = fmt::format("median and extremes of batches of {} cases", kBatch);
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    for (std::uint64_t done = 0; done < of_kind; done += kBatch) {
      const std::uint64_t first = options.seed * 1'000'000 + done, cases = std::min(kBatch, of_kind - done);
      experiment.runs.push_back({line, static_cast<double>(kind), cells(kinds[kind], first, cases), [=] {
                                   const Batch b = run_batch(scene_of, kind, first, cases);
                                   return fmt::format("{:.3f},{:.3f},{:.3f},{},{},{},{},{},{}",
                                                      b.camera_s > 0 ? b.laser_s / b.camera_s : 1.0,
                                                      b.laser_s, b.camera_s, b.arrived, b.blocked, b.contacts,
                                                      b.crashes, b.crashes_in_motion, b.failed_audits);
                                 }});
    }
  }
  measure(experiment);
  write_study_table(experiment.table, name, options);
  return summarise(experiment.table) ? 0 : 1;
}

}  // namespace

int study_corners(const StudyOptions& options) {
  return study_scenes("corners", kCornerKinds, corner_scene, options);
}

int study_doorways(const StudyOptions& options) {
  return study_scenes("doorways", kDoorwayKinds, doorway_scene, options);
}

}  // namespace sidestep
