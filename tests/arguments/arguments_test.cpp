// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <functional>
#include <sys/stat.h>

#include "common/file/temporary_folder.hpp"
#include "tests/arguments/program_run.hpp"
#include "tests/arguments/table.hpp"
#include "tests/catch.hpp"
#include "tests/needs_root.hpp"
#include "tests/sanitized.hpp"
#include "tests/small_disk.hpp"
#include "tests/taken_port.hpp"
#include "tests/test_domain.hpp"

namespace sidestep::arguments {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

const std::string kSource = SIDESTEP_SOURCE_DIR;

/// Runs rows of the table, and records the largest processor time and memory.
class Runner {
 public:
  Runner() : placeholders_(prepare()), table_(read_table(kSource + "/tests/arguments/table.txt")) {}
  ~Runner() {
    fmt::print("{} command lines; at most {:.2f} s of processor time: {}\nat most {:.0f} MB: {}\n", rows_,
               slowest_s_, slowest_, largest_mb_, largest_);
  }

  const std::vector<Section>& table() const { return table_; }
  const Placeholders& placeholders() const { return placeholders_; }
  std::string file(const std::string& name) const { return folder_.file(name); }

  void check(const Row& row) {
    const std::string line = fmt::format("{}", fmt::join(row.command, " ")).substr(0, 300);
    const ProgramRun run = run_program(row.command, folder_.path(), kPatience, SIGKILL);
    INFO(line << "\n" << run.errors.substr(0, 1000));
    CHECK(run.exit_code == row.exit_code);
    for (const std::string& message : row.messages) CHECK_THAT(run.errors, ContainsSubstring(message));
    CHECK(run.processor_s < kMaxProcessor_s);
    CHECK((kIsSanitized || run.max_mb < 300));
    ++rows_;
    if (run.processor_s > slowest_s_) slowest_s_ = run.processor_s, slowest_ = line;
    if (run.max_mb > largest_mb_) largest_mb_ = run.max_mb, largest_ = line;
  }

 private:
  static constexpr double kMaxProcessor_s = kIsSanitized ? 20 : 1;
  static constexpr std::chrono::milliseconds kPatience = kIsSanitized ? 120s : 15s;

  Placeholders prepare() const {
    const auto write = [&](const char* name, const std::string& text) {
      std::ofstream(folder_.file(name), std::ios::binary) << text;
      return folder_.file(name);
    };
    for (const char* name : {"out", "fifo-keys", "building"}) fs::create_directory(folder_.file(name));
    write("building/map.pgm", "P5\n");
    mkfifo(folder_.file("fifo").c_str(), 0600);
    mkfifo(folder_.file("out/fifo").c_str(), 0600);
    fs::create_directory(folder_.file("out/fifo-keys"));
    for (const char* name : {"cert.pem", "crl.pem", "governance.p7s", "identity_ca.cert.pem", "key.pem",
                             "permissions.p7s", "permissions_ca.cert.pem"})
      mkfifo(folder_.file(std::string("out/fifo-keys/") + name).c_str(), 0600);
    const std::string keys = folder_.file("keys");
    const ProgramRun init =
        run_program({"sidestep", "keys", "init", keys}, folder_.path(), kPatience, SIGKILL);
    if (init.exit_code != 0) throw std::runtime_error("keys init: " + init.errors);
    fs::create_directory(keys + "/enclaves");
    const std::string scenarios = kSource + "/deploy/scenarios/";
    return {{"scenario", scenarios + "crossing.yaml"},
            {"images", scenarios + "crossing-images.yaml"},
            {"test", scenarios + "faults/agent-killed.yaml"},
            {"folder", folder_.file("out")},
            {"fifo", folder_.file("fifo")},
            {"building", folder_.file("building")},
            {"keys", keys},
            {"magic", write("magic.mcap", "\x89MCAP0\r\n")},
            {"long", std::string(5000, 'x')},
            {"port", port_.number()},
            {"domain", std::to_string(domain_.number())}};
  }

  TemporaryFolder folder_;
  TestDomain domain_;
  TakenPort port_;
  Placeholders placeholders_;
  std::vector<Section> table_;
  std::size_t rows_ = 0;
  double slowest_s_ = 0, largest_mb_ = 0;
  std::string slowest_, largest_;
};

/// The error that a file in broken/ must cause, from its first line "# expected: LINE: MESSAGE".
std::string expectation_of(const fs::path& file) {
  constexpr std::string_view kStart = "# expected: ";
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  if (!line.starts_with(kStart))
    throw std::runtime_error(file.string() + ": the first line must state the expected error");
  return line.substr(kStart.size());
}

/// A row of the table for a command and a file that the command must refuse.
Row row_for(const Runner& runner, const std::string& command, const std::string& file,
            const std::vector<std::string>& messages) {
  Placeholders placeholders = runner.placeholders();
  placeholders["file"] = file;
  return {2, messages, words_of(command, placeholders)};
}

TEST_CASE("an invalid option value is refused with a message that names the option and its limits",
          "[slow]") {
  Runner runner;
  const std::vector<Row> rows = option_rows(runner.table(), runner.placeholders());
  REQUIRE(rows.size() > 1000);
  for (const Row& row : rows) runner.check(row);
}

TEST_CASE("every command that reads files refuses a file of the wrong kind and names it", "[slow]") {
  Runner runner;
  const std::pair<std::string, const char*> files[] = {{runner.file("missing"), ": "},
                                                       {runner.file("out"), "a directory"},
                                                       {runner.file("fifo"), "not a regular file"},
                                                       {"/dev/zero", "not a regular file"}};
  for (const std::string& command : commands_of(runner.table(), "unreadable")) {
    for (const auto& [file, reason] : files) runner.check(row_for(runner, command, file, {file, reason}));
    runner.check(row_for(runner, command, "", {"expected some text"}));
  }
}

TEST_CASE("every command that reads YAML refuses broken YAML and prints file and line and reason", "[slow]") {
  Runner runner;
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& entry : fs::directory_iterator(kSource + "/tests/arguments/broken"))
    files.emplace_back(entry.path().string(), expectation_of(entry.path()));
  const auto add = [&](const char* name, const std::string& text, const char* expected) {
    std::ofstream(runner.file(name), std::ios::binary) << text;
    files.emplace_back(runner.file(name), expected);
  };
  add("deep.yaml", std::string(16'000'000, '['), "1: expected at most 500 nested brackets");
  add("binary.yaml",
      std::string("\x7f"
                  "ELF\x02\x01\x01\0\0\0",
                  10) +
          std::string(1000, '\xff'),
      "1: ");
  add("utf16.yaml",
      std::string("\xff\xfe"
                  "a\0:\0 \0[\0",
                  10),
      "1: not YAML");
  add("empty.yaml", "", "1: the file is empty");
  add("large.yaml", "a: " + std::string(16'000'001, 'x'), " cannot read the file (it is larger than 16 MB)");
  add(
      "many.yaml",
      "a: [" +
          [] {
            std::string values;
            for (int i = 0; i < 400'001; ++i) values += "1,";
            return values;
          }() +
          "]",
      "1: more than 400000 values");
  add(
      "structure.yaml",
      "[" +
          [] {
            std::string lists;
            for (int i = 0; i < 5'000'000; ++i) lists += "[],";
            return lists;
          }() +
          "]",
      "1: more than 800000 of the characters");
  add("long-key.yaml", std::string(100'000, 'k') + ": 1\n", "1: ");
  REQUIRE(files.size() > 15);
  for (const std::string& command : commands_of(runner.table(), "yaml"))
    for (const auto& [file, expected] : files)
      runner.check(row_for(runner, command, file, {file + ":" + expected}));
}

TEST_CASE("unknown options and surplus arguments are refused by name", "[slow]") {
  Runner runner;
  for (const std::string& command : commands_of(runner.table(), "unknown")) {
    for (const std::string extra :
         {"--no-such-option", "--no-such-option=3", "-Z", "too-many-words", "\xf0\x9f\xa4\x96"}) {
      Row row = row_for(runner, command, "", {extra});
      // Commands that accept several words would refuse this for another reason.
      row.command.push_back(extra);
      runner.check(row);
    }
  }
}

TEST_CASE("invalid command lines are refused with the reason", "[slow]") {
  Runner runner;
  const std::vector<Row> rows = single_rows(runner.table(), runner.placeholders());
  REQUIRE(rows.size() > 150);
  for (const Row& row : rows) runner.check(row);
}

/// Folders in which nothing can be written, each with the part of the message that names the cause.
class FlawedFolders {
 public:
  /// Makes a folder of keys in each folder before it gets its flaw.
  explicit FlawedFolders(const std::function<void(const std::string& folder)>& make_keys) {
    for (const SmallDisk* disk : {&full_, &read_only_}) make_keys(disk->file("keys"));
    full_.fill();
    read_only_.make_read_only();
    fs::permissions(closed_.path(), fs::perms(0555));
  }
  std::string path(const std::string& flaw) const {
    return flaw == "full" ? full_.path() : flaw == "read-only" ? read_only_.path() : closed_.path();
  }
  std::string cause(const std::string& flaw) const {
    if (flaw == "full") return "No space left on device";
    if (flaw == "read-only") return "Read-only file system";
    return "user root may not write " + closed_.path() + ": " + closed_.path() +
           " belongs to root and has mode 0555";
  }

 private:
  SmallDisk full_{512}, read_only_{512};
  TemporaryFolder closed_;
};

/// The command as root without the right to ignore permissions.
std::vector<std::string> without_override(std::vector<std::string> command) {
  command[0] = (fs::read_symlink("/proc/self/exe").parent_path() / command[0]).string();
  command.insert(command.begin(), {"/usr/bin/setpriv", "--bounding-set=-dac_override,-dac_read_search"});
  return command;
}

TEST_CASE("every command that writes refuses a full, read-only or closed folder, and names the true cause",
          "[slow]") {
  SIDESTEP_NEEDS_ROOT();
  Runner runner;
  const auto run = [&](const std::vector<std::string>& command) {
    const ProgramRun done = run_program(command, runner.file(""), 60s, SIGKILL);
    INFO(command[0] << " " << command[1] << "\n" << done.errors);
    REQUIRE((done.exit_code == 0 || command[1] == "simulate"));
  };
  const FlawedFolders folders([&](const std::string& keys) {
    run({"sidestep", "keys", "init", keys});
    run({"sidestep", "keys", "issue", "agent 3", "--keys", keys});
  });
  Placeholders placeholders = runner.placeholders();
  placeholders["recording"] = runner.file("short.mcap");
  placeholders["frame"] = runner.file("frame.png");
  run({"sidestep", "simulate", placeholders["scenario"], "--seconds", "0.2", "--record",
       placeholders["recording"]});
  placeholders["report"] = runner.file("reports/crossing-1.json");
  run({"sidestep", "frame", placeholders["images"], placeholders["frame"]});
  const std::vector<WritingCommand> commands = writing_commands(runner.table());
  REQUIRE(commands.size() > 20);
  for (const auto& [flaws, command] : commands) {
    for (const std::string& flaw : flaws) {
      placeholders["out"] = folders.path(flaw);
      Row row{1, {folders.path(flaw), folders.cause(flaw)}, words_of(command, placeholders)};
      if (flaw == "closed") row.command = without_override(row.command);
      runner.check(row);
    }
  }
}

}  // namespace sidestep::arguments
