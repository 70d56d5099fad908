// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/process_command.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sys/resource.h>
#include <unistd.h>

#include "common/messaging/dds/event_loop.hpp"
#include "deploy/run/launch/hosts/command.hpp"
#include "deploy/run/launch/process_group.hpp"
#include "deploy/run/launch/revoked_keys.hpp"
#include "tests/catch.hpp"
#include "tests/test_keys.hpp"

using namespace sidestep;
namespace fs = std::filesystem;

namespace {

/// A folder with two fake programs: "sidestep-agent" writes its arguments and its scenario to files and waits
/// for SIGTERM; "ssh" runs the remote command locally in a shell, as sshd would.
struct Fixture {
  Fixture() {
    std::string name = (fs::temp_directory_path() / "sidestep-ssh-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("cannot make a temporary folder");
    folder = name;
    write("ssh", "#!/bin/sh\nwhile [ \"${1#-}\" != \"$1\" ]; do shift; done\necho \"$1\" >" + path("target") +
                     "\nshift\nexec sh -c \"$*\"\n");
    // The file "arguments" appears last; the test may then end the agent.
    write("sidestep-agent", "#!/bin/sh\ntrap 'echo ended >" + path("end") + "; exit 0' TERM\ncat \"$2\" >" +
                                path("scenario") + "\necho \"$2\" >" + path("where") +
                                "\nprintf '%s\\n' \"$@\" >" + path("arguments.part") + "\nmv " +
                                path("arguments.part") + " " + path("arguments") +
                                "\nwhile :; do sleep 0.05; done\n");
    write("it's a scenario.yaml", "robots: all of them\n");
    setenv("PATH", (folder.string() + ":" + old_path).c_str(), 1);
    setenv("TMPDIR", folder.c_str(), 1);
  }
  ~Fixture() {
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
  /// Waits until a file exists, or until it does not exist.
  bool wait_for(ProcessGroup& group, const std::string& file, bool exists = true) const {
    const Time deadline = EventLoop::now() + std::chrono::seconds(30);
    while (fs::exists(file) != exists && EventLoop::now() < deadline)
      group.poll(std::chrono::milliseconds(5));
    return fs::exists(file) == exists;
  }
  /// The folder on the remote host to which the scenario was copied.
  std::string remote_folder() const { return fs::path(read("where")).parent_path().string(); }

  fs::path folder;
  std::string old_path = std::getenv("PATH");
};

ProcessSpec agent_spec(const Fixture& fixture) {
  return {"agent 3", "sidestep-agent", fixture.path("it's a scenario.yaml"), 17, {"--robot", "3"}, false};
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

TEST_CASE("a local process is started directly, and a process in a namespace by ip netns exec") {
  const Fixture fixture;
  const std::vector<std::string> tail{"--scenario",  fixture.path("it's a scenario.yaml"),
                                      "--domain",    "17",
                                      "--interface", "10.1.0.2",
                                      "--robot",     "3"};
  std::vector<std::string> expected{sibling_program_path("sidestep-agent")};
  expected.insert(expected.end(), tail.begin(), tail.end());
  CHECK(child_spec(agent_spec(fixture), host_of(HostTransport::kLocal, ""), "").argv == expected);
  expected.insert(expected.begin(), {find_program("ip"), "netns", "exec", "sidestep-5-east"});
  CHECK(child_spec(agent_spec(fixture), host_of(HostTransport::kNamespace, "east"), "sidestep-5-east").argv ==
        expected);
}

TEST_CASE("agents run at low priority except on hosts that are robots' own computers") {
  const Fixture fixture;
  ProcessSpec vision = agent_spec(fixture);
  vision.program = "sidestep-vision";
  CHECK(child_spec(agent_spec(fixture), host_of(HostTransport::kLocal, ""), "").niceness == 15);
  CHECK(child_spec(agent_spec(fixture), host_of(HostTransport::kNamespace, "east"), "e").niceness == 15);
  CHECK(child_spec(vision, host_of(HostTransport::kLocal, ""), "").niceness == 0);
  // Over ssh the remote program has the low priority, not the connection.
  for (const bool is_shared : {false, true}) {
    HostSpec host = host_of(HostTransport::kSsh, "robot@far");
    host.programs = fixture.folder.string();
    host.coordinator = is_shared;
    fs::remove(fixture.path("arguments"));
    fixture.write("sidestep-agent", "#!/bin/sh\nnice >" + fixture.path("nice") + "\nmv " +
                                        fixture.path("nice") + " " + fixture.path("arguments") + "\n");
    ProcessGroup group(fixture.path("log"));
    const ChildSpec spec = child_spec(agent_spec(fixture), host, "");
    CHECK(spec.niceness == 0);
    group.start(spec);
    REQUIRE(fixture.wait_for(group, fixture.path("arguments")));
    const int before = getpriority(PRIO_PROCESS, 0);
    CHECK(std::stoi(fixture.read("arguments")) == std::min(before + (is_shared ? 15 : 0), 19));
  }
}

TEST_CASE(
    "robots' time to rest delays how soon a remote process is killed, but only drivers are waited for "
    "first") {
  const Fixture fixture;
  ProcessSpec process = agent_spec(fixture);
  process.rest_time = std::chrono::milliseconds(1500);
  const auto local = [&] { return child_spec(process, host_of(HostTransport::kLocal, ""), "").rest_time; };
  CHECK(local() == std::chrono::milliseconds(0));
  HostSpec host = host_of(HostTransport::kSsh, "robot@far");
  host.programs = fixture.folder.string();
  // The remote script gets three seconds more.
  CHECK_THAT(child_spec(process, host, "").argv.back(), ContainsSubstring("'4.5'"));
  process.program = "sidestep-robot";
  CHECK(local() == std::chrono::milliseconds(1500));
}

TEST_CASE("over ssh the scenario is copied, and the process ends when the launcher asks it to") {
  const Fixture fixture;
  HostSpec host = host_of(HostTransport::kSsh, "robot@far");
  host.programs = fixture.folder.string();
  ProcessGroup group(fixture.path("log"));
  group.start(child_spec(agent_spec(fixture), host, ""));
  REQUIRE(fixture.wait_for(group, fixture.path("arguments")));
  CHECK(fixture.read("target") == "robot@far\n");
  CHECK(fixture.read("scenario") == "robots: all of them\n");
  const std::string where = fixture.read("where");
  CHECK(fixture.read("arguments") ==
        "--scenario\n" + where + "--domain\n17\n--interface\n10.1.0.2\n--robot\n3\n");
  CHECK(where.find("it's a scenario.yaml") != std::string::npos);
  CHECK(group.terminate(std::chrono::seconds(20)).empty());
  CHECK(fixture.read("end") == "ended\n");
  CHECK_FALSE(fs::exists(fixture.remote_folder()));
}

TEST_CASE("over ssh the process gets its own keys, and no other user there can read them") {
  const Fixture fixture;
  HostSpec host = host_of(HostTransport::kSsh, "robot@far");
  host.programs = fs::relative(fixture.folder).string();  // relative to the initial folder of ssh
  TestKeys keys({"agent", "3-4"});
  ProcessSpec process = agent_spec(fixture);
  process.keys = keys.folder_of("agent 3");
  ProcessGroup group(fixture.path("log"));
  group.start(child_spec(process, host, ""));
  REQUIRE(fixture.wait_for(group, fixture.path("arguments")));
  CHECK(fixture.read("scenario") == "robots: all of them\n");
  CHECK_THAT(fixture.read("arguments"), ContainsSubstring("\n--keys\n.\n"));
  const KeyFolder copied = load_key_folder(fixture.remote_folder(), keys.now());
  CHECK(to_text(copied.identity) == "agent 3");
  for (const char* name : key_files::kAll) CHECK_FALSE(fs::is_symlink(copied.file(name)));

  // A new list of revoked keys replaces the former list.
  RevokedKeys revoked(process.keys);
  const Time now = EventLoop::now();
  CHECK_FALSE(revoked.changed(now));
  keys.revoke({Role::kAgent, 4, 4});
  CHECK_FALSE(revoked.changed(now));
  const auto list = revoked.changed(now + std::chrono::seconds(2));
  REQUIRE(list);
  CHECK_FALSE(revoked.changed(now + std::chrono::seconds(4)));
  group.add_input("agent 3", file_input(key_files::kRevoked, *list));
  const auto revoked_there = [&] {
    return load_revoked_serials(copied.file(key_files::kRevoked), copied.authority).size();
  };
  const Time deadline = now + std::chrono::seconds(30);
  while (revoked_there() == 0 && EventLoop::now() < deadline) group.poll(std::chrono::milliseconds(5));
  CHECK(revoked_there() == 1);
  CHECK_FALSE(fs::exists(fixture.path("end")));
  CHECK(group.terminate(std::chrono::seconds(20)).empty());
  CHECK_FALSE(fs::exists(fixture.remote_folder()));
}

TEST_CASE("over ssh the process ends with the connection") {
  const Fixture fixture;
  HostSpec host = host_of(HostTransport::kSsh, "robot@far");
  host.programs = fixture.folder.string();
  {
    ProcessGroup group(fixture.path("log"));
    group.start(child_spec(agent_spec(fixture), host, ""));
    REQUIRE(fixture.wait_for(group, fixture.path("arguments")));
  }  // kills the fake ssh and thereby closes the pipe
  ProcessGroup empty_group(fixture.path("log"));
  CHECK(fixture.wait_for(empty_group, fixture.path("end")));
  CHECK(fixture.wait_for(empty_group, fixture.remote_folder(), false));
}
