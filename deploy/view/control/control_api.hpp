// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/client/disturbance_client.hpp"
#include "common/client/order_client.hpp"
#include "common/messaging/bus.hpp"
#include "deploy/view/server/web_server.hpp"

namespace sidestep {

/// Actions that ControlApi delegates.
struct ControlHooks {
  std::function<void(const std::string& text)> bookmark;
  /// Starts a recording unless one is in progress, or ends it. Returns its file; nullopt if there is none to
  /// end. Throws std::runtime_error if the file cannot be written. Empty: nothing can be recorded.
  std::function<std::optional<std::string>(bool begins)> record;
};

/// Orders and faults by HTTP, in JSON:
///
/// | request | body |
/// |---|---|
/// | POST /api/robots/3/order | {"goals": [[1.2, -0.4], [0, 0, 1.57]]}: x, y in metres, heading in radians |
/// | POST /api/robots/3/cancel, hold, resume | none |
/// | POST /api/hold, /api/resume | none; all robots |
/// | POST /api/zones/1 | {"corners": [[0, 0], [1, 0], [1, 1]], "radius_m": 0.1, "speed_limit_mps": 0.5} |
/// | DELETE /api/zones/1 | none; status 404 if the operator has no such zone |
/// | POST /api/robots/3/fault | {"kind": "push", "vx_mps": 1, "vy_mps": 0} and others, see below |
/// | POST /api/recording/start, stop | none; answer {"file": …}: what is or was recorded |
/// | POST /api/bookmark | {"text": "here"} |
/// | GET /api/orders/17 | none; the state of an order, with the reason if it is refused or blocked |
///
/// Orders are sent as the operator, and answered by {"order": 17}. Kinds of faults: push (vx_mps, vy_mps),
/// slip (grip, seconds), block (heading_rad, seconds), lift, place (x_m, y_m, heading_rad), reboot, switch
/// off, switch on. Headings (0) and seconds (1) may be omitted. A fault is answered when the simulator has
/// applied it, with status 200, or refused it, with status 4xx.
class ControlApi {
 public:
  ControlApi(Bus& bus, ControlHooks hooks);
  /// Answers faults that the simulator has not answered yet with status 504. All other requests are answered
  /// at once.
  ~ControlApi();
  ControlApi(const ControlApi&) = delete;
  ControlApi& operator=(const ControlApi&) = delete;

  /// Replies at once or later. Returns false, and does not reply, if there is no such path. Requests that may
  /// not give commands are refused with status 401.
  [[nodiscard]] bool respond(const WebRequest& request, const WebReply& reply);
  /// Whether some method has requests with this path.
  [[nodiscard]] static bool has_path(const std::string& path);

 private:
  struct Command {
    std::uint64_t number;  ///< in the path; 0: the path has none
    const std::string& body;
    const WebReply& reply;
    /// The number of a robot or zone.
    std::uint32_t id() const { return static_cast<std::uint32_t>(number); }
  };
  struct Route {
    std::string_view method;
    std::string_view path;  ///< below "/api/"; "{robot}", "{zone}" and "{order}" stand for numbers
    /// Returns nullopt if the reply is sent later.
    std::optional<WebResponse> (*answer)(ControlApi& api, const Command& command);
  };
  static std::span<const Route> all_routes();
  static std::vector<const Route*> routes_of(std::span<const std::string> path);
  /// `routes`: those of the path. Returns nullopt if the reply is sent later.
  std::optional<WebResponse> command(const WebRequest& request, std::span<const std::string> path,
                                     std::span<const Route* const> routes, const WebReply& reply);
  WebResponse bookmark(const std::string& body);
  WebResponse go(RobotId robot, const std::string& body);
  WebResponse set_zone(std::uint32_t number, const std::string& body);
  WebResponse remove_zone(std::uint32_t number);
  WebResponse record(bool begins);
  void disturb(RobotId robot, const std::string& body, const WebReply& reply);
  WebResponse order_state(OrderHandle handle) const;

  ControlHooks hooks_;
  OrderClient client_;
  std::unique_ptr<RawWriter> disturbance_writer_;
  DisturbanceClient disturbances_;
};

}  // namespace sidestep
