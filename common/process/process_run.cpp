// SPDX-License-Identifier: Apache-2.0
#include "common/process/process_run.hpp"

#include <atomic>
#include <fmt/core.h>
#include <optional>
#include <stdexcept>

#include "common/log/log.hpp"
#include "common/messaging/clock_responder.hpp"
#include "common/messaging/role_watch.hpp"
#include "common/messaging/rules_exchange.hpp"
#include "common/process/host_name.hpp"
#include "common/process/network_faults.hpp"
#include "common/process/stop_signals.hpp"
#include "common/time/clock_bounds.hpp"

namespace sidestep {
namespace {

/// Stops the current bus from a signal handler.
struct StopRequest {
  void make() {
    is_made = true;
    if (DdsBus* const current = bus) current->stop();
  }
  std::atomic<bool> is_made{false};
  std::atomic<DdsBus*> bus{nullptr};
};

/// Registers the bus with a stop request for the lifetime of the object.
class StoppableBus {
 public:
  StoppableBus(StopRequest& request, DdsBus& bus) : request_(request) {
    request_.bus = &bus;
    if (request_.is_made) bus.stop();
  }
  ~StoppableBus() { release(); }
  StoppableBus(const StoppableBus&) = delete;
  StoppableBus& operator=(const StoppableBus&) = delete;

  /// Detaches the bus, so that the request no longer stops it.
  void release() { request_.bus = nullptr; }

 private:
  StopRequest& request_;
};

/// Stops the bus once the process has been asked to end and the nodes have finished.
void stop_when_finished(DdsBus& bus, const StopRequest& request, const std::function<bool()>& finish) {
  constexpr Duration kPeriod = std::chrono::milliseconds(10);
  if (request.is_made && finish()) return bus.stop();
  bus.at(bus.now() + kPeriod, [&] { stop_when_finished(bus, request, finish); });
}

void log_step(Duration host_ahead) {
  log(LogLevel::kWarning, fmt::format("the host's clock was set and is now {:+.3f} s ahead of this "
                                      "process's clock, which is unchanged",
                                      to_seconds(host_ahead)));
}

/// Runs the program on one bus. Returns whether it must restart with the host's clock.
bool run_on_bus(const Program& program, const Scenario& scenario, const DdsSettings& dds,
                Incarnation incarnation, StopRequest& stop) {
  DdsBus bus(dds);
  StoppableBus stoppable(stop, bus);
  const std::uint32_t process = program.process();
  const RulesExchange rules(bus, process, SharedRules(scenario), [](const RulesMismatch& mismatch) {
    log(LogLevel::kWarning, describe(mismatch));
  });
  bus.listen_before_trusting();
  bus.watch_conflicts([](const TopicInfo& topic, std::uint32_t robot, const msg::Header& header) {
    log(LogLevel::kError, describe_conflict(topic, robot, header));
  });
  std::optional<std::string> yields_to;
  const RoleWatch role(bus, process, incarnation, [&](Incarnation other) {
    const std::string text = describe_other(process, incarnation, other);
    if (!must_be_alone(process) || incarnation < other) return log(LogLevel::kError, text);
    yields_to = text;
    bus.stop();
  });
  const RunningNodes running = program.start(bus, scenario, incarnation);
  const ClockResponder responder(bus,
                                 {process, incarnation, scenario.clock_bound_s, host_name(), scenario.name},
                                 DdsBus::host_clock_ahead);
  bool adopts = false;
  const auto adopt = [&] {
    adopts = true;
    bus.stop();
  };
  const auto is_in_use = [&] { return running.uses_clock && running.uses_clock(); };
  const HostClockWatch watch(bus, program.clock_reference, max_clock_difference(scenario.clock_bound_s),
                             {DdsBus::host_clock_ahead, is_in_use, adopt, log_step});
  if (dds.faults) apply_network_faults(bus, process);
  if (running.finish) {
    stoppable.release();
    stop_when_finished(bus, stop, running.finish);
  }
  log(LogLevel::kInfo,
      fmt::format("Fast DDS {}, domain {}, listening on {}", fast_dds_version(), dds.domain, bus.locators()));
  log(LogLevel::kInfo, budget_line(budget_of(scenario), scenario.margin_m));
  if (scenario.map && !scenario.map->notice().empty()) log(LogLevel::kInfo, scenario.map->notice());
  bus.run();
  if (yields_to) throw std::runtime_error(*yields_to);
  return adopts && !stop.is_made;
}

}  // namespace

void run_program(const Program& program, const Scenario& scenario, const DdsSettings& dds) {
  StopRequest stop;
  const StopSignals stop_signals([&stop] { stop.make(); });
  Incarnation incarnation = next_incarnation(0, DdsBus::clock());
  while (run_on_bus(program, scenario, dds, incarnation, stop)) {
    const double by_s = to_seconds(DdsBus::host_clock_ahead());
    DdsBus::adopt_host_clock();
    log(LogLevel::kWarning, fmt::format("restarting: the host's clock was set by {:+.3f} s and now agrees "
                                        "with the other processes' clocks",
                                        by_s));
    incarnation = next_incarnation(incarnation, DdsBus::clock());
  }
}

}  // namespace sidestep
