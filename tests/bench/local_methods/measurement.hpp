// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/study/measurement/distribution.hpp"

namespace sidestep {

inline constexpr std::uint64_t kBenchSeed = 1;
inline constexpr std::size_t kBenchScenes = 1200, kBeams = 360;

/// A method under comparison, measured on scenes. `run` returns a checksum.
struct Contestant {
  std::string name;
  std::size_t scenes;
  std::function<double(std::size_t scene)> run;
  Distribution times_us{};
  double sum = 0;
};

void print_header(const char* title);
void print_row(const std::string& name, const Distribution& times_us, double mean_result);

/// Measures every method on every scene, in random order, and prints the times.
void measure(std::vector<Contestant>& contestants, Rng& rng);

// Each prints a table, and returns false if a result is wrong.
bool compare_tables();
bool compare_windows();
bool compare_disc_windows();
bool compare_bands();

}  // namespace sidestep
