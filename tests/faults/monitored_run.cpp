// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/monitored_run.hpp"

#include <fmt/format.h>

#include "common/json/json_text.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/view/server/web_client.hpp"

namespace sidestep {

MonitorProcess::MonitorProcess(LaunchedRun& run, const std::vector<std::string>& extra_arguments,
                               std::uint16_t wanted_port, const std::string& name) {
  std::vector<std::string> arguments{"monitor", run.scenario_file(), "--port", std::to_string(wanted_port)};
  for (const std::string& argument : run.dds_arguments()) arguments.push_back(argument);
  arguments.insert(arguments.end(), extra_arguments.begin(), extra_arguments.end());
  pid_ = run.start(name, "sidestep", arguments);
  const std::string begin = name + ": monitor: http://127.0.0.1:";
  REQUIRE(run.wait_until([&] { return run.printed(begin); }));
  std::string line = run.output().substr(run.output().rfind(begin) + begin.size());
  line.resize(line.find('\n'));
  port_ = static_cast<std::uint16_t>(std::stoi(line));
  const std::size_t hash = line.find("#token=");
  if (hash != std::string::npos) token_ = line.substr(hash + 7);
}

std::string MonitorProcess::url() const {
  return fmt::format("http://127.0.0.1:{}/{}", port_, token_.empty() ? "" : "#token=" + token_);
}

nlohmann::json MonitorProcess::state() const {
  return parse_json(http_request(port_, "GET", "/api/state").body);
}

std::function<void()> polling(LaunchedRun& run) {
  return [&run] { (void)run.wait_until([] { return true; }); };
}

void wait(LaunchedRun& run, Duration duration) {
  const Time end = run.bus().now() + duration;
  REQUIRE(run.wait_until([&] { return run.bus().now() > end; }));
}

}  // namespace sidestep
