// SPDX-License-Identifier: Apache-2.0
#include "vision/league/log_commands.hpp"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/league/log_file.hpp"
#include "common/league/multicast.hpp"
#include "common/messaging/dds/event_loop.hpp"
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
};

void add_log_options(CLI::App& app, LogOptions& options) {
  app.add_option("FILE", options.file, "log file, version 1")->required();
  app.add_option("--ssl-vision", options.vision, "ADDRESS:PORT of vision packets")->capture_default_str();
  app.add_option("--tracked", options.tracked, "ADDRESS:PORT of tracked packets")->capture_default_str();
  app.add_option("--referee", options.referee, "ADDRESS:PORT of the referee's packets")
      ->capture_default_str();
  app.add_option("--league-interface", options.interface, "address of the network interface to use")
      ->capture_default_str();
}

/// A sender for each of the groups.
class Players {
 public:
  explicit Players(const LogOptions& options)
      : vision_(league::multicast_endpoint(options.vision), options.interface),
        tracked_(league::multicast_endpoint(options.tracked), options.interface),
        referee_(league::multicast_endpoint(options.referee), options.interface) {}

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
    throw std::invalid_argument(
        fmt::format("{}: nothing was received {:g} s after the first packet or later{}", options.file,
                    options.seek_s, reader.damage().empty() ? "" : "; " + reader.damage()));
  }
  Players players(options);
  EventLoop loop;
  const StopSignals stop_signals([&loop] { loop.stop(); });
  Replay replay(reader, options.speed);
  const std::function<void()> advance = [&] {
    const auto next =
        replay.advance(loop.now(), [&](const league::LogRecord& record) { players.send(record); });
    if (!next) return loop.stop();
    loop.at(*next, advance);
  };
  loop.at(loop.now(), advance);
  loop.run_until(Time::max());
  fmt::print(stderr, "sidestep-vision replay: {}\n", players.summary());
  if (!reader.damage().empty()) fmt::print(stderr, "sidestep-vision replay: {}\n", reader.damage());
  return reader.end() == league::LogEnd::kDamaged ? kExitFailure : 0;
}

/// Writes what comes to a group into a log.
class Recorder {
 public:
  Recorder(EventLoop& loop, league::LogWriter& log, const std::string& endpoint, const std::string& interface,
           LogType type)
      : receiver_(league::multicast_endpoint(endpoint), interface) {
    loop.watch(receiver_.descriptor(), [this, &log, type] {
      receiver_.receive([&](std::span<const std::byte> datagram, const league::Endpoint&) {
        log.add(EventLoop::now(), type, datagram);
      });
    });
  }

 private:
  league::MulticastReceiver receiver_;
};

int record(const LogOptions& options) {
  league::LogWriter log(options.file);
  EventLoop loop;
  const StopSignals stop_signals([&loop] { loop.stop(); });
  Recorder vision(loop, log, options.vision, options.interface, LogType::kVision);
  Recorder tracked(loop, log, options.tracked, options.interface, LogType::kTracked);
  Recorder referee(loop, log, options.referee, options.interface, LogType::kReferee);
  fmt::print(stderr, "sidestep-vision record: writes {} until SIGINT\n", options.file);
  loop.run_until(Time::max());
  log.close();
  fmt::print(stderr, "sidestep-vision record: {} packets\n", log.records());
  return 0;
}

}  // namespace

int replay_command(int argc, char** argv) {
  CLI::App app("Sends the packets of a log again, as they were received.", "sidestep-vision replay");
  LogOptions options;
  add_log_options(app, options);
  app.add_option("--seek", options.seek_s, "seconds after the log's beginning to begin at")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  app.add_option("--speed", options.speed, "so many times as fast")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  const int exit_code = parse_options(app, argc, argv);
  if (exit_code >= 0) return exit_code;
  return guarded("sidestep-vision replay", [&] { return replay(options); });
}

int record_command(int argc, char** argv) {
  CLI::App app("Writes what comes from the league's multicast into a log.", "sidestep-vision record");
  LogOptions options;
  add_log_options(app, options);
  const int exit_code = parse_options(app, argc, argv);
  if (exit_code >= 0) return exit_code;
  return guarded("sidestep-vision record", [&] { return record(options); });
}

}  // namespace sidestep
