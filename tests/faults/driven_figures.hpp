// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "tests/faults/external_simulator_run.hpp"
#include "tests/faults/figure_table.hpp"

namespace sidestep {

/// Drives to the end of the run. All robots must arrive without contact or violation, and make at most one
/// stop of their own per robot and minute.
[[nodiscard]] MeasuredRun drive_to_end(const std::string& row, ExternalSimulatorRun& floor);

/// Adds what `work` measures to the table, again while the row is open; an exception counts as a miss.
template <typename Work>
void measure(FigureTable& table, const std::string& row, Work work) {
  do {
    try {
      table.add(work());
    } catch (const std::runtime_error& error) {
      table.add({row, "", {error.what()}});
    }
  } while (table.is_open(row));
}

}  // namespace sidestep
