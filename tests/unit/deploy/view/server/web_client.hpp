// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

struct HttpAnswer {
  unsigned status = 0;
  std::map<std::string, std::string> headers;
  std::string body;
};

/// Sends one request and waits for the answer. Status 0: no answer within `timeout`.
[[nodiscard]] HttpAnswer http_request(std::uint16_t port, const std::string& method,
                                      const std::string& target,
                                      const std::map<std::string, std::string>& headers = {},
                                      const std::string& body = {},
                                      Duration timeout = std::chrono::seconds(60));

/// A web socket viewer for tests.
class SocketClient {
 public:
  struct Message {
    std::string text;
    bool is_binary = false;
  };

  /// Throws std::runtime_error if the connection is refused.
  explicit SocketClient(std::uint16_t port, const std::string& protocol = "sidestep.monitor.v1",
                        const std::map<std::string, std::string>& headers = {});
  ~SocketClient();
  SocketClient(const SocketClient&) = delete;
  SocketClient& operator=(const SocketClient&) = delete;

  void send(const std::string& message, bool is_binary = false);
  /// The next message; nullopt: no message within `timeout`, or disconnected.
  std::optional<Message> receive(Duration timeout = std::chrono::seconds(10));
  bool is_connected() const;
  /// The server's reason for disconnecting.
  std::string close_reason() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
