// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/wrong_clock_host.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
#include <unistd.h>

#include "deploy/run/launch/process_group.hpp"

namespace sidestep {
namespace {

std::filesystem::path wrong_clock_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "sidestep-late-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("cannot create a temporary folder");
  return name;
}

}  // namespace

WrongClockHost::WrongClockHost(const std::string& processes, const std::string& others, Duration ahead)
    : folder_(wrong_clock_folder()) {
  set_clock(ahead);
  for (const char* name :
       {"sidestep-agent", "sidestep-coordinator", "sidestep-vision", "sidestep-simulator"}) {
    const auto path = folder_ / name;
    std::ofstream(path) << fmt::format(
        "#!/bin/sh\nexport SIDESTEP_TEST_CLOCK={}\nexport LD_PRELOAD={}\nexec {} \"$@\"\n",
        (folder_ / "clock").string(), SIDESTEP_STEPPED_CLOCK, sibling_program_path(name));
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }
  std::ofstream(hosts_file()) << fmt::format(
      "launcher: {{interface: 127.0.0.1}}\nhosts:\n"
      "  - {{name: right, transport: local, interface: 127.0.0.1, {}}}\n"
      "  - {{name: late, transport: local, interface: 127.0.0.1, programs: {}, {}}}\n",
      others, folder_.string(), processes);
}

WrongClockHost::~WrongClockHost() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void WrongClockHost::set_clock(Duration ahead) const {
  const std::int64_t ns = ahead.count();
  const int file = open((folder_ / "clock").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  const bool is_written = file >= 0 && pwrite(file, &ns, sizeof ns, 0) == sizeof ns;
  if (file >= 0) close(file);
  if (!is_written) throw std::runtime_error("cannot set the clock of the late host");
}

}  // namespace sidestep
