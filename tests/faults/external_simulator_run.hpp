// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/league/control_packet.hpp"
#include "common/league/unicast.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/test_endpoint.hpp"

namespace sidestep {

/// `sidestep run --driver league` on a floor that another process simulates. The run communicates with the
/// simulator only by the league's protocol, over UDP on the loopback interface. The simulator is Sidestep's,
/// so that there is ground truth. No process outlives this object.
class ExternalSimulatorRun {
 public:
  /// `has_truth`: the run receives the ground truth. Otherwise it is judged from vision, as with a
  /// third-party simulator. Of `run_options`, `--robots=…` replaces the driver's latency of 119 ms, and
  /// `--place` gets the simulator's control port.
  explicit ExternalSimulatorRun(const std::string& scenario,
                                const std::vector<std::string>& simulator_options = {},
                                const std::vector<std::string>& run_options = {}, bool has_truth = true);

  LaunchedRun& run() { return *run_; }
  /// `options` replace those of the constructor: the simulator may return with other traits, or with its
  /// robots at other places.
  void start_simulator(const std::vector<std::string>& options);
  void start_simulator() { start_simulator(simulator_options_); }
  void kill_simulator();
  /// The ports of the simulator.
  league::Endpoint control() const { return endpoints_.unicast(1); }
  league::Endpoint blue() const { return endpoints_.unicast(2); }
  league::Endpoint yellow() const { return endpoints_.unicast(3); }

 private:
  TestEndpoint endpoints_;
  std::vector<std::string> simulator_options_;
  bool has_truth_;
  std::unique_ptr<LaunchedRun> run_;
  pid_t simulator_ = 0;
  int starts_ = 0;
};

}  // namespace sidestep
