// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_score.hpp"

#include <fmt/format.h>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "common/process/number_text.hpp"

namespace sidestep {
namespace {

constexpr const char* kUnknown = "-";

std::string number_or_unknown(const std::optional<double>& number) {
  return number ? fmt::format("{:.4f}", *number) : kUnknown;
}

template <typename Number>
Number number_in(const std::string& cell) {
  const auto number = parsed<Number>(cell);
  if (!number) throw std::invalid_argument("expected a number, got " + in_quotes(cell));
  return *number;
}

std::optional<double> known_number_in(const std::string& cell) {
  return cell == kUnknown ? std::nullopt : std::optional(number_in<double>(cell));
}

/// The values that are known of the complete scenes.
Distribution known(const CrowdScore& score, std::optional<double> CrowdResult::*value) {
  Distribution values;
  for (const auto& [seed, result] : score.complete)
    if (result.*value) values.add(*(result.*value));
  return values;
}

}  // namespace

std::string crowd_result_cells(const CrowdResult& result) {
  return fmt::format("{},{},{},{},{},{},{:.3f}", result.robots, result.arrived, result.contacts,
                     result.violations, number_or_unknown(result.ratio), number_or_unknown(result.makespan_s),
                     result.cpu_us);
}

CrowdResult crowd_result_from(std::span<const std::string> cells) {
  if (cells.size() != 7) throw std::invalid_argument(fmt::format("expected 7 cells, got {}", cells.size()));
  return {number_in<int>(cells[0]),           number_in<int>(cells[1]),  number_in<std::uint64_t>(cells[2]),
          number_in<std::uint64_t>(cells[3]), known_number_in(cells[4]), known_number_in(cells[5]),
          number_in<double>(cells[6])};
}

void CrowdScore::add(std::uint64_t seed, const CrowdResult& result) {
  ++scenes;
  robots += result.robots;
  arrived += result.arrived;
  contacts += result.contacts;
  violations += result.violations;
  if (result.arrived == result.robots) complete.emplace(seed, result);
  cpu_us.add(result.cpu_us);
}

Distribution CrowdScore::ratios() const { return known(*this, &CrowdResult::ratio); }

Distribution CrowdScore::makespans_s() const { return known(*this, &CrowdResult::makespan_s); }

std::optional<double> relative_ratio(const CrowdScore& first, const CrowdScore& second) {
  Distribution firsts, seconds;
  for (const auto& [seed, result] : first.complete) {
    const auto other = second.complete.find(seed);
    if (other == second.complete.end() || !result.ratio || !other->second.ratio) continue;
    firsts.add(*result.ratio);
    seconds.add(*other->second.ratio);
  }
  if (firsts.size() == 0) return std::nullopt;
  return firsts.mean() / seconds.mean();
}

bool is_better(const CrowdScore& first, const CrowdScore& second) {
  const auto failures = [](const CrowdScore& score) {
    return std::tuple(score.contacts + score.violations, score.robots - score.arrived, score.incomplete());
  };
  if (failures(first) != failures(second)) return failures(first) < failures(second);
  const auto relative = relative_ratio(first, second);
  return relative && *relative < 1;
}

}  // namespace sidestep
