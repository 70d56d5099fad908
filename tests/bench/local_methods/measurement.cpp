// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/local_methods/measurement.hpp"

#include <fmt/core.h>

#include "tests/study/measurement/cpu_clock.hpp"

namespace sidestep {

void print_header(const char* title) {
  fmt::print("\n{}\n  {:<40}{:>12}{:>10}{:>10}   {}\n", title, "", "median us", "p99 us", "samples",
             "mean result");
}

void print_row(const std::string& name, const Distribution& times_us, double mean_result) {
  const std::string p99 = times_us.size() >= kMinForP99 ? fmt::format("{:10.1f}", times_us.quantile(0.99))
                                                        : fmt::format("{:>10}", "-");
  fmt::print("  {:<40}{:12.1f}{}{:10}   {:.6g}\n", name, times_us.median(), p99, times_us.size(),
             mean_result);
}

void measure(std::vector<Contestant>& contestants, Rng& rng) {
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for (std::size_t who = 0; who < contestants.size(); ++who) {
    for (std::size_t scene = 0; scene < contestants[who].scenes; ++scene) order.emplace_back(who, scene);
  }
  rng.shuffle(order);
  for (const auto& [who, scene] : order) {
    Contestant& contestant = contestants[who];
    const double begin_us = cpu_us();
    const double checksum = contestant.run(scene);
    contestant.times_us.add(cpu_us() - begin_us);
    contestant.sum += checksum;
  }
  for (const Contestant& contestant : contestants) {
    print_row(contestant.name, contestant.times_us,
              contestant.sum / static_cast<double>(contestant.times_us.size()));
  }
}

}  // namespace sidestep
