// SPDX-License-Identifier: Apache-2.0
// Measures the local methods of navigation: dynamic windows with exact
// arcs and with tables, and the bubble band. Fails if a result is wrong. Times are only printed.
#include <fmt/core.h>

#include "tests/bench/local_methods/measurement.hpp"

using namespace sidestep;

int main() {
  fmt::print("Microseconds of processor time; seed {}.\n\n", kBenchSeed);
  const bool tables = compare_tables(), windows = compare_windows(), discs = compare_disc_windows(),
             bands = compare_bands();
  return tables && windows && discs && bands ? 0 : 1;
}
