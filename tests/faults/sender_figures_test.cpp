// SPDX-License-Identifier: Apache-2.0
// Measures runs with senders whose clocks have other rates, and with cameras that disagree. By default a few
// runs; SIDESTEP_SENDER_RUNS and SIDESTEP_CAMERA_RUNS make so many of each kind.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <optional>
#include <regex>

#include "tests/catch.hpp"
#include "tests/faults/driven_figures.hpp"
#include "tests/faults/external_simulator_run.hpp"
#include "tests/faults/figure_table.hpp"
#include "tests/faults/foreign_conformance.hpp"

namespace sidestep::sender_figures_test {
namespace {

using Options = std::vector<std::string>;

/// Until a base obeys, in simulated time: the simulator's latency, and the lag of motors.
constexpr double kLatency_ms = 119, kMaxLatencyError_ms = 3;
/// Cameras that disagree by less are not corrected, and no figure is printed.
constexpr double kMinPrinted_mm = 3, kMaxDisagreementError = 0.1;

/// Rates of simulated time, which take turns.
using Rates = std::vector<double>;

std::string text_of_rates(const Rates& rates) {
  std::string text;
  for (const double rate : rates) text += fmt::format("{}{:g}", text.empty() ? "" : ",", rate);
  return text;
}

/// Simulated time is counted from −1 s and passes at these rates.
Options clock_options(const Rates& rates) {
  return {"--speed", text_of_rates(rates), "--speed-change-s", "3", "--start-time-s", "-1"};
}

/// The same in steps of a timer that is late.
Options stepped_clock_options(const Rates& rates) {
  Options options = clock_options(rates);
  options.insert(options.end(), {"--step-hz", "60", "--step-delay-ms", "5"});
  return options;
}

/// The driver assumes the latency at the mean rate, as a user would after conformance.
std::string driver_options(const Rates& rates) {
  const double mean = std::accumulate(rates.begin(), rates.end(), 0.0) / static_cast<double>(rates.size());
  return fmt::format("--latency-ms {:.0f}", kLatency_ms / mean);
}

/// A shipped scenario with the keys for such a sender, as the README of conformance gives them.
std::string scenario_for(const Rates& rates, const std::string& scenario) {
  const auto [slowest, fastest] = std::ranges::minmax(rates);
  const double rate = std::min(slowest, 1.0);
  const double scale_error = std::max(0.4 * std::max(1 / slowest - 1, 1 - 1 / fastest), 0.005);
  return shipped_scenario("league/" + scenario) +
         fmt::format(
             "limits: {{acceleration_mps2: {:.2f}, deceleration_mps2: {:.2f}, speed_mps: {:.2f}}}\n"
             "odometry: {{scale_error: {:.3f}}}\n",
             3 * rate * rate, 5 * rate * rate, 2 * rate, scale_error);
}

void measure_run(FigureTable& table, const Rates& rates, const std::string& scenario) {
  const std::string row = fmt::format("rate {}, {}", text_of_rates(rates), scenario);
  measure(table, row, [&] {
    ExternalSimulatorRun floor(scenario_for(rates, scenario), stepped_clock_options(rates),
                               {"--robots=" + driver_options(rates)});
    return drive_to_end(row, floor);
  });
}

/// Whether a latency in real time is among those that these rates give.
bool is_latency_right(double latency_ms, const Rates& rates) {
  const auto [slowest, fastest] = std::ranges::minmax(rates);
  return latency_ms >= kLatency_ms / fastest - kMaxLatencyError_ms &&
         latency_ms <= kLatency_ms / slowest + kMaxLatencyError_ms;
}

/// Without steps, because in these the latency varies by a step.
void measure_latency(FigureTable& table, const Rates& rates) {
  const std::string row = fmt::format("rate {}, conformance", text_of_rates(rates));
  measure(table, row, [&] {
    const auto outcome = examine_foreign_robot(shipped_scenario("league/lone-robot"), clock_options(rates),
                                               driver_options(rates), {}, ExaminedUntil::kLatency);
    MeasuredRun result{row, outcome.latency_row, {}};
    if (outcome.is_latency_judged && outcome.latency_ms && !is_latency_right(*outcome.latency_ms, rates))
      result.misses.push_back(fmt::format("{:.0f} ms", *outcome.latency_ms));
    if (outcome.latency_row.empty()) result.misses.push_back("no row of latency, " + outcome.ended);
    if (outcome.is_latency_judged && !outcome.latency_ms)
      result.misses.emplace_back("judged without a figure");
    return result;
  });
}

/// The last disagreement that vision has printed, in mm.
std::optional<double> printed_disagreement_mm(const std::string& log) {
  const std::regex pattern("cameras 0 and 1 disagree by ([0-9.]+) mm");
  std::optional<double> printed;
  for (std::sregex_iterator match(log.begin(), log.end(), pattern); match != std::sregex_iterator(); ++match)
    printed = std::stod((*match)[1]);
  return printed;
}

/// Two cameras see the scenario's floor, each half of it, and are wrong by half of the disagreement each.
void measure_cameras(FigureTable& table, double disagreement_mm, const std::string& scenario) {
  const std::string row = fmt::format("{:g} mm, {}", disagreement_mm, scenario);
  measure(table, row, [&] {
    const std::string text =
        std::regex_replace(shipped_scenario("league/" + scenario), std::regex("columns: 2, rows: 2, "), "");
    ExternalSimulatorRun floor(text, {"--camera-error", fmt::format("{}", disagreement_mm * 1e-3 / 2)});
    MeasuredRun result = drive_to_end(row, floor);
    const auto printed_mm = printed_disagreement_mm(floor.run().log());
    const double max_error_mm = kMaxDisagreementError * disagreement_mm;
    if (printed_mm && !(std::abs(*printed_mm - disagreement_mm) <= max_error_mm))
      result.misses.push_back(fmt::format("printed {:g} mm", *printed_mm));
    if (!printed_mm && !(disagreement_mm <= kMinPrinted_mm))
      result.misses.emplace_back("no disagreement printed");
    result.figures += printed_mm ? fmt::format(", printed {:g} mm", *printed_mm) : ", none printed";
    return result;
  });
}

/// One short run cannot tell a rate of stops from a pause of the machine.
FigureTable::Rule rule_for(int runs) {
  return runs == 0 ? FigureTable::Rule::kTwoOfThree : FigureTable::Rule::kEachRun;
}

}  // namespace

TEST_CASE("robots arrive by packets of simulators at other rates than real time, and conformance dates them",
          "[both-cores][slow]") {
  const int runs = runs_from_environment("SIDESTEP_SENDER_RUNS", 0);
  FigureTable table("Senders at other rates: arrivals, own stops up to one per robot and minute, latency",
                    rule_for(runs));
  if (runs == 0) {
    measure_run(table, {0.98}, "crossing");
    measure_run(table, {0.66}, "crossing");
    measure_latency(table, {0.98});
  }
  const std::vector<Rates> all_rates{{0.5},       {0.66},   {0.8},        {0.9},
                                     {0.98},      {1},      {1.02},       {0.98, 0.66},
                                     {1.02, 0.5}, {1, 0.8}, {0.66, 1.02}, {0.98, 1.02, 0.5, 0.8}};
  for (int run = 0; run < runs; ++run) {
    for (const Rates& rates : all_rates) {
      measure_run(table, rates, "crossing");
      measure_run(table, rates, "two-teams-22");
      measure_latency(table, rates);
    }
  }
  table.print();
  CHECK(table.missed() == 0);
}

TEST_CASE("robots arrive although cameras disagree, and the disagreement is printed within a tenth",
          "[both-cores][slow]") {
  const int runs = runs_from_environment("SIDESTEP_CAMERA_RUNS", 0);
  FigureTable table("Cameras that disagree: arrivals, own stops, the printed disagreement", rule_for(runs));
  if (runs == 0) {
    measure_cameras(table, 0, "crossing");
    measure_cameras(table, 40, "two-teams-22");
  }
  for (int run = 0; run < runs; ++run) {
    for (const double disagreement_mm : {0, 10, 20, 30, 40, 50, 60}) {
      measure_cameras(table, disagreement_mm, "crossing");
      measure_cameras(table, disagreement_mm, "two-teams-22");
    }
  }
  table.print();
  CHECK(table.missed() == 0);
}

}  // namespace sidestep::sender_figures_test
