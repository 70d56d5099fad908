// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_score.hpp"

#include <fmt/format.h>
#include <limits>
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

void CrowdScore::add(const CrowdResult& result) {
  ++scenes;
  robots += result.robots;
  arrived += result.arrived;
  contacts += result.contacts;
  violations += result.violations;
  if (result.ratio) ratio.add(*result.ratio);
  if (result.makespan_s) makespan_s.add(*result.makespan_s);
  cpu_us.add(result.cpu_us);
}

bool is_better(const CrowdScore& first, const CrowdScore& second) {
  const auto key = [](const CrowdScore& score) {
    // The mean of no scenes is 0, which would be the best.
    const double ratio =
        score.ratio.size() > 0 ? score.ratio.mean() : std::numeric_limits<double>::infinity();
    return std::tuple(score.contacts + score.violations, score.robots - score.arrived, ratio);
  };
  return key(first) < key(second);
}

}  // namespace sidestep
