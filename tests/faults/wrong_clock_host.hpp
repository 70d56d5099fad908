// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "common/time/time.hpp"

namespace sidestep {

/// A host of a run, simulated on this machine, whose clock a test can set. The run's other host has the right
/// clock.
class WrongClockHost {
 public:
  /// `processes` run on this host and `others` on the other host, both as in a hosts file, e.g. "processes:
  /// [vision], agents: [0-3]". `ahead` is the lead of this host's clock at the start.
  WrongClockHost(const std::string& processes, const std::string& others, Duration ahead);
  ~WrongClockHost();
  WrongClockHost(const WrongClockHost&) = delete;
  WrongClockHost& operator=(const WrongClockHost&) = delete;

  std::string hosts_file() const { return (folder_ / "hosts.yaml").string(); }
  /// Sets the host's clock so that it is this far ahead.
  void set_clock(Duration ahead) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace sidestep
