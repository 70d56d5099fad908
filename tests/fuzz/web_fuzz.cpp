// SPDX-License-Identifier: Apache-2.0
// Fuzzes what browsers and viewers send to the monitor: paths and bodies
// of HTTP requests, and messages of web sockets. The first byte of an input selects the reader; its parts are
// separated by zero bytes.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/messaging/order_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "deploy/view/control/control_api.hpp"
#include "deploy/view/foxglove/foxglove_server.hpp"
#include "deploy/view/monitor/monitor.hpp"
#include "deploy/view/server/access.hpp"
#include "deploy/view/server/url.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace sidestep::fuzz {
namespace {

using Json = nlohmann::json;

enum Reader : unsigned { kTarget, kAccess, kControl, kFoxglove, kPage, kReaders };

const Time kBegin = time_from_ns(1'800'000'000'000'000'000);

std::vector<std::string> parts_of(View input) {
  std::vector<std::string> parts(1);
  for (const std::uint8_t byte : input) {
    if (byte == 0)
      parts.emplace_back();
    else
      parts.back() += static_cast<char>(byte);
  }
  return parts;
}

/// A viewer that checks that it can read what it gets, and counts it.
class Viewer : public WebSocket {
 public:
  void send_state(unsigned, WebMessage message) override { check(message); }
  void send_event(WebMessage message) override { check(message); }
  std::size_t bytes() const { return bytes_; }

 private:
  void check(const WebMessage& message) {
    SIDESTEP_REQUIRE(message.payload != nullptr);
    bytes_ += message.payload->size();
    if (!message.is_binary) SIDESTEP_REQUIRE(Json::accept(*message.payload));
  }
  std::size_t bytes_ = 0;
};

struct Run {
  SimNetwork network{1, kBegin, {}};
  SimBus bus{network};
  Monitor monitor{bus, {}};

  Run() {
    for (int i = 0; i < 40; ++i) {
      network.run_until(kBegin + i * Monitor::kFramePeriod);
      monitor.take_snapshot();
    }
  }
};

/// The run that the monitor under test shows.
Run& shown_run() {
  static Run run;
  return run;
}

bool try_target(const std::string& target) {
  const auto url = parse_target(target);
  if (!url) return false;
  SIDESTEP_REQUIRE(url->path.starts_with('/') && url->path.size() <= target.size());
  SIDESTEP_REQUIRE(url->path.find('\0') == std::string::npos);
  for (const auto& [key, value] : url->query) SIDESTEP_REQUIRE(key.size() + value.size() <= target.size());
  const auto response = shown_run().monitor.respond({"GET", url->path, url->query, "", ""});
  SIDESTEP_REQUIRE(!response ||
                   ((response->status == 200 || response->status == 400) && Json::accept(response->body)));
  return true;
}

/// Tests host, origin and authorization. Only this server's own and the origins that it allows must pass.
bool try_access(const std::vector<std::string>& headers) {
  const AccessSettings settings{"127.0.0.1", 8080, {"https://example.org"}, "0123456789abcdef"};
  const auto header = [&](std::size_t i) { return i < headers.size() ? std::string_view(headers[i]) : ""; };
  const RequestSource source{header(0), header(1), header(2)};
  const bool may_command = command_refusal(settings, source).empty();
  SIDESTEP_REQUIRE(!may_command || source.authorization.find(settings.token) != std::string_view::npos);
  if (!refusal(settings, source).empty()) return false;
  SIDESTEP_REQUIRE(source.host.find("127.0.0.1") != std::string_view::npos ||
                   source.host.find("localhost") != std::string_view::npos);
  SIDESTEP_REQUIRE(source.origin.empty() || source.origin == "https://example.org" ||
                   source.origin.find(source.host) != std::string_view::npos);
  return true;
}

void check(const msg::Disturbance& fault) {
  for (const double number :
       {fault.vx_mps(), fault.vy_mps(), fault.grip(), fault.x_m(), fault.y_m(), fault.heading_rad()})
    SIDESTEP_REQUIRE(std::abs(number) <= 1000);
  SIDESTEP_REQUIRE(fault.duration_ns() > 0 && fault.duration_ns() <= 3'600'000'000'000);
}

/// Tests requests with method, path, body and permission to command. Every message that a request causes must
/// be valid.
bool try_control(const std::vector<std::string>& parts, bool may_command) {
  SimNetwork network(1, kBegin, {});
  SimBus bus(network), others(network);
  int sent = 0, bookmarks = 0;
  others.become_observer();
  others.observe<msg::Order>(topics::kOrder, 0, [&](const msg::Order& order) {
    ++sent;
    SIDESTEP_REQUIRE(decode(order, others.now()));
  });
  others.observe<msg::Disturbance>(topics::kDisturbance, 0, [&](const msg::Disturbance& fault) {
    ++sent;
    check(fault);
  });
  ControlApi api(bus, {[&](const std::string&) { ++bookmarks; }, {}});
  const auto part = [&](std::size_t i) { return i < parts.size() ? parts[i] : std::string(); };
  std::optional<WebResponse> response;
  const bool is_known = api.respond(
      {part(0), part(1), {}, part(2), may_command ? "" : "only clients with the token may give commands"},
      [&](WebResponse given) { response = std::move(given); });
  network.run_until(kBegin + std::chrono::milliseconds(1));
  SIDESTEP_REQUIRE(is_known || !response);
  if (!is_known) return false;
  // Only a fault is answered later, by the simulator.
  SIDESTEP_REQUIRE(response || (may_command && sent == 1));
  if (!response) return true;
  SIDESTEP_REQUIRE(response->status >= 200 && response->status < 500);
  SIDESTEP_REQUIRE(Json::accept(response->body));
  SIDESTEP_REQUIRE((sent == 0 && bookmarks == 0) || (may_command && response->status == 200));
  return response->status == 200;
}

/// Whether all messages of a viewer were valid.
bool try_foxglove(const std::vector<std::string>& messages) {
  static FoxgloveServer server;
  static const FloorState floor;
  Viewer viewer;
  server.add(viewer);
  bool all_were_valid = true;
  for (const std::string& message : messages) {
    all_were_valid = all_were_valid && server.on_message(viewer, message);
    if (!all_were_valid) break;  // the server disconnects
  }
  server.publish_scene(floor, 0.09, kBegin);
  server.remove(viewer);
  // If a viewer gets much more than at the beginning, it can fill the memory.
  SIDESTEP_REQUIRE(viewer.bytes() < 4 << 20);
  return all_were_valid;
}

bool try_page(const std::vector<std::string>& messages) {
  Run& run = shown_run();
  Viewer viewer;
  run.monitor.add_viewer(viewer);
  bool all_were_valid = true;
  Time clock = kBegin + std::chrono::seconds(1);
  for (const std::string& message : messages) {
    all_were_valid = all_were_valid && run.monitor.on_message(viewer, message, clock);
    if (!all_were_valid) break;
    run.monitor.update_viewers(clock += std::chrono::milliseconds(30));
  }
  run.monitor.remove_viewer(viewer);
  return all_were_valid;
}

Bytes input_of(Reader reader, std::initializer_list<std::string_view> parts) {
  Bytes input{static_cast<std::uint8_t>(reader)};
  for (const std::string_view part : parts) {
    if (input.size() > 1) input.push_back(0);
    input.insert(input.end(), part.begin(), part.end());
  }
  return input;
}

}  // namespace

bool try_input(View input) {
  if (input.empty()) return false;
  const std::vector<std::string> parts = parts_of(input.subspan(1));
  switch (input[0] % kReaders) {
    case kTarget:
      return try_target(parts[0]);
    case kAccess:
      return try_access(parts);
    case kControl:
      return try_control(parts, input[0] < 128);
    case kFoxglove:
      return try_foxglove(parts);
    default:
      return try_page(parts);
  }
}

std::vector<Bytes> seeds() {
  std::vector<Bytes> result{
      input_of(kTarget, {"/api/events?since=12&x=%41+b"}),
      input_of(kAccess, {"127.0.0.1:8080", "http://127.0.0.1:8080", "Bearer 0123456789abcdef"}),
      input_of(kAccess, {"localhost:8080", "https://example.org", ""}),
      input_of(kFoxglove,
               {R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":1,"channelId":1}]})",
                R"({"op":"unsubscribe","subscriptionIds":[0]})", R"({"op":"advertise"})"}),
      input_of(kPage, {R"({"op":"pause"})", R"({"op":"step","frames":-3})", R"({"op":"play","speed":0.5})",
                       R"({"op":"seek","at_s":1800000000.5})", R"({"op":"inspect","channel":"world"})",
                       R"({"op":"live"})"})};
  const auto command = [&](std::string_view path, std::string_view body, std::string_view method = "POST") {
    result.push_back(input_of(kControl, {method, path, body}));
  };
  command("/api/robots/3/order", R"({"goals": [[1.2, -0.4], [0, 0, 1.57]]})");
  command("/api/robots/3/cancel", "");
  command("/api/hold", "");
  command("/api/zones/1",
          R"({"corners": [[0, 0], [1, 0], [1, 1]], "radius_m": 0.1, "speed_limit_mps": 0.5})");
  command("/api/zones/1", "", "DELETE");
  command("/api/robots/3/fault", R"({"kind": "push", "vx_mps": 1, "vy_mps": 0})");
  command("/api/robots/3/fault", R"({"kind": "slip", "grip": 0.5, "seconds": 2})");
  command("/api/robots/3/fault", R"({"kind": "place", "x_m": 1, "y_m": 2, "heading_rad": 3})");
  command("/api/bookmark", R"({"text": "here"})");
  return result;
}

}  // namespace sidestep::fuzz
