// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_bench.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <stdexcept>

#include "common/file/write_file.hpp"
#include "common/process/number_text.hpp"
#include "common/version/version.hpp"
#include "deploy/audit/picture/run_picture.hpp"
#include "tests/bench/crowds/crowd_families.hpp"
#include "tests/bench/crowds/crowd_reference.hpp"
#include "tests/bench/crowds/crowd_scene_file.hpp"
#include "tests/bench/crowds/crowd_table.hpp"
#include "tests/bench/crowds/crowd_trial.hpp"
#include "tests/bench/crowds/reciprocal_trial.hpp"
#include "tests/study/table/experiment.hpp"

namespace sidestep {
namespace {

/// One way to drive the robots of a scene.
struct CrowdMethod {
  std::string name, setting;
  std::function<CrowdResult(const Scenario&, std::uint64_t seed)> run;
};

/// Not a method: the lower bound of the ratio of all methods.
CrowdResult bound_of(const Scenario& scenario, std::uint64_t) {
  CrowdResult result;
  result.robots = result.arrived = static_cast<int>(scenario.robots.size());
  result.ratio = lower_bound_ratio(scenario);
  return result;
}

/// All methods except Sidestep. Of a method with several settings, the table shows the best one of each
/// family.
std::vector<CrowdMethod> compared_methods() {
  std::vector<CrowdMethod> methods;
  for (const ReciprocalSettings& settings : reciprocal_settings())
    methods.push_back(
        {"reciprocal", settings.name, [&settings](const Scenario& scenario, std::uint64_t seed) {
           return run_reciprocal_avoidance(scenario, settings, seed);
         }});
  methods.push_back({kReferenceMethod, "", run_reference});
  methods.push_back({"bound", "", bound_of});
  return methods;
}

std::string path_in(const CrowdBenchOptions& options, const std::string& file) {
  return (std::filesystem::path(options.folder) / file).string();
}

/// Sidestep; draws the first seed, and writes its scene, if there is a folder.
CrowdMethod sidestep_method(const CrowdBenchOptions& options) {
  return {kSidestepMethod, "", [options](const Scenario& scenario, std::uint64_t seed) {
            const Report report = drive_crowd(scenario, seed);
            if (!options.folder.empty() && seed == options.seeds.front()) {
              write_file(path_in(options, scenario.name + ".svg"), run_picture_from(to_json(report)));
              if (const auto file = crowd_scene_file(scenario))
                write_file(path_in(options, scenario.name + ".yaml"), *file);
            }
            return crowd_result_of(report);
          }};
}

std::vector<CrowdMethod> chosen_methods(const CrowdBenchOptions& options) {
  std::vector<CrowdMethod> methods{sidestep_method(options)};
  for (CrowdMethod& method : compared_methods()) methods.push_back(std::move(method));
  std::erase_if(methods, [&](const CrowdMethod& method) {
    return !options.methods.empty() &&
           std::ranges::find(options.methods, method.name) == options.methods.end();
  });
  return methods;
}

std::vector<const CrowdFamily*> chosen_families(const CrowdBenchOptions& options) {
  std::vector<const CrowdFamily*> families;
  for (const CrowdFamily& family : crowd_families())
    if (options.families.empty() ||
        std::ranges::find(options.families, family.name) != options.families.end())
      families.push_back(&family);
  return families;
}

void check_options(const CrowdBenchOptions& options) {
  if (options.seeds.empty()) throw std::invalid_argument("expected at least one seed");
  for (const std::string& family : options.families)
    if (!find_crowd_family(family)) throw std::invalid_argument("unknown family of crowds: " + family);
  const std::vector<std::string> methods = crowd_methods();
  for (const std::string& method : options.methods)
    if (std::ranges::find(methods, method) == methods.end())
      throw std::invalid_argument("unknown method: " + method);
}

/// Columns of an experiment's rows that identify the run; the others are those of crowd_result_cells().
constexpr std::size_t kKeyColumns = 4;

Experiment experiment_of(const CrowdBenchOptions& options, const std::vector<CrowdMethod>& methods) {
  Experiment experiment;
  experiment.jobs = options.jobs;
  experiment.table.name = "scenes";
  experiment.table.columns = {"family",   "method",     "setting", "seed",       "robots", "arrived",
                              "contacts", "violations", "ratio",   "makespan_s", "cpu_us"};
  for (const CrowdFamily* const family : chosen_families(options)) {
    for (const CrowdMethod& method : methods) {
      for (const std::uint64_t seed : options.seeds)
        experiment.runs.push_back(
            {"", 0, cells(family->name, method.name, method.setting, seed), [family, &method, seed] {
               return crowd_result_cells(method.run(crowd_scene(*family, seed), seed));
             }});
    }
  }
  return experiment;
}

/// The scores of all families, methods and settings, in the order of the experiment's rows.
std::vector<CrowdRow> scores_of(const StudyTable& scenes) {
  std::vector<CrowdRow> scores;
  for (const std::vector<std::string>& row : scenes.rows) {
    if (scores.empty() || scores.back().family != row[0] || scores.back().method != row[1] ||
        scores.back().setting != row[2])
      scores.push_back({row[0], row[1], row[2], {}});
    scores.back().score.add(parsed<std::uint64_t>(row[3]).value(),
                            crowd_result_from(std::span(row).subspan(kKeyColumns)));
  }
  return scores;
}

/// The best setting of each method in each family. Precondition: the settings of a method are neighbours.
std::vector<CrowdRow> best_settings(const std::vector<CrowdRow>& scores) {
  std::vector<CrowdRow> best;
  for (const CrowdRow& score : scores) {
    if (best.empty() || best.back().family != score.family || best.back().method != score.method)
      best.push_back(score);
    else if (is_better(score.score, best.back().score))
      best.back() = score;
  }
  return best;
}

std::string csv_of(const StudyTable& table, const CrowdBenchOptions& options) {
  std::string text = fmt::format("# sidestep bench crowds, seeds {}\n# commit {}\n{}\n",
                                 fmt::join(options.seeds, " "), kBuildCommit, fmt::join(table.columns, ","));
  for (const auto& row : table.rows) text += fmt::format("{}\n", fmt::join(row, ","));
  return text;
}

}  // namespace

std::vector<std::string> crowd_methods() {
  std::vector<std::string> names{kSidestepMethod};
  for (const CrowdMethod& method : compared_methods())
    if (names.back() != method.name) names.push_back(method.name);
  return names;
}

bool bench_crowds(const CrowdBenchOptions& options) {
  check_options(options);
  StudyOptions output;
  output.folder = options.folder;
  if (!options.folder.empty()) require_study_output(output);
  const std::vector<CrowdMethod> methods = chosen_methods(options);
  Experiment experiment = experiment_of(options, methods);
  measure(experiment);
  const std::vector<CrowdRow> rows = best_settings(scores_of(experiment.table));
  const StudyTable table = crowd_table(rows);
  fmt::print("{}", markdown_of(table));
  if (!options.folder.empty()) {
    write_file(path_in(options, "scenes.csv"), csv_of(experiment.table, options));
    write_file(path_in(options, "crowds.csv"), csv_of(table, options));
    draw(table.plots, path_in(options, "crowds.png"));
    fmt::print("{0}/scenes.csv, {0}/crowds.csv, {0}/crowds.png\n", options.folder);
  }
  return std::ranges::all_of(
      rows, [](const CrowdRow& row) { return row.method != kSidestepMethod || row.score.is_clean(); });
}

}  // namespace sidestep
