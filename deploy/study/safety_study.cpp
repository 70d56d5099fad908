// SPDX-License-Identifier: Apache-2.0
#include "deploy/study/safety_study.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <numeric>
#include <stdexcept>
#include <unistd.h>
#include <vector>

#include "deploy/report.hpp"
#include "deploy/search/commit.hpp"
#include "deploy/search/worker_pool.hpp"
#include "deploy/study/plots.hpp"
#include "deploy/study/search_time.hpp"
#include "deploy/study/traversal.hpp"

namespace sidestep {
namespace {

using std::chrono::steady_clock;

/// How much of everything.
struct Sizes {
  std::vector<int> robots{2, 4, 8, 16, 24, 32};
  int trials = 10;
  double seconds = 30;
  int margin_robots = 16, margin_trials = 5;
  double margin_seconds = 20;
  std::vector<double> margins_mm{0, 5, 10, 20};
  std::vector<double> noises_mm{0.5, 1, 2, 5, 10, 20};
  std::vector<int> searchers{2, 5, 10, 20, 50, 100, 200, 500, 1000};
  int search_trials = 100;
};
Sizes quick_sizes() { return {{2, 16}, 2, 8, 8, 1, 5, {0, 10}, {0.5, 10}, {2, 20, 100}, 5}; }

/// One row of a table: what it is about, and how to measure the rest.
struct Row {
  std::string line;  ///< in a plot
  double x = 0;
  std::string key;                       ///< the first columns
  std::function<std::string()> columns;  ///< the others, the plotted one first
};

struct Table {
  std::string name, header;
  Plot plot;
  int jobs = 1;
  std::vector<Row> rows;
};

std::string columns_of(const TraversalResult& r) {
  return fmt::format("{:.9f},{},{:.6f},{},{:.6f}", r.penetration_m_s, r.contacts, r.min_clearance_m,
                     r.traversals, r.reference_error_m);
}
constexpr const char* kTraversalColumns =
    "penetration_m_s,contacts,min_clearance_m,traversals,max_reference_error_m";

Table traversals(const StudyOptions& options, const Sizes& sizes) {
  Table table;
  table.name = "traversals";
  table.header = std::string("mode,robots,seconds,seed,") + kTraversalColumns;
  table.jobs = options.jobs;
  table.plot = {fmt::format("Left-right traversals, {} runs of {} s each", sizes.trials, sizes.seconds),
                "robots", "interpenetration, depth x time [m s]"};
  for (const bool has_search : {false, true}) {
    const std::string mode = has_search ? "with safety search" : "without";
    for (const int robots : sizes.robots) {
      for (int trial = 0; trial < sizes.trials; ++trial) {
        const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(trial);
        table.rows.push_back(
            {mode, static_cast<double>(robots),
             fmt::format("{},{},{},{}", has_search ? "with" : "without", robots, sizes.seconds, seed),
             [=, seconds = sizes.seconds] {
               TraversalSettings settings;
               settings.robots = robots;
               const Scenario scenario = traversal_scenario(settings, seed);
               return columns_of(has_search ? traverse_with_search(scenario, seed, seconds)
                                            : traverse_without_search(scenario, seconds));
             }});
      }
    }
  }
  return table;
}

Table margins(const StudyOptions& options, const Sizes& sizes) {
  Table table;
  table.name = "margins";
  table.header =
      std::string("odometry,off_reference_rule,margin_mm,noise_mm,robots,seconds,seed,") + kTraversalColumns;
  table.jobs = options.jobs;
  table.plot = {fmt::format("Margins against noise: {} robots, poor odometry, {} runs of {} s each",
                            sizes.margin_robots, sizes.margin_trials, sizes.margin_seconds),
                "noise of vision, standard deviation per axis [mm]", "interpenetration, depth x time [m s]"};
  table.plot.has_log_x = true;
  const auto add = [&](bool is_poor, bool breaks_off, double margin_mm, double noise_mm) {
    for (int trial = 0; trial < sizes.margin_trials; ++trial) {
      const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(trial);
      Row row;
      if (is_poor && !breaks_off) row.line = fmt::format("margin {} mm", margin_mm);
      row.x = noise_mm;
      row.key = fmt::format("{},{},{},{},{},{},{}", is_poor ? "poor" : "usual", breaks_off ? "on" : "off",
                            margin_mm, noise_mm, sizes.margin_robots, sizes.margin_seconds, seed);
      row.columns = [=, robots = sizes.margin_robots, seconds = sizes.margin_seconds] {
        const TraversalSettings settings{robots, margin_mm * 1e-3, noise_mm * 1e-3, is_poor, breaks_off};
        return columns_of(traverse_with_search(traversal_scenario(settings, seed), seed, seconds));
      };
      table.rows.push_back(std::move(row));
    }
  };
  for (const bool is_poor : {false, true}) {
    for (const double noise_mm : sizes.noises_mm) {
      for (const double margin_mm : sizes.margins_mm) add(is_poor, false, margin_mm, noise_mm);
      add(is_poor, true, TraversalSettings{}.margin_m * 1e3, noise_mm);
    }
  }
  return table;
}

Table search_times(const StudyOptions& options, const Sizes& sizes) {
  Table table;
  table.name = "search";
  table.header = "robots,seed,search_us_per_robot";
  table.plot = {fmt::format("Safety search of one robot in one cycle, {} trials each", sizes.search_trials),
                "robots", "time per robot [us]"};
  table.plot.has_log_x = true;
  for (const int robots : sizes.searchers) {
    for (int trial = 0; trial < sizes.search_trials; ++trial) {
      const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(trial);
      table.rows.push_back({"0.7 m2 of floor per robot", static_cast<double>(robots),
                            fmt::format("{},{}", robots, seed),
                            [=] { return fmt::format("{:.3f}", search_us_per_robot(robots, seed)); }});
    }
  }
  return table;
}

class Progress {
 public:
  Progress(std::string name, std::size_t count) : name_(std::move(name)), count_(count) {}
  void advance() {
    ++done_;
    const bool is_terminal = isatty(STDERR_FILENO) == 1;
    const auto now = steady_clock::now();
    if (done_ < count_ && now < next_) return;
    next_ = now + (is_terminal ? std::chrono::milliseconds(200) : std::chrono::seconds(5));
    fmt::print(stderr, "{}{}: {} of {} runs{}", is_terminal ? "\r\x1b[K" : "", name_, done_, count_,
               is_terminal && done_ < count_ ? "" : "\n");
  }

 private:
  std::string name_;
  std::size_t count_, done_ = 0;
  steady_clock::time_point next_{};
};

/// Measures all rows; each is done by a process of its own that cannot harm the others.
std::vector<std::string> measure(const Table& table) {
  std::vector<std::string> results(table.rows.size());
  std::string failure;
  Progress progress(table.name, table.rows.size());
  WorkerPool pool(
      table.jobs, [&](std::uint64_t job) { return table.rows[job].columns(); },
      [&](std::uint64_t job, const std::string& line, const std::string& died) {
        if (!died.empty()) failure = fmt::format("{}: {}", table.rows[job].key, died);
        results[job] = line;
        progress.advance();
      });
  std::vector<std::uint64_t> jobs(table.rows.size());
  std::iota(jobs.begin(), jobs.end(), 0);
  pool.run(jobs);
  if (!failure.empty()) throw std::runtime_error("a run has died: " + failure);
  return results;
}

PlotPoint summary_of(double x, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {x, values[values.size() / 2], values.front(), values.back()};
}

void plot(const Table& table, const std::vector<std::string>& results, const std::string& file) {
  std::vector<std::string> titles;
  std::map<std::string, std::map<double, std::vector<double>>> values;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Row& row = table.rows[i];
    if (row.line.empty()) continue;
    if (!values.contains(row.line)) titles.push_back(row.line);
    values[row.line][row.x].push_back(std::stod(results[i]));
  }
  Plot plot = table.plot;
  for (const std::string& title : titles) {
    PlotLine line{title, {}};
    for (const auto& [x, trials] : values[title]) line.points.push_back(summary_of(x, trials));
    plot.lines.push_back(std::move(line));
  }
  draw(plot, file);
}

}  // namespace

int study_safety(const StudyOptions& options) {
  require_gnuplot();
  const Sizes sizes = options.is_quick ? quick_sizes() : Sizes{};
  const std::filesystem::path folder = options.folder;
  for (const Table& table :
       {traversals(options, sizes), margins(options, sizes), search_times(options, sizes)}) {
    const std::vector<std::string> results = measure(table);
    std::string text =
        fmt::format("# sidestep study safety --out {} --seed {}{}\n# commit {}\n{}\n", options.folder,
                    options.seed, options.is_quick ? " --quick" : "", kCommit, table.header);
    for (std::size_t i = 0; i < results.size(); ++i)
      text += fmt::format("{},{}\n", table.rows[i].key, results[i]);
    write_file((folder / (table.name + ".csv")).string(), text);
    plot(table, results, (folder / (table.name + ".png")).string());
    fmt::print("{0}/{1}.csv, {0}/{1}.png\n", folder.string(), table.name);
  }
  return 0;
}

}  // namespace sidestep
