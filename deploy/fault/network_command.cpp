// SPDX-License-Identifier: Apache-2.0
#include "deploy/fault/network_command.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <vector>

#include "common/messaging/dds/event_loop.hpp"
#include "common/messaging/impairment.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/fault/orders.hpp"

namespace sidestep {
namespace {

struct NetworkOptions {
  std::string target;
  double loss = 0;
  double burst = 1;
  double duplicate = 0;
  std::vector<double> delay_ms{0, 0, 0};
  bool is_cut = false;
  bool is_clear = false;
  std::uint64_t seed = 1;
  std::optional<double> seconds;
  DdsSettings dds;
};

msg::NetworkFault clear_order(std::uint32_t target) {
  msg::NetworkFault order;
  order.target(target);
  order.mean_burst(1);
  return order;
}

msg::NetworkFault order_from(const NetworkOptions& options, std::uint32_t target) {
  msg::NetworkFault order = clear_order(target);
  const auto ns = [&](std::size_t i) { return std::llround(options.delay_ms[i] * 1e6); };
  order.seed(options.seed);
  order.loss(options.loss);
  order.mean_burst(options.burst);
  order.duplicate(options.duplicate);
  order.delay_min_ns(ns(0));
  order.delay_mean_ns(ns(1));
  order.delay_max_ns(ns(2));
  order.is_cut(options.is_cut);
  return order;
}

void send(OperatorChannel& orders, msg::NetworkFault order) {
  order.head(order_head());
  orders.writer().write(&order);
  wait_until_taken(orders);
}

int disturb(const NetworkOptions& options) {
  const auto target = order_target(options.target);
  const msg::NetworkFault order = order_from(options, target->number);
  OperatorChannel orders(options.dds, topics::kNetworkFault);
  EventLoop loop;
  const StopSignals stop_signals([&loop] { loop.stop(); });
  wait_for_taker(orders, target->participant);
  send(orders, order);
  fmt::print("taken by {}\n", target->participant.empty()
                                  ? fmt::format("{}", fmt::join(orders.takers(), ", "))
                                  : target->participant);
  if (!options.seconds) return 0;
  std::fflush(stdout);
  loop.run_until(EventLoop::now() + from_seconds(*options.seconds));
  send(orders, clear_order(target->number));
  fmt::print("cleared\n");
  return 0;
}

/// What is wrong with the options together; empty: nothing.
std::string complaint(const NetworkOptions& options) {
  if (!order_target(options.target))
    return "--target: expected all, 'agent N', coordinator, 'coordinator N', vision or simulator, got '" +
           options.target + "'";
  const bool is_nothing = link_quality_from(order_from(options, 0)) == kUntouchedLink;
  if (options.is_clear != is_nothing)
    return options.is_clear ? "--clear goes with nothing else"
                            : "expected --clear, --cut, --loss, --delay-ms or --duplicate";
  if (!link_quality_from(order_from(options, 0)))
    return "--delay-ms: expected least, mean and most, in this order, at most 10000";
  if (options.burst > 1 && options.loss <= 0) return "--burst needs --loss";
  if (options.is_clear && options.seconds) return "--seconds: there is nothing to end";
  return "";
}

}  // namespace

void add_network_command(CLI::App& fault, std::function<int()>& action) {
  const auto options = std::make_shared<NetworkOptions>();
  options->dds.participant = "sidestep-fault";
  CLI::App* command =
      fault.add_subcommand("network", "Disturbs the messages that reach processes started with --faults");
  command
      ->add_option("--target", options->target,
                   "all, 'agent 3', coordinator, 'coordinator 1', vision, simulator")
      ->required();
  command->add_option("--loss", options->loss, "probability")->check(CLI::Range(0.0, 1.0));
  command->add_option("--burst", options->burst, "losses come in bursts of so many on average")
      ->check(CLI::Range(1.0, 1e6));
  command->add_option("--duplicate", options->duplicate, "probability")->check(CLI::Range(0.0, 1.0));
  command->add_option("--delay-ms", options->delay_ms, "least, mean and most, e.g. 5,20,150")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::Range(0.0, 10000.0));
  command->add_flag("--cut", options->is_cut, "nothing arrives");
  command->add_flag("--clear", options->is_clear, "everything arrives again");
  command->add_option("--seed", options->seed, "of what is drawn")->capture_default_str();
  command->add_option("--seconds", options->seconds, "clear after that; without it until --clear")
      ->check(CLI::PositiveNumber);
  add_dds_options(*command, options->dds);
  command->callback([options, &action] {
    if (const std::string wrong = complaint(*options); !wrong.empty()) throw CLI::ValidationError(wrong);
    action = [options] { return disturb(*options); };
  });
}

}  // namespace sidestep
