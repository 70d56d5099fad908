// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sidestep {

/// The names of the methods that the benchmark compares. "bound" is not a method, but a lower bound of the
/// ratio of all methods.
[[nodiscard]] std::vector<std::string> crowd_methods();

struct CrowdBenchOptions {
  std::vector<std::string> families;  ///< empty: all families
  std::vector<std::string> methods;   ///< empty: all methods
  std::vector<std::uint64_t> seeds;   ///< at least one
  int jobs = 2;                       ///< number of parallel processes
  std::string folder;                 ///< for tables, plots and pictures; empty: no files
};

/// Runs all methods on the same scenes, each run in a process of its own, and prints a table. Shows progress
/// on stderr. With a folder, writes scenes.csv (every run), crowds.csv (the table), crowds.png (its plots),
/// and for each family FAMILY.svg: the paths that Sidestep's robots drove with the first seed. Returns
/// whether in all scenes all robots of Sidestep arrived without contacts and violations. Throws
/// std::invalid_argument for unknown names and without seeds, and std::runtime_error if a file cannot be
/// written or a run ends abnormally.
[[nodiscard]] bool bench_crowds(const CrowdBenchOptions& options);

}  // namespace sidestep
