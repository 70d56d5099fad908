// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/topic_tools.hpp"

#include <atomic>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "common/json/json_text.hpp"
#include "common/messaging/message_schema.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "deploy/inspect/record/recording.hpp"
#include "deploy/inspect/senders/sender_meter.hpp"
#include "deploy/inspect/topic/graph.hpp"
#include "deploy/inspect/topic/graph_command.hpp"
#include "deploy/inspect/topic/rate_meter.hpp"
#include "deploy/inspect/topic/topic_command.hpp"
#include "deploy/inspect/topic/topic_table.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::topic_tools_test {

Time at_ms(int ms) { return time_from_ns(std::int64_t{ms} * 1'000'000); }

DiscoveredEndpoint endpoint(const std::string& participant, bool is_writer, bool is_reliable) {
  DiscoveredEndpoint result;
  result.participant = participant;
  result.topic = "world";
  result.type = "Type";
  result.is_writer = is_writer;
  result.is_reliable = is_reliable;
  return result;
}

struct Outcome {
  int exit_code;
  std::string out;
  std::string err;
};

/// Runs `sidestep ARGUMENTS`, which is the command that `add` adds, in this test's domain.
Outcome sidestep_command(void (*add)(const CliCommand&, std::function<int()>&),
                         std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "sidestep");
  arguments.insert(arguments.end(), {"--domain", std::to_string(test_settings().domain)});
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  CommandLine command_line("test", "sidestep");
  const CliCommand app = command_line.root();
  std::function<int()> action;
  add(app, action);
  Outcome outcome{};
  const CaptureStderr err;
  CaptureStdout out;
  const auto exit_code = command_line.parse(static_cast<int>(argv.size()), argv.data());
  outcome.exit_code = exit_code ? *exit_code : action();
  outcome.out = out.finish();
  outcome.err = err.text();
  return outcome;
}

/// Runs `sidestep topic ARGUMENTS` in this test's domain.
Outcome topic(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "topic");
  return sidestep_command(add_topic_command, std::move(arguments));
}

/// Publishes world states in its own thread.
class Publisher {
 public:
  Publisher() : bus_(test_settings("vision")), writer_(bus_.advertise(topics::kWorld)) {
    tick();
    thread_ = std::thread([this] { bus_.run(); });
  }
  ~Publisher() {
    bus_.stop();
    thread_.join();
  }

 private:
  void tick() {
    msg::WorldState world;
    world.header().sender(static_cast<std::uint32_t>(Sender::kVision));
    world.frames(77);
    writer_.publish(world, bus_.now());
    bus_.at(bus_.now() + Duration{10'000'000}, [this] { tick(); });
  }

  DdsBus bus_;
  Writer<msg::WorldState> writer_;
  std::thread thread_;
};

TEST_CASE("a rate is the number of gaps per second, shown with the shortest and longest gap") {
  RateMeter meter;
  CHECK(meter.total().samples == 0);
  CHECK_FALSE(meter.total().min_gap.has_value());
  meter.add(at_ms(1000), 500);
  CHECK(meter.total().samples == 1);
  CHECK(meter.total().rate_hz == 0);
  meter.add(at_ms(1010), 100);
  meter.add(at_ms(1040), 300);
  const Rate rate = meter.total();
  CHECK(rate.samples == 3);
  CHECK(rate.rate_hz == Approx(50));
  CHECK(*rate.min_gap == Duration{10'000'000});
  CHECK(*rate.max_gap == Duration{30'000'000});
  CHECK(rate.bytes_per_second == Approx(400 / 0.040));
}

TEST_CASE("a gap that spans two calls of take_recent() is reported by the second call") {
  RateMeter meter;
  meter.add(at_ms(0), 1);
  meter.add(at_ms(10), 1);
  CHECK(meter.take_recent().samples == 2);
  CHECK(meter.take_recent().samples == 0);
  meter.add(at_ms(5010), 1);
  const Rate recent = meter.take_recent();
  CHECK(recent.samples == 1);
  REQUIRE(recent.max_gap.has_value());
  CHECK(*recent.max_gap == Duration{5'000'000'000});
  CHECK(recent.rate_hz == Approx(0.2));
  CHECK(meter.total().samples == 3);
}

TEST_CASE("samples that all arrive at the same time have a rate of 0") {
  RateMeter meter;
  meter.add(at_ms(5), 10);
  meter.add(at_ms(5), 10);
  CHECK(meter.total().rate_hz == 0);
  CHECK(meter.total().bytes_per_second == 0);
}

TEST_CASE("the table of topics names the first agents of a fleet and counts all of them") {
  std::vector<DiscoveredEndpoint> endpoints{endpoint("vision", true, false)};
  for (int i = 0; i < 22; ++i) endpoints.push_back(endpoint("agent-" + std::to_string(i), false, false));
  const std::string table = topic_table(endpoints);
  CHECK_THAT(table, ContainsSubstring("1: vision"));
  CHECK_THAT(table, ContainsSubstring("22: agent-0, agent-1, agent-2, ..."));
  CHECK_THAT(table, ContainsSubstring("best effort"));
  CHECK_THAT(table, !ContainsSubstring("MISMATCH"));
}

TEST_CASE("the table of topics shows a mismatch with the affected endpoints") {
  const std::string table = topic_table(
      {endpoint("vision", true, false), endpoint("logger", false, true), endpoint("agent", false, false)});
  CHECK_THAT(table, ContainsSubstring(
                        "MISMATCH reliability: the reader requests reliable, the writer offers best effort "
                        "(vision -> logger)"));
}

TEST_CASE("the graph shows processes by host, the topics they write and read, and mismatches") {
  DiscoveredEndpoint writer, reader, other;
  writer.guid = "01.0f.aa.01.17.00";
  writer.participant = "agent-3 <&>";
  writer.topic = "command/3";
  writer.is_writer = true;
  reader = writer;
  reader.participant = "simulator";
  reader.is_writer = false;
  reader.is_reliable = true;
  other = reader;
  other.guid = "01.0f.bb.02.17.00";
  other.participant = "vision";
  other.topic = "world";
  other.is_writer = true;
  const ProcessGraph graph = graph_of({writer, reader, other});
  REQUIRE(graph.processes.size() == 3);
  CHECK(graph.processes[0].host == "01.0f.aa.01");
  CHECK(graph.processes[0].writes == std::set<std::string>{"command/*"});
  CHECK(graph.processes[1].reads == std::set<std::string>{"command/*"});
  CHECK(graph.processes[2].host == "01.0f.bb.02");
  CHECK(graph.topics == std::vector<std::string>{"command/*", "world"});
  REQUIRE(graph.mismatches.size() == 1);
  CHECK_THAT(graph.mismatches[0], StartsWith("command/3: ") && EndsWith("(agent-3 <&> -> simulator)"));
  CHECK_THAT(to_text(graph),
             ContainsSubstring("host 01.0f.bb.02\n  vision\n    writes world\n    reads  -\n"));
}

TEST_CASE("the graph shows processes of one host together, whatever their GUIDs begin with") {
  DiscoveredEndpoint agent, monitor, foreign;
  agent.guid = "01.0f.78.fd.01.00";
  agent.participant = "agent-3";
  agent.topic = "world";
  agent.host = "kitchen";
  monitor = agent;
  monitor.guid = "73.73.6f.70.02.00";
  monitor.participant = "sidestep-monitor";
  foreign = agent;
  foreign.guid = "01.10.aa.bb.03.00";
  foreign.participant = "base";
  foreign.host = "";
  CHECK(to_text(graph_of({agent, monitor, foreign})) ==
        "host 01.10.aa.bb\n  base\n    writes -\n    reads  world\n"
        "\nhost kitchen\n  agent-3\n    writes -\n    reads  world\n"
        "  sidestep-monitor\n    writes -\n    reads  world\n");
}

TEST_CASE("topic info shows the type, every endpoint with its QoS, and mismatches") {
  DiscoveredEndpoint reader = endpoint("logger", false, true);
  reader.deadline = Duration{500'000'000};
  reader.durability = DiscoveredEndpoint::Durability::kTransientLocal;
  reader.partitions = {"a"};
  const std::string details =
      topic_details({endpoint("vision", true, false), reader, endpoint("agent", false, false)}, "world");
  CHECK_THAT(details, StartsWith("world: Type\nwriter vision: best effort, volatile, without key, ownership "
                                 "shared, deadline no limit, liveliness automatic (lease no limit)\n"
                                 "reader logger: reliable, transient local, without key, ownership shared, "
                                 "deadline 0.5 s, liveliness automatic (lease no limit), partition a\n"
                                 "reader agent: best effort"));
  CHECK_THAT(details, ContainsSubstring("MISMATCH reliability") && ContainsSubstring("(vision -> logger)"));
  CHECK(topic_details({endpoint("vision", true, false)}, "truth") == "");
}

TEST_CASE("topic info shows the IDL of our topics") {
  const Publisher publisher;
  const Outcome outcome = topic({"info", "world", "--seconds", "1.5"});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out,
             StartsWith("world: sidestep::msg::WorldState\nwriter vision: best effort, volatile, ") &&
                 ContainsSubstring("struct WorldState {"));
  CHECK(topic({"info", "nothing", "--seconds", "0.1"}).exit_code == kExitFailure);
}

TEST_CASE("lost, repeated, reordered and late messages of a topic are counted by sender") {
  SenderMeter meter;
  const auto add = [&](std::uint32_t sender, std::uint64_t incarnation, std::uint64_t number, int delay_ms) {
    msg::Header header;
    header.sender(sender);
    header.incarnation(incarnation);
    header.message_number(number);
    header.stamp_ns(to_ns(at_ms(1000)));
    meter.add(header, at_ms(1000 + delay_ms));
  };
  add(3, 1, 10, 5);
  add(3, 1, 14, 20);
  add(3, 1, 12, 30);
  add(3, 1, 12, 31);
  add(10'000, 1, 1, -2);
  add(10'000, 2, 1, 0);
  const std::string table = meter.table();
  CAPTURE(table);
  CHECK_THAT(table, Matches("SENDER[^]*\nagent 3 +4 +2 +1 +1  5\\.000  [^]*31\\.000\n[^]*"));
  CHECK_THAT(table, Matches("[^]*\ncoordinator \\(1\\) +1 +0 +0 +0  -2\\.000 [^]*"));
  CHECK_THAT(table, Matches("[^]*\ncoordinator \\(2\\) +1 +0 +0 +0  0\\.000 [^]*"));
}

TEST_CASE("if a topic has thousands of senders, the most recently heard senders are shown") {
  SenderMeter meter;
  for (std::uint32_t i = 0; i < SenderMeter::kMaxStreams + 5; ++i) {
    msg::Header header;
    header.sender(3);
    header.incarnation(i + 1);
    header.message_number(1);
    meter.add(header, at_ms(1000 + static_cast<int>(i)));
  }
  const std::string table = meter.table();
  CHECK_THAT(table, !ContainsSubstring("agent 3 (5) ") && ContainsSubstring("agent 3 (6) ") &&
                        EndsWith("and 5 others, last heard before these\n"));
}

TEST_CASE("topic delay measures the senders of a topic") {
  const Publisher publisher;
  const Outcome outcome = topic({"delay", "world", "--seconds", "1"});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Matches("SENDER[^]*\nvision +[1-9][0-9]+ +0 +0 +0 [^]*"));
  CHECK(topic({"delay", "nothing", "--seconds", "1"}).exit_code == kExitFailure);
}

TEST_CASE("topic delay of a topic that nobody writes says so, with the topics that have a writer") {
  const Publisher publisher;
  const Outcome outcome = topic({"delay", "feedback/9", "--seconds", "0.2"});
  CHECK(outcome.exit_code == kExitFailure);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.err,
             ContainsSubstring("writes 'feedback/9' so far; topics that have a writer: world\n"));
}

TEST_CASE("topic delay of a topic that a recording lacks names the recorded topics") {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.mcap");
  {
    RecordingWriter writer(file, {"one", "robots:\n  - {id: 0, start_m: [0, 0]}\n", nullptr, true});
    const std::uint16_t channel = writer.add_channel(topics::kTruth, "truth");
    msg::GroundTruth truth;
    truth.header().message_number(1);
    writer.add(at_ms(20), topics::kTruth, channel, truth.header(), &truth);
    writer.close();
  }
  const Outcome missing = topic({"delay", "feedback/9", "--recording", file});
  CHECK(missing.exit_code == kExitFailure);
  CHECK(missing.out.empty());
  CHECK_THAT(missing.err, StartsWith(file + ": no message of 'feedback/9'; topics in this recording: ") &&
                              ContainsSubstring("truth"));
  const Outcome measured = topic({"delay", "truth", "--recording", file});
  CAPTURE(measured.err);
  CHECK(measured.exit_code == 0);
  CHECK_THAT(measured.out, StartsWith("SENDER"));
}

TEST_CASE("topic list and graph of an empty domain say that it is empty") {
  const Outcome list = topic({"list", "--seconds", "0.1"});
  CHECK(list.exit_code == 0);
  CHECK_THAT(list.out, StartsWith("TOPIC"));
  const std::string message =
      "no process in domain " + std::to_string(test_settings().domain) + " writes or reads a topic so far\n";
  CHECK_THAT(list.err, EndsWith(message));
  const Outcome graph = sidestep_command(add_graph_command, {"graph", "--seconds", "0.1"});
  CHECK(graph.exit_code == kExitFailure);
  CHECK(graph.out.empty());
  CHECK_THAT(graph.err, EndsWith(message));
}

TEST_CASE("topic list finds the topics of a running process") {
  const Publisher publisher;
  const Outcome outcome = topic({"list"});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, ContainsSubstring("world") && ContainsSubstring("sidestep::msg::WorldState") &&
                              ContainsSubstring("1: vision"));
}

TEST_CASE("topic hz measures a topic, and lists available topics if it has no writer", "[half-core]") {
  const Publisher publisher;
  const Outcome measured = topic({"hz", "world", "--seconds", "1"});
  CAPTURE(measured.out, measured.err);
  CHECK(measured.exit_code == 0);
  CHECK_THAT(measured.out, ContainsSubstring("total: ") && ContainsSubstring(" Hz  gap min "));

  const Outcome unknown = topic({"hz", "nothing"});
  CAPTURE(unknown.err);
  CHECK(unknown.exit_code == kExitFailure);
  CHECK_THAT(unknown.err, ContainsSubstring("topic 'nothing' has no writer") &&
                              ContainsSubstring("topics in this domain: world"));
}

TEST_CASE("topic echo prints the requested number of messages, each as a line of JSON") {
  const Publisher publisher;
  const Outcome outcome = topic({"echo", "world", "--count", "2"});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit_code == 0);
  std::istringstream lines(outcome.out);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    CHECK(parse_json(line)["frames"] == 77);
  }
  CHECK(count == 2);
}

TEST_CASE("topic echo prints other programs' topics by a user-supplied IDL file") {
  const Publisher publisher;
  const TemporaryFolder folder;
  write_file(folder.file("world.idl"), kIdlText);
  const Outcome outcome =
      topic({"echo", "world", "--idl", folder.file("world.idl"), "--count", "2", "--csv"});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Matches("[^\n]*frames[^\n]*\n[^\n]*77[^\n]*\n[^\n]*77[^\n]*\n"));
  // The bytes cannot be decoded as a message of another type.
  const Outcome wrong = topic(
      {"echo", "world", "--idl", folder.file("world.idl"), "--type", "sidestep::msg::GroundTruth", "--once"});
  CHECK(wrong.exit_code == kExitFailure);
  CHECK_THAT(wrong.err, ContainsSubstring("a message of 'world' is not a valid sidestep::msg::GroundTruth"));
  CHECK_THROWS_WITH(topic({"echo", "world", "--idl", folder.file("world.idl"), "--type", "Nothing"}),
                    ContainsSubstring("has no struct 'Nothing', expected one of: ") &&
                        ContainsSubstring("sidestep::msg::WorldState"));
}

TEST_CASE("topic pub publishes messages of our topics") {
  DdsBus bus(test_settings());
  std::vector<msg::Disturbance> received;
  bus.observe<msg::Disturbance>(topics::kDisturbance, 0,
                                [&](const msg::Disturbance& m) { received.push_back(m); });
  std::atomic<bool> is_over = false;
  Outcome outcome{};
  std::thread thread([&] {
    outcome =
        topic({"pub", "disturbance", R"({"robot": 3, "disturbance_kind": "DISTURBANCE_SLIP", "grip": 0.25})",
               "--count", "2", "--rate", "20"});
    is_over = true;
  });
  CHECK(run_until([&] { return is_over.load(); }, bus));
  thread.join();
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.out == "sent to 1 reader(s)\n");
  REQUIRE(received.size() == 2);
  CHECK(received[0].robot() == 3);
  CHECK(received[0].disturbance_kind() == msg::DisturbanceKind::DISTURBANCE_SLIP);
  CHECK(received[0].grip() == 0.25);
  const msg::Header &first = received[0].header(), &second = received[1].header();
  CHECK(first.sender() == static_cast<std::uint32_t>(Sender::kOperator));
  CHECK(first.message_number() == 1);
  CHECK(second.message_number() == 2);
  CHECK(first.incarnation() == second.incarnation());
  CHECK(first.stamp_ns() >= static_cast<std::int64_t>(first.incarnation()));
  CHECK(second.stamp_ns() > first.stamp_ns());
  CHECK(std::chrono::abs(bus.now() - time_from_ns(second.stamp_ns())) < std::chrono::seconds(30));
}

TEST_CASE("topic pub sends once all known readers match, so each of them gets the message") {
  struct Reader {
    DdsBus bus{test_settings("reader")};
    int received = 0;
    Reader() {
      bus.observe<msg::Disturbance>(topics::kDisturbance, 0, [this](const msg::Disturbance&) { ++received; });
    }
  };
  Reader a, b, c, d;
  std::atomic<bool> is_over = false;
  Outcome outcome{};
  std::thread thread([&] {
    outcome = topic({"pub", "disturbance", R"({"robot": 3, "disturbance_kind": "DISTURBANCE_LIFT"})"});
    is_over = true;
  });
  const auto have_all_received = [&] { return a.received && b.received && c.received && d.received; };
  CHECK(run_until([&] { return is_over && have_all_received(); }, a.bus, b.bus, c.bus, d.bus));
  thread.join();
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.out == "sent to 4 reader(s)\n");
}

TEST_CASE("topic pub reports errors in a message and topics without a reader", "[half-core]") {
  CHECK_THROWS_WITH(topic({"pub", "disturbance", "{"}), ContainsSubstring("is not valid JSON"));
  CHECK_THROWS_WITH(topic({"pub", "disturbance", R"({"robot": -1})"}),
                    ContainsSubstring("robot: expected a whole number"));
  CHECK_THROWS_WITH(topic({"pub", "nothing", "{}"}), ContainsSubstring("give its type with --type"));
  CHECK_THROWS_WITH(topic({"pub", "verdict/3", R"({"robot": 3})"}),
                    ContainsSubstring("header.sender: is missing"));
  const Outcome outcome = topic({"pub", "disturbance", "{}"});
  CHECK(outcome.exit_code == kExitFailure);
  CHECK(outcome.err == "topic 'disturbance' has no matching reader\n");
}

TEST_CASE("unusable IDL is a usage error of topic pub and topic echo") {
  const std::string missing = "/missing.idl";
  CHECK_THROWS_AS(topic({"pub", "x", "{}", "--idl", missing, "--type", "A"}), std::invalid_argument);
  CHECK_THROWS_AS(topic({"echo", "x", "--idl", missing}), std::invalid_argument);
}

TEST_CASE("topic bw measures bandwidth and sizes") {
  const Publisher publisher;
  const Outcome outcome = topic({"bw", "world", "--seconds", "1"});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(
      outcome.out,
      Matches(
          "[^]*total: [0-9]+ samples  [0-9.]+ kB/s  size min ([0-9]+) B  mean ([0-9]+) B  max [0-9]+ B\n"));
}

TEST_CASE("topic echo of an unknown topic lists the known ones") {
  for (const char* name : {"nothing", "verdict", "verdict/", "verdict/-1", "verdict/3x", "world/1"}) {
    const Outcome outcome = topic({"echo", name});
    CAPTURE(name, outcome.err);
    CHECK(outcome.exit_code == kExitFailure);
    CHECK_THAT(outcome.err, ContainsSubstring("unknown topic") && ContainsSubstring("verdict/ROBOT"));
  }
}

TEST_CASE("topic echo of a mistyped topic names the one that is meant") {
  CHECK_THAT(topic({"echo", "wrold"}).err, ContainsSubstring("unknown topic 'wrold'; did you mean world?"));
  CHECK_THAT(topic({"echo", "verdict"}).err, ContainsSubstring("; did you mean verdict/ROBOT?"));
}

TEST_CASE("topic echo of a topic that nobody writes says so, and prints it once somebody does") {
  TopicOptions options;
  options.dds = test_settings("sidestep-topic");
  options.topic = "feedback/9";
  options.discovery_s = 0.2;
  options.printer.count = 1;
  CaptureStdout out;
  const CaptureStderr err;
  std::atomic<int> exit_code = -1;
  std::thread thread([&] { exit_code = echo_topic(options); });
  DdsBus bus(test_settings("simulator"));
  CHECK(run_until([&] { return err.text().find("writes 'feedback/9' so far") != std::string::npos; }, bus));
  auto writer = bus.advertise(topics::kFeedback, 9);
  msg::Feedback feedback;
  feedback.robot(9);
  feedback.header().sender(9);
  CHECK(run_until(
      [&] {
        writer.publish(feedback, bus.now());
        return exit_code >= 0;
      },
      bus));
  thread.join();
  CHECK(exit_code == 0);
  CHECK_THAT(out.finish(), StartsWith("{"));
}

TEST_CASE("usage errors of sidestep topic exit with code 2") {
  CHECK(topic({}).exit_code == kExitUsage);
  CHECK(topic({"hz"}).exit_code == kExitUsage);
  CHECK(topic({"echo", "world", "--count", "-3"}).exit_code == kExitUsage);
  CHECK(topic({"list", "--seconds", "soon"}).exit_code == kExitUsage);
  CHECK(topic({"--help"}).exit_code == 0);
}

}  // namespace sidestep::topic_tools_test
