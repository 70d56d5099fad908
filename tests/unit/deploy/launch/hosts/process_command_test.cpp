// SPDX-License-Identifier: Apache-2.0
#include "deploy/launch/hosts/process_command.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <unistd.h>

#include "common/messaging/dds/event_loop.hpp"
#include "deploy/launch/hosts/command.hpp"

using namespace sidestep;
namespace fs = std::filesystem;

namespace {

/// A folder with a program "sidestep-agent" that writes its arguments and its scenario into files and then
/// waits for its end, and a program "ssh" that runs here what it is to run there, as sshd would: in a shell.
struct Stage {
  Stage() {
    std::string name = (fs::temp_directory_path() / "sidestep-ssh-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    folder = name;
    write("ssh", "#!/bin/sh\nwhile [ \"${1#-}\" != \"$1\" ]; do shift; done\necho \"$1\" >" + path("target") +
                     "\nshift\nexec sh -c \"$*\"\n");
    // Who sees its arguments may end it.
    write("sidestep-agent", "#!/bin/sh\ntrap 'echo ended >" + path("end") + "; exit 0' TERM\ncat \"$2\" >" +
                                path("scenario") + "\necho \"$2\" >" + path("where") +
                                "\nprintf '%s\\n' \"$@\" >" + path("arguments.part") + "\nmv " +
                                path("arguments.part") + " " + path("arguments") +
                                "\nwhile :; do sleep 0.05; done\n");
    write("it's a scenario.yaml", "robots: all of them\n");
    setenv("PATH", (folder.string() + ":" + old_path).c_str(), 1);
    setenv("TMPDIR", folder.c_str(), 1);
  }
  ~Stage() {
    setenv("PATH", old_path.c_str(), 1);
    unsetenv("TMPDIR");
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    fs::permissions(path(name), fs::perms::owner_all);
  }
  std::string read(const std::string& name) const {
    std::ifstream file(path(name));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Waits until a file is there, or is no longer.
  bool wait_for(ProcessGroup& group, const std::string& file, bool there = true) const {
    const Time deadline = EventLoop::now() + std::chrono::seconds(30);
    while (fs::exists(file) != there && EventLoop::now() < deadline) group.poll(std::chrono::milliseconds(5));
    return fs::exists(file) == there;
  }
  /// The folder that the scenario was copied into, on the host where the agent runs.
  std::string far_folder() const { return fs::path(read("where")).parent_path().string(); }

  fs::path folder;
  std::string old_path = std::getenv("PATH");
};

ProcessCall agent_call(const Stage& stage) {
  return {"agent 3", "sidestep-agent", stage.path("it's a scenario.yaml"), 17, {"--robot", "3"}, false};
}

HostSpec host_of(HostTransport transport, const std::string& target) {
  HostSpec host;
  host.name = "far";
  host.transport = transport;
  host.target = target;
  host.interface = "10.1.0.2";
  return host;
}

}  // namespace

TEST_CASE("a process here is started directly, one in a namespace by ip netns exec") {
  const Stage stage;
  const std::vector<std::string> tail{"--scenario",  stage.path("it's a scenario.yaml"),
                                      "--domain",    "17",
                                      "--interface", "10.1.0.2",
                                      "--robot",     "3"};
  std::vector<std::string> expected{program_beside_own("sidestep-agent")};
  expected.insert(expected.end(), tail.begin(), tail.end());
  CHECK(child_on_host(agent_call(stage), host_of(HostTransport::kLocal, ""), "").argv == expected);
  expected.insert(expected.begin(), {find_program("ip"), "netns", "exec", "sidestep-5-east"});
  CHECK(
      child_on_host(agent_call(stage), host_of(HostTransport::kNamespace, "east"), "sidestep-5-east").argv ==
      expected);
}

TEST_CASE("over ssh the scenario comes along, and the process ends when the launcher asks") {
  const Stage stage;
  HostSpec host = host_of(HostTransport::kSsh, "robot@far");
  host.programs = stage.folder.string();
  ProcessGroup group(stage.path("log"));
  group.start(child_on_host(agent_call(stage), host, ""));
  REQUIRE(stage.wait_for(group, stage.path("arguments")));
  CHECK(stage.read("target") == "robot@far\n");
  CHECK(stage.read("scenario") == "robots: all of them\n");
  const std::string where = stage.read("where");
  CHECK(stage.read("arguments") ==
        "--scenario\n" + where + "--domain\n17\n--interface\n10.1.0.2\n--robot\n3\n");
  CHECK(where.find("it's a scenario.yaml") != std::string::npos);
  CHECK(group.terminate(std::chrono::seconds(20)).empty());
  CHECK(stage.read("end") == "ended\n");
  CHECK_FALSE(fs::exists(stage.far_folder()));
}

TEST_CASE("over ssh the process ends when the connection does") {
  const Stage stage;
  HostSpec host = host_of(HostTransport::kSsh, "robot@far");
  host.programs = stage.folder.string();
  {
    ProcessGroup group(stage.path("log"));
    group.start(child_on_host(agent_call(stage), host, ""));
    REQUIRE(stage.wait_for(group, stage.path("arguments")));
  }  // kills what stands for ssh, and with it goes the other end of the pipe
  ProcessGroup nobody(stage.path("log"));
  CHECK(stage.wait_for(nobody, stage.path("end")));
  CHECK(stage.wait_for(nobody, stage.far_folder(), false));
}
