// SPDX-License-Identifier: Apache-2.0
#include "vision/league/log_commands.hpp"

#include <fmt/core.h>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/league/log_file.hpp"
#include "common/league/multicast.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/process/command_line.hpp"
#include "common/process/output_paths.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "vision/league/replay.hpp"

namespace sidestep {
namespace {

using league::LogType;

struct LogOptions {
  std::string file;
  std::string vision = league::kVisionEndpoint;
  std::string tracked = league::kTrackedEndpoint;
  std::string referee = league::kRefereeEndpoint;
  std::string interface = league::kLeagueInterface;
  double seek_s = 0;
  double speed = 1;
  bool overwrites = false;
};

void add_log_options(const CliCommand& app, LogOptions& options) {
  app.add_option("FILE", options.file, "log file, version 1").required();
  app.add_option("--ssl-vision", options.vision, "ADDRESS:PORT of vision packets").show_default();
  app.add_option("--tracked", options.tracked, "ADDRESS:PORT of tracked packets").show_default();
  app.add_option("--referee", options.referee, "ADDRESS:PORT of the referee's packets").show_default();
  app.add_option("--league-interface", options.interface, "address of the network interface to use")
      .show_default();
}

/// One sender per multicast group.
class LogSenders {
 public:
  explicit LogSenders(const LogOptions& options)
      : vision_(league::parse_multicast_endpoint(options.vision), options.interface),
        tracked_(league::parse_multicast_endpoint(options.tracked), options.interface),
        referee_(league::parse_multicast_endpoint(options.referee), options.interface) {}

  void send(const league::LogRecord& record) {
    league::MulticastSender& to = record.type == LogType::kTracked   ? tracked_
                                  : record.type == LogType::kReferee ? referee_
                                                                     : vision_;
    to.send(record.bytes);
  }
  std::string summary() const {
    return fmt::format("{} vision, {} tracked and {} referee packets sent, {} failed", vision_.sent(),
                       tracked_.sent(), referee_.sent(),
                       vision_.failed() + tracked_.failed() + referee_.failed());
  }

 private:
  league::MulticastSender vision_, tracked_, referee_;
};

int replay(const LogOptions& options) {
  league::LogReader reader(options.file);
  if (options.seek_s > 0 && !reader.seek(from_seconds(options.seek_s))) {
    throw std::invalid_argument(fmt::format("{}: --seek {:g}: the log has no packet that late{}",
                                            options.file, options.seek_s,
                                            reader.error().empty() ? "" : "; " + reader.error()));
  }
  LogSenders senders(options);
  EventLoop loop;
  const StopSignals stop_signals([&loop] { loop.stop(); });
  Replay replay(reader, options.speed);
  const std::function<void()> advance = [&] {
    const auto next =
        replay.advance(loop.now(), [&](const league::LogRecord& record) { senders.send(record); });
    if (!next) return loop.stop();
    loop.at(*next, advance);
  };
  loop.at(loop.now(), advance);
  loop.run_until(Time::max());
  fmt::print(stderr, "sidestep-vision replay: {}\n", senders.summary());
  if (!reader.error().empty()) fmt::print(stderr, "sidestep-vision replay: {}\n", reader.error());
  return reader.status() == league::LogStatus::kCorrupt ? kExitFailure : 0;
}

/// Records the packets of one multicast group.
class Recorder {
 public:
  Recorder(EventLoop& loop, std::optional<league::LogWriter>& log, const std::string& endpoint,
           const std::string& interface, LogType type)
      : receiver_(league::parse_multicast_endpoint(endpoint), interface) {
    loop.watch(receiver_.descriptor(), [this, &log, type] {
      receiver_.receive([&](std::span<const std::byte> datagram, const league::Endpoint&) {
        log->add(EventLoop::now(), type, datagram);
      });
    });
  }

 private:
  league::MulticastReceiver receiver_;
};

int record(const LogOptions& options) {
  require_new_output({"FILE", options.file}, options.overwrites);
  EventLoop loop;
  const StopSignals stop_signals([&loop] { loop.stop(); });
  std::optional<league::LogWriter> log;
  Recorder vision(loop, log, options.vision, options.interface, LogType::kVision);
  Recorder tracked(loop, log, options.tracked, options.interface, LogType::kTracked);
  Recorder referee(loop, log, options.referee, options.interface, LogType::kReferee);
  // Only now, because with --force an earlier log of this name is lost.
  log.emplace(options.file);
  fmt::print(stderr, "sidestep-vision record: recording to {}, stop with SIGINT\n", options.file);
  loop.run_until(Time::max());
  log->close();
  fmt::print(stderr, "sidestep-vision record: {} packets recorded\n", log->records());
  return 0;
}

}  // namespace

void add_log_commands(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<LogOptions>();
  const CliCommand replayed = root.add_subcommand(
      "replay", "Sends the packets of a log with the timing with which they were received");
  add_log_options(replayed, *options);
  replayed.add_option("--seek", options->seek_s, "start this many seconds after the first packet")
      .check(in_range(0.0, 1e9))
      .show_default();
  replayed.add_option("--speed", options->speed, "speed factor")
      .check(in_range(0.001, 1000.0))
      .show_default();
  replayed.on_parsed([options, &action] { action = [options] { return replay(*options); }; });

  const CliCommand recorded =
      root.add_subcommand("record", "Records the league's multicast packets in a log");
  add_log_options(recorded, *options);
  recorded.add_flag("--force", options->overwrites, "overwrite the file if it exists");
  recorded.on_parsed([options, &action] { action = [options] { return record(*options); }; });
}

}  // namespace sidestep
