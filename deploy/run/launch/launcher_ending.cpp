// SPDX-License-Identifier: Apache-2.0
// The end of a run: robots come to rest before the processes that move them end.
#include <chrono>
#include <fmt/format.h>

#include "common/motion/time_to_rest.hpp"
#include "common/protocol/moving_text.hpp"
#include "common/protocol/process_names.hpp"
#include "deploy/run/launch/ending.hpp"
#include "deploy/run/launch/launcher.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

/// Maximum distance between sightings of a robot at rest; noise_m is that of vision.
double rest_tolerance_m(bool has_truth, double noise_m) { return has_truth ? 0.005 : 0.01 + 5 * noise_m; }

}  // namespace

std::string Launcher::end_cause() const {
  if (!abort_reason_.empty()) return abort_reason_;
  if (is_interrupted_) return kInterrupted;
  if (director_.act) return "the test is over";
  return metrics_.all_arrived() ? "all robots arrived" : "time limit";
}

std::set<std::string> Launcher::ask_to_end(const std::string& program) {
  std::set<std::string> asked;
  for (const auto& [name, process] : processes_) {
    if (process.program == program && children_.ask_to_end(name)) asked.insert(name);
  }
  return asked;
}

std::set<std::string> Launcher::running(const std::string& program) const {
  std::set<std::string> names;
  for (const auto& [name, process] : processes_) {
    if (process.program == program && !dead_.count(name)) names.insert(name);
  }
  return names;
}

void Launcher::bring_to_rest() {
  const Time begin = bus_.now();
  const std::uint64_t contacts = metrics_.report().contacts;
  if (is_interrupted_) print("interrupted: all robots come to rest; Ctrl-C again ends at once");
  const std::string cause = end_cause();
  Ending ending({time_to_rest(scenario_.limits),
                 rest_tolerance_m(metrics_.has_truth(), scenario_.vision.position_noise_m)},
                begin);
  // Agents of a director that died may be unknown to this one; they come to rest when all others end.
  std::set<std::string> agents = ask_to_end("sidestep-agent"), drivers = running("sidestep-robot");
  const auto handle_end = [&](const ChildEvent& event) {
    if (event.kind != ChildEvent::Kind::kDied) return handle(event);
    const bool moves_robots = agents.erase(event.name) + drivers.erase(event.name) > 0;
    // A process that has just started does not handle signals yet.
    const bool is_orderly = event.reason == "exit code 0" || event.reason == "signal 15 (SIGTERM)";
    if (!moves_robots || !is_orderly) handle(event);
  };
  for (auto step = Ending::Step::kRobotsStop; step != Ending::Step::kOver && !gives_up_;) {
    bus_.run_until(bus_.now() + 20ms);
    for (const ChildEvent& event : children_.poll(0ms)) handle_end(event);
    print_new_epochs();
    if (!options_.is_quiet) display_.update(metrics_, bus_.now());
    const auto next = ending.update(bus_.now(), metrics_.sightings(), {!agents.empty(), !drivers.empty()});
    if (next == Ending::Step::kDriversEnd && step != next) drivers = ask_to_end("sidestep-robot");
    step = next;
  }
  ending_ = {cause, to_seconds(bus_.now() - begin), metrics_.report().contacts - contacts, ending.problem()};
  if (gives_up_) {
    const std::string moving = still_moving_text(ending.moving_robots());
    print("ends at once: " + (moving.empty() ? "all robots rest" : moving), LogLevel::kWarning);
    if (!ending_->problem.empty()) ending_->problem = "ended by a second Ctrl-C: " + ending_->problem;
    return children_.abandon();
  }
  if (!ending_->problem.empty()) print("end of the run: " + ending_->problem, LogLevel::kWarning);
}

}  // namespace sidestep
