// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/graph_command.hpp"

#include <csignal>
#include <memory>
#include <string>

#include "common/file/console.hpp"
#include "common/file/write_file.hpp"
#include "common/messaging/dds/listener.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/inspect/topic/graph.hpp"
#include "deploy/inspect/topic/graph_picture.hpp"
#include "deploy/inspect/topic/silence.hpp"

namespace sidestep {
namespace {

struct GraphOptions {
  DdsSettings dds;
  double discovery_s = 1.5;  ///< participants announce themselves once per second
  std::string picture_file;
};

int show_graph(const GraphOptions& options) {
  // The picture is drawn even if the reader of the output disappears.
  std::signal(SIGPIPE, SIG_IGN);
  if (!options.picture_file.empty()) require_replaceable(options.picture_file);
  DdsListener listener(options.dds);
  const StopSignals stop_signals([&listener] { listener.stop(); });
  listener.run_until(listener.now() + from_seconds(options.discovery_s));
  const ProcessGraph graph = graph_of(listener.endpoints());
  const int error = write_text(stdout, to_text(graph));
  if (!options.picture_file.empty()) write_file(options.picture_file, graph_picture(graph));
  require_printed(error);
  if (!graph.processes.empty()) return 0;
  print_to(stderr, "{}\n", empty_domain_text(options.dds.domain));
  return kExitFailure;
}

}  // namespace

void add_graph_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<GraphOptions>();
  options->dds.participant = "sidestep-graph";
  const CliCommand command = root.add_subcommand(
      "graph", "Shows the processes of a DDS domain, and which topics they write and read");
  command.add_option("--svg", options->picture_file,
                     "also draw the graph to this SVG file; an earlier file is replaced");
  command.add_option("--seconds", options->discovery_s, "duration of discovery")
      .check(positive())
      .show_default();
  add_dds_options(command, options->dds);
  command.on_parsed([options, &action] { action = [options] { return show_graph(*options); }; });
}

}  // namespace sidestep
