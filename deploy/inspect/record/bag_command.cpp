// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/bag_command.hpp"

#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <vector>

#include "common/file/console.hpp"
#include "common/process/output_paths.hpp"
#include "common/process/process.hpp"
#include "deploy/inspect/record/bag.hpp"

namespace sidestep {
namespace {

struct BagOptions {
  std::string file, out;
  std::vector<std::string> files, topics;
  BagCut cut;
  bool overwrites = false;
};

/// Reports damage, and returns the exit code.
int exit_code_for(const std::string& damage) {
  if (damage.empty()) return 0;
  fmt::print(stderr, "damaged: {}; earlier messages were used\n", damage);
  return kExitFailure;
}

}  // namespace

void add_bag_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<BagOptions>();
  const CliCommand bag = root.add_subcommand("bag", "Shows, cuts and merges recordings (MCAP files)");
  bag.require_subcommand();
  const auto add_out = [options](const CliCommand& command) {
    command.add_option("--out", options->out, "recording to write").required();
    command.add_flag("--force", options->overwrites, "overwrite the file if it exists");
  };

  const CliCommand info =
      bag.add_subcommand("info", "Lists the topics, attachments and metadata of a recording");
  info.add_option("FILE", options->file, "recording").required();
  info.on_parsed([options, &action] {
    action = [options] {
      const BagInfo content = bag_info(options->file);
      write_output(to_text(content));
      return exit_code_for(content.damage);
    };
  });

  const CliCommand cut = bag.add_subcommand("cut", "Copies a part of a recording");
  cut.add_option("FILE", options->file, "recording").required();
  add_out(cut);
  cut.add_option("--from", options->cut.from_s, "begin, in seconds after the first message")
      .check(in_range(0, 1e9));
  cut.add_option("--to", options->cut.to_s,
                 "end, in seconds after the first message [the end of the recording]")
      .check(in_range(0, 1e9));
  cut.add_option("--topics", options->topics, "topics, e.g. truth,feedback/3 [all]").comma_separated();
  cut.on_parsed([options, &action] {
    require_separate_outputs({{"FILE", options->file}}, {{"--out", options->out}});
    require_new_output({"--out", options->out}, options->overwrites);
    if (options->cut.to_s < options->cut.from_s) throw UsageError("--to: expected a time not before --from");
    options->cut.topics = {options->topics.begin(), options->topics.end()};
    action = [options] { return exit_code_for(cut_bag(options->file, options->cut, options->out)); };
  });

  const CliCommand merge =
      bag.add_subcommand("merge", "Merges recordings of one run by the time of reception");
  merge.add_option("FILES", options->files, "recordings").required();
  add_out(merge);
  merge.on_parsed([options, &action] {
    std::vector<NamedPath> inputs;
    for (const std::string& file : options->files) inputs.push_back({"one of FILES", file});
    require_separate_outputs(inputs, {{"--out", options->out}});
    require_new_output({"--out", options->out}, options->overwrites);
    action = [options] { return exit_code_for(merge_bags(options->files, options->out)); };
  });
}

}  // namespace sidestep
