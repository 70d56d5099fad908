// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_bench_command.hpp"

#include <memory>

#include "common/process/process.hpp"
#include "deploy/trial/simulate/seed_range.hpp"
#include "tests/bench/crowds/crowd_bench.hpp"
#include "tests/bench/crowds/crowd_families.hpp"

namespace sidestep {
namespace {

struct Arguments {
  CrowdBenchOptions options;
  std::string seeds = "1..60", parity = "odd";
};

std::vector<std::string> family_names() {
  std::vector<std::string> names;
  for (const CrowdFamily& family : crowd_families()) names.push_back(family.name);
  return names;
}

}  // namespace

std::vector<std::uint64_t> seeds_in(const std::string& range, const std::string& parity) {
  const SeedRange bounds = parse_seed_range(range);
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t offset = 0; offset <= bounds.last - bounds.first; ++offset) {
    const std::uint64_t seed = bounds.first + offset;
    if (parity == "all" || (seed % 2 == 1) == (parity == "odd")) seeds.push_back(seed);
  }
  if (seeds.empty()) throw UsageError("no " + parity + " seed in " + range);
  return seeds;
}

void add_crowd_bench_command(const CliCommand& bench, std::function<int()>& action) {
  const CliCommand command = bench.add_subcommand(
      "crowds",
      "Crowds that have to get past each other: Sidestep, optimal reciprocal collision avoidance, a central "
      "reference and a lower bound. Exits with 1 unless all robots of Sidestep arrive without contacts and "
      "violations");
  const auto arguments = std::make_shared<Arguments>();
  CrowdBenchOptions& options = arguments->options;
  command.add_option("--family", options.families, "run only these families of scenes")
      .check(one_of(family_names()));
  command.add_option("--method", options.methods, "run only these methods").check(one_of(crowd_methods()));
  command.add_option("--seeds", arguments->seeds, "FIRST..LAST: a scene of each family for each seed")
      .show_default();
  command.add_option("--parity", arguments->parity, "use only seeds of this parity: tune on even ones")
      .check(one_of({"even", "odd", "all"}))
      .show_default();
  command.add_option("--jobs", options.jobs, "number of parallel processes")
      .check(in_range(1, 256))
      .show_default();
  command.add_option("--out", options.folder,
                     "folder for tables, plots, and a picture of the paths in each family [no files]");
  command.on_parsed([&action, arguments] {
    arguments->options.seeds = seeds_in(arguments->seeds, arguments->parity);
    action = [arguments] { return bench_crowds(arguments->options) ? 0 : kExitFailure; };
  });
}

}  // namespace sidestep
