// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "common/time/time.hpp"
#include "deploy/monitor/server/access.hpp"
#include "deploy/monitor/server/outbox.hpp"

namespace sidestep {

struct WebRequest {
  std::string method;                        ///< e.g. GET
  std::string path;                          ///< decoded, without the query
  std::map<std::string, std::string> query;  ///< decoded
  std::string body;
  std::string command_refusal;  ///< why the request may not command; empty: it may
};

struct WebResponse {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body;
};

/// A connected viewer. Valid until WebHandlers::on_close.
class WebSocket {
 public:
  virtual ~WebSocket() = default;
  /// The newest value of a state; an earlier one that was not sent yet is discarded.
  virtual void send_state(unsigned slot, WebMessage message) = 0;
  /// Sent in any case, or the viewer is disconnected.
  virtual void send_event(WebMessage message) = 0;
};

/// What a server calls. All calls come from the thread that polls it.
struct WebHandlers {
  std::function<WebResponse(const WebRequest&)> respond;
  /// `protocol`: that the viewer and the server agreed on.
  std::function<void(WebSocket&, const std::string& protocol)> on_open;
  /// A message of the viewer. False: it makes no sense, and the viewer is disconnected.
  std::function<bool(WebSocket&, const std::string& message, bool is_binary)> on_message;
  std::function<void(WebSocket&)> on_close;
};

/// A web server for a few viewers: HTTP and web sockets. Requests of other origins, and messages that are
/// larger than kMaxRequestBytes, are refused.
class WebServer {
 public:
  static constexpr std::size_t kMaxRequestBytes = 64 << 10;
  static constexpr std::size_t kMaxConnections = 128;

  /// Port 0: any free one. `protocols`: names of the web socket protocols that are understood; the first is
  /// used with viewers that name none. Throws std::runtime_error with the reason if the address cannot be
  /// used.
  WebServer(const AccessSettings& access, std::vector<std::string> protocols, WebHandlers handlers);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// With the port in use.
  const AccessSettings& access() const;
  /// Handles what has arrived, without waiting.
  void poll();
  /// Handles what arrives until the time is over.
  void run_for(Duration duration);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
