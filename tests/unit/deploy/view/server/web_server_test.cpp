// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/server/web_server.hpp"

#include <arpa/inet.h>
#include <atomic>
#include <netinet/in.h>
#include <set>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "tests/catch.hpp"
#include "tests/unit/deploy/view/server/web_client.hpp"

namespace sidestep::web_server_test {

using namespace std::chrono_literals;

/// A server in its own thread that sends each viewer the messages of `on_tick`.
class TestServer {
 public:
  explicit TestServer(const std::string& address = "127.0.0.1") {
    WebHandlers handlers;
    handlers.respond = [](const WebRequest& request) {
      if (request.path == "/throw") throw std::runtime_error("no reason");
      return WebResponse{
          200, "text/plain",
          request.method + " " + request.path + " " + request.body + " " + request.command_refusal};
    };
    handlers.respond_later = [this](const WebRequest& request, const WebReply& reply) {
      if (request.path == "/at-once") reply({202, "text/plain", "at once"});
      if (request.path == "/throw-later") throw std::runtime_error("no reason");
      if (request.path == "/later") {
        replies.push_back(reply);
        ++kept;
      }
      return request.path == "/at-once" || request.path == "/later";
    };
    handlers.on_open = [this](WebSocket& socket, const std::string& protocol) {
      sockets.insert(&socket);
      protocols.insert(protocol);
      ++opened;
    };
    handlers.on_message = [](WebSocket& socket, const std::string& message, bool is_binary) {
      if (message == "garbage" || is_binary) return false;
      if (message == "throw") throw std::runtime_error("no reason");
      socket.send_event({std::make_shared<const std::string>("echo " + message), false});
      return true;
    };
    handlers.on_close = [this](WebSocket& socket) {
      sockets.erase(&socket);
      ++closed;
      closed_while_sending += is_sending;
    };
    server.emplace(AccessSettings{address, 0, {}, "secret"}, std::vector<std::string>{"one", "two"},
                   handlers);
    thread = std::thread([this] {
      while (!is_over) {
        server->run_for(2ms);
        if (replies_now) {
          for (const WebReply& reply : replies) {
            reply({409, "text/plain", "late"});
            reply({200, "text/plain", "again"});
          }
          replies.clear();
        }
        if (on_tick)
          for (WebSocket* socket : std::set<WebSocket*>(sockets)) {
            is_sending = true;
            on_tick(*socket);
            is_sending = false;
          }
      }
      server.reset();
      for (const WebReply& reply : replies) reply({200, "text/plain", "too late"});
    });
  }
  ~TestServer() {
    is_over = true;
    thread.join();
  }
  std::uint16_t port() const { return port_ ? port_ : port_ = server->access().port; }

  std::function<void(WebSocket&)> on_tick;  ///< set before viewers connect
  std::set<WebSocket*> sockets;             ///< used only in the server's thread
  std::set<std::string> protocols;
  std::atomic<int> opened = 0, closed = 0, closed_while_sending = 0;
  bool is_sending = false;
  std::vector<WebReply> replies;  ///< used only in the server's thread
  std::atomic<int> kept = 0;
  std::atomic<bool> is_over = false, replies_now = false;

 private:
  mutable std::uint16_t port_ = 0;
  std::optional<WebServer> server;
  std::thread thread;
};

bool wait_until(const std::function<bool()>& condition) {
  for (int i = 0; i < 5000 && !condition(); ++i) std::this_thread::sleep_for(2ms);
  return condition();
}

/// Sends these bytes on a new connection and returns the bytes that arrive within a second.
std::string raw_exchange(std::uint16_t port, const std::string& bytes) {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
  REQUIRE(connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  const timeval timeout{1, 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
  (void)send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  std::string received;
  char buffer[4096];
  for (ssize_t n = 0; (n = recv(fd, buffer, sizeof buffer, 0)) > 0;)
    received.append(buffer, static_cast<std::size_t>(n));
  close(fd);
  return received;
}

TEST_CASE("a web server answers requests and refuses other hosts, other origins and invalid requests") {
  const TestServer server;
  const HttpAnswer answer = http_request(server.port(), "POST", "/a%20b?c=d", {}, "body");
  CHECK(answer.status == 200);
  CHECK(answer.body.starts_with("POST /a b body the header"));
  CHECK(answer.headers.at("Content-Security-Policy").find("default-src 'self'") == 0);
  CHECK(http_request(server.port(), "GET", "/", {{"Authorization", "Bearer secret"}}).body == "GET /  ");
  CHECK(http_request(server.port(), "GET", "/", {{"Host", "evil.example"}}).status == 403);
  CHECK(http_request(server.port(), "GET", "/", {{"Origin", "http://evil.example"}}).status == 403);
  CHECK(http_request(server.port(), "GET", "/%zz").status == 400);
  CHECK(http_request(server.port(), "POST", "/", {}, std::string(WebServer::kMaxRequestBytes + 1, 'x'))
            .status == 413);
}

TEST_CASE("a web server sends a response when it is ready, and answers other requests meanwhile") {
  TestServer server;
  CHECK(http_request(server.port(), "GET", "/at-once").body == "at once");
  CHECK(http_request(server.port(), "GET", "/throw-later").status == 500);
  HttpAnswer late;
  std::thread client([&] { late = http_request(server.port(), "POST", "/later"); });
  CHECK(wait_until([&] { return server.kept == 1; }));
  CHECK(http_request(server.port(), "GET", "/").status == 200);
  server.replies_now = true;
  client.join();
  CHECK(late.status == 409);
  CHECK(late.body == "late");
}

TEST_CASE("a web server may end while requests wait for their responses") {
  std::thread client;
  {
    TestServer server;
    client = std::thread([port = server.port()] { (void)http_request(port, "POST", "/later"); });
    CHECK(wait_until([&] { return server.kept == 1; }));
  }
  client.join();
}

TEST_CASE("a web server survives requests that are not HTTP") {
  const TestServer server;
  for (const std::string& bytes : {std::string("\x16\x03\x01\x02\x00\x01\xfc", 7), std::string(100, '\0'),
                                   std::string("GET / HTTP/9.9\r\n\r\n"), std::string("GET /"),
                                   "GET / HTTP/1.1\r\nx: " + std::string(100'000, 'y')})
    (void)raw_exchange(server.port(), bytes);
  CHECK(http_request(server.port(), "GET", "/").status == 200);
}

TEST_CASE("viewers negotiate a protocol and get messages") {
  TestServer server;
  SocketClient viewer(server.port(), "three, two");
  viewer.send("hello");
  const auto message = viewer.receive();
  REQUIRE(message);
  CHECK(message->text == "echo hello");
  CHECK(server.protocols == std::set<std::string>{"two"});
  CHECK_THROWS(SocketClient(server.port(), "one", {{"Origin", "http://evil.example"}}));
  CHECK_THROWS(SocketClient(server.port(), "one", {{"Host", "evil.example:1"}}));
}

TEST_CASE("only a viewer whose messages are invalid or too long is disconnected") {
  TestServer server;
  SocketClient other(server.port(), "one");
  for (const std::string& bad : {std::string("garbage"), std::string(WebServer::kMaxRequestBytes + 1, 'x')}) {
    SocketClient viewer(server.port(), "one");
    viewer.send(bad);
    while (viewer.receive(2s)) {
    }
    CHECK_FALSE(viewer.is_connected());
  }
  SocketClient binary(server.port(), "one");
  binary.send("x", true);
  CHECK_FALSE(binary.receive(2s));
  CHECK(binary.close_reason() == "the message is invalid");
  other.send("still here");
  CHECK(other.receive()->text == "echo still here");
  CHECK(wait_until([&] { return server.closed == 3; }));
}

TEST_CASE("an exception in a handler affects only the request or viewer that caused it") {
  TestServer server;
  SocketClient other(server.port(), "one"), viewer(server.port(), "one");
  viewer.send("throw");
  CHECK_FALSE(viewer.receive(2s));
  CHECK(viewer.close_reason() == "the message is invalid");
  const HttpAnswer answer = http_request(server.port(), "GET", "/throw");
  CHECK(answer.status == 500);
  CHECK(answer.body == "this request cannot be answered: no reason\n");
  other.send("still here");
  CHECK(other.receive()->text == "echo still here");
}

TEST_CASE("a viewer that reads slowly gets the newest state, and the server's memory stays bounded") {
  TestServer server;
  std::atomic<int> sent = 0;
  server.on_tick = [&](WebSocket& socket) {
    std::string state = std::to_string(++sent) + " ";
    state.resize(100'000, 'x');
    socket.send_state(0, {std::make_shared<const std::string>(state), true});
  };
  SocketClient viewer(server.port(), "one");
  // Starts reading only after the server has produced 20 MB of states.
  CHECK(wait_until([&] { return sent > 200; }));
  int received = 0, number = 0;
  const int begin = sent;
  while (number < begin && received < 200) {
    const auto message = viewer.receive();
    REQUIRE(message);
    number = std::stoi(message->text);
    ++received;
  }
  // The only old states are those that the kernel has buffered for the connection.
  CHECK(received < 60);
}

TEST_CASE("fifty viewers are served, and connections beyond the limit are refused") {
  TestServer server;
  server.on_tick = [](WebSocket& socket) {
    socket.send_state(0, {std::make_shared<const std::string>(5'000, 'x'), true});
  };
  std::vector<std::unique_ptr<SocketClient>> viewers;
  for (int i = 0; i < 50; ++i) viewers.push_back(std::make_unique<SocketClient>(server.port(), "one"));
  for (const auto& viewer : viewers) CHECK(viewer->receive());
  std::size_t refused = 0;
  std::vector<std::unique_ptr<SocketClient>> more;
  for (std::size_t i = 0; i < WebServer::kMaxConnections; ++i) {
    try {
      more.push_back(std::make_unique<SocketClient>(server.port(), "one"));
    } catch (const std::runtime_error&) {
      ++refused;
    }
  }
  CHECK(refused >= 50);
}

TEST_CASE("a viewer that does not read its events is disconnected, but not during a send") {
  TestServer server;
  server.on_tick = [](WebSocket& socket) {
    socket.send_event({std::make_shared<const std::string>(100'000, 'x'), false});
  };
  SocketClient viewer(server.port(), "one");
  CHECK(wait_until([&] { return server.closed == 1; }));
  CHECK(server.closed_while_sending == 0);
  CHECK(http_request(server.port(), "GET", "/").status == 200);
}

TEST_CASE("starting a server whose address is in use fails with the reason") {
  const TestServer server;
  CHECK_THROWS_WITH(WebServer({"127.0.0.1", server.port(), {}, ""}, {"one"}, {}),
                    ContainsSubstring("Address already in use"));
}

}  // namespace sidestep::web_server_test
