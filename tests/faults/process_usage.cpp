// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/process_usage.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <unistd.h>

namespace sidestep {

ProcessUsage usage_of(pid_t pid) {
  const std::string folder = "/proc/" + std::to_string(pid);
  std::ifstream stat(folder + "/stat");
  std::string line;
  if (!std::getline(stat, line)) throw std::runtime_error("no process " + std::to_string(pid));
  // The name in parentheses may contain spaces.
  std::istringstream fields(line.substr(line.rfind(')') + 2));
  std::string ignored;
  for (int i = 0; i < 11; ++i) fields >> ignored;
  double user = 0, system = 0;
  fields >> user >> system;
  std::ifstream statm(folder + "/statm");
  double pages = 0;
  statm >> pages >> pages;
  return {pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6,
          (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK))};
}

std::map<std::string, ProcessUsage> usage_of(const LaunchedRun& run) {
  std::map<std::string, ProcessUsage> result;
  for (const auto& [name, pid] : run.children()) result[name] = usage_of(pid);
  result["launcher"] = usage_of(run.pid());
  return result;
}

double memory_slope_mb_per_h(const std::vector<MemorySample>& samples) {
  const auto count = static_cast<double>(samples.size());
  double mean_s = 0, mean_mb = 0;
  for (const MemorySample& sample : samples) {
    mean_s += sample.time_s / count;
    mean_mb += sample.memory_mb / count;
  }
  double covariance = 0, variance = 0;
  for (const MemorySample& sample : samples) {
    covariance += (sample.time_s - mean_s) * (sample.memory_mb - mean_mb);
    variance += (sample.time_s - mean_s) * (sample.time_s - mean_s);
  }
  return 3600 * covariance / variance;
}

}  // namespace sidestep
