// SPDX-License-Identifier: Apache-2.0
#include "common/process/process_run.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <fmt/core.h>
#include <optional>
#include <stdexcept>
#include <sys/eventfd.h>
#include <system_error>
#include <unistd.h>
#include <utility>

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

/// Requests to stop, made from a signal handler. They stop the current bus, unless its nodes have to finish
/// first; those learn of a request from a descriptor.
class StopRequest {
 public:
  StopRequest() : event_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (event_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  }
  ~StopRequest() { close(event_); }
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  void make() {
    is_made = true;
    if (!must_finish) return stop_bus();
    const int saved_errno = errno;
    const std::uint64_t one = 1;
    (void)!write(event_, &one, sizeof one);
    errno = saved_errno;
  }
  void give_up() {
    is_given_up = true;
    stop_bus();
  }
  /// Is readable while requests that acknowledge() has not read are waiting.
  int descriptor() const { return event_; }
  void acknowledge() const {
    std::uint64_t count = 0;
    (void)!read(event_, &count, sizeof count);
  }

  std::atomic<bool> is_made{false}, is_given_up{false}, must_finish{false};
  std::atomic<DdsBus*> bus{nullptr};

 private:
  void stop_bus() {
    if (DdsBus* const current = bus) current->stop();
  }

  int event_;
};

/// Registers the bus with a stop request for the lifetime of the object.
class StoppableBus {
 public:
  StoppableBus(StopRequest& request, DdsBus& bus) : request_(request) {
    request_.bus = &bus;
    if (request_.is_made) bus.stop();
  }
  ~StoppableBus() {
    request_.must_finish = false;
    request_.bus = nullptr;
  }
  StoppableBus(const StoppableBus&) = delete;
  StoppableBus& operator=(const StoppableBus&) = delete;

 private:
  StopRequest& request_;
};

/// Stops the bus once the nodes have finished.
void stop_when_finished(DdsBus& bus, const std::function<bool()>& finish) {
  constexpr Duration kPeriod = std::chrono::milliseconds(10);
  if (finish()) return bus.stop();
  bus.at(bus.now() + kPeriod, [&bus, &finish] { stop_when_finished(bus, finish); });
}

/// From now on the nodes finish before a request stops the bus. All arguments must outlive the bus's last
/// callback.
void finish_before_stop(DdsBus& bus, StopRequest& stop, const RunningNodes& running, bool& is_finishing) {
  stop.must_finish = true;
  bus.watch(stop.descriptor(), [&] {
    stop.acknowledge();
    if (std::exchange(is_finishing, true)) return;
    log(LogLevel::kInfo, "asked to end: robots come to rest first");
    stop_when_finished(bus, running.finish);
  });
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
  const StoppableBus stoppable(stop, bus);
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
  bool is_finishing = false;
  if (running.finish) finish_before_stop(bus, stop, running, is_finishing);
  log(LogLevel::kInfo,
      fmt::format("Fast DDS {}, domain {}, listening on {}", fast_dds_version(), dds.domain, bus.locators()));
  log(LogLevel::kInfo, budget_line(budget_of(scenario), scenario.margin_m));
  if (scenario.map && !scenario.map->notice().empty()) log(LogLevel::kInfo, scenario.map->notice());
  bus.run();
  if (stop.is_given_up && running.unfinished) {
    if (const std::string text = running.unfinished(); !text.empty())
      log(LogLevel::kWarning, "gives up: " + text);
  }
  if (yields_to) throw std::runtime_error(*yields_to);
  return adopts && !stop.is_made;
}

}  // namespace

void run_program(const Program& program, const Scenario& scenario, const DdsSettings& dds) {
  // A process whose log is no longer read still brings its robots to rest.
  std::signal(SIGPIPE, SIG_IGN);
  StopRequest stop;
  const StopSignals stop_signals([&stop] { stop.make(); }, [&stop] { stop.give_up(); });
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
