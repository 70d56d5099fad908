// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "common/time/time.hpp"
#include "deploy/view/server/access.hpp"
#include "deploy/view/server/outbox.hpp"

namespace sidestep {

struct WebRequest {
  std::string method;                        ///< for example GET
  std::string path;                          ///< decoded, without the query
  std::map<std::string, std::string> query;  ///< decoded
  std::string body;
  std::string command_refusal;  ///< why the request may not give commands; empty if it may
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
  /// Sends the newest value of a state. An earlier value that was not sent yet is discarded.
  virtual void send_state(unsigned slot, WebMessage message) = 0;
  /// Sends an event. Events are never discarded: a viewer that reads too slowly is disconnected.
  virtual void send_event(WebMessage message) = 0;
};

/// Sends the response to a request, to be called once, in the thread that polls the server. Has no effect if
/// the server no longer exists.
using WebReply = std::function<void(WebResponse)>;

/// Callbacks of a server. All calls come from the thread that polls it.
struct WebHandlers {
  /// Responds to requests that respond_later leaves to it.
  std::function<WebResponse(const WebRequest&)> respond;
  /// `protocol` is the one that the viewer and the server agreed on.
  std::function<void(WebSocket&, const std::string& protocol)> on_open;
  /// A message from the viewer. Returns false if it is invalid; the viewer is then disconnected.
  std::function<bool(WebSocket&, const std::string& message, bool is_binary)> on_message;
  std::function<void(WebSocket&)> on_close;
  /// Keeps a request whose response may take a while, and replies at once or later. Returns false if it
  /// leaves the request to `respond`. Empty: it leaves all requests to `respond`.
  std::function<bool(const WebRequest&, const WebReply&)> respond_later{};
};

/// A web server for a few viewers: HTTP and web sockets. Requests from other origins, and messages larger
/// than kMaxRequestBytes, are refused.
class WebServer {
 public:
  static constexpr std::size_t kMaxRequestBytes = 64 << 10;
  static constexpr std::size_t kMaxConnections = 128;

  /// Port 0 means any free port. `protocols` lists the names of the supported web socket protocols; the first
  /// one is used for viewers that name none. Throws std::runtime_error with the reason if the address cannot
  /// be used.
  WebServer(const AccessSettings& access, std::vector<std::string> protocols, WebHandlers handlers);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// The access settings, with the actual port.
  const AccessSettings& access() const;
  /// Processes all pending network events without waiting.
  void poll();
  /// Processes network events for this duration.
  void run_for(Duration duration);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
