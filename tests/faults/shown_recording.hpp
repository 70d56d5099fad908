// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/file/temporary_folder.hpp"
#include "deploy/run/launch/process_group.hpp"

namespace sidestep {

/// Records a simulated run of a shipped scenario and starts a monitor that shows the recording.
class ShownRecording {
 public:
  explicit ShownRecording(const std::string& scenario,
                          const std::vector<std::string>& simulate_arguments = {});

  const std::string& url() const { return url_; }
  /// Ends the monitor and checks that it ended well.
  void end();

 private:
  TemporaryFolder folder_;
  ProcessGroup group_;
  std::string url_;
};

}  // namespace sidestep
