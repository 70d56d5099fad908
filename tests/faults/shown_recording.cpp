// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/shown_recording.hpp"

#include <chrono>
#include <fstream>

#include "tests/catch.hpp"

namespace sidestep {

using namespace std::chrono_literals;

ShownRecording::ShownRecording(const std::string& scenario,
                               const std::vector<std::string>& simulate_arguments)
    : group_(folder_.file("log")) {
  const std::string program = sibling_program_path("sidestep"), recording = folder_.file("run.mcap");
  std::vector<std::string> simulate{program,
                                    "simulate",
                                    SIDESTEP_SOURCE_DIR "/deploy/scenarios/" + scenario,
                                    "--record",
                                    recording,
                                    "--report",
                                    folder_.file("report.json")};
  simulate.insert(simulate.end(), simulate_arguments.begin(), simulate_arguments.end());
  group_.start({"simulate", simulate, false});
  bool is_recorded = false;
  for (int i = 0; i < 5000 && !is_recorded; ++i) is_recorded = !group_.poll(20ms).empty();
  REQUIRE(is_recorded);
  group_.start({"monitor", {program, "monitor", recording, "--port", "0"}, false});
  std::string line;
  for (int i = 0; i < 500 && line.find("http://") == std::string::npos; ++i) {
    (void)group_.poll(20ms);
    std::ifstream log(folder_.file("log"));
    while (std::getline(log, line) && line.find("http://") == std::string::npos) {
    }
  }
  REQUIRE(line.find("http://") != std::string::npos);
  url_ = line.substr(line.find("http://"));
}

void ShownRecording::end() { CHECK(group_.terminate(5s).empty()); }

}  // namespace sidestep
