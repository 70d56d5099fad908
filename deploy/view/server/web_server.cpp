// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/server/web_server.hpp"

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "deploy/view/server/url.hpp"

namespace sidestep {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using ErrorCode = boost::system::error_code;
// The types name their executor and leave compression out, because both would double the time of compiling.
using Protocol = asio::ip::tcp;
using Executor = asio::io_context::executor_type;
using Socket = asio::basic_stream_socket<Protocol, Executor>;
using TcpStream = beast::basic_stream<Protocol, Executor>;
using Stream = websocket::stream<TcpStream, false>;

constexpr auto kRequestTimeout = std::chrono::seconds(20);
/// Timeout for a viewer that answers no pings, e.g. because its machine is asleep.
constexpr auto kSilenceTimeout = std::chrono::seconds(30);
/// The kernel's buffer for a viewer. Small, so that a slow viewer gets the newest state soon.
constexpr int kSendBufferBytes = 64 << 10;

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

template <typename Request>
RequestSource source_of(const Request& request) {
  return {view(request[http::field::host]), view(request[http::field::origin]),
          view(request[http::field::authorization])};
}

struct Server {
  AccessSettings access;
  std::vector<std::string> protocols;
  WebHandlers handlers;
  std::size_t connections = 0;
  bool is_stopped = false;
  std::set<std::shared_ptr<void>> waiting;  ///< sessions whose request is kept for a later response
};

class SocketSession : public WebSocket, public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(Server& server, TcpStream&& stream) : server_(server), stream_(std::move(stream)) {
    ++server_.connections;
  }
  ~SocketSession() override { --server_.connections; }
  SocketSession(const SocketSession&) = delete;
  SocketSession& operator=(const SocketSession&) = delete;

  void accept(http::request<http::string_body> request) {
    stream_.next_layer().expires_never();
    websocket::stream_base::timeout timeout{kRequestTimeout, kSilenceTimeout, true};
    stream_.set_option(timeout);
    stream_.read_message_max(WebServer::kMaxRequestBytes);
    const std::string wanted(view(request[http::field::sec_websocket_protocol]));
    protocol_ = agreed_protocol(wanted);
    stream_.set_option(
        websocket::stream_base::decorator([this, is_named = !wanted.empty()](websocket::response_type& r) {
          if (is_named) r.set(http::field::sec_websocket_protocol, protocol_);
        }));
    request_ = std::move(request);
    stream_.async_accept(request_, [self = shared_from_this()](ErrorCode error) {
      if (error || self->server_.is_stopped) return;
      self->is_open_ = true;
      self->server_.handlers.on_open(*self, self->protocol_);
      self->read();
    });
  }

  void send_state(unsigned slot, WebMessage message) override {
    outbox_.put_state(slot, std::move(message));
    write();
  }
  void send_event(WebMessage message) override {
    if (outbox_.add_event(std::move(message))) return write();
    // The read in progress then fails and ends the session. That happens later, because callers may be
    // iterating over viewers.
    beast::get_lowest_layer(stream_).close();
  }
  /// Disconnects, and sends the viewer the reason.
  void close(const std::string& reason) {
    if (is_closing_) return;
    is_closing_ = true;
    stream_.async_close({websocket::close_code::policy_error, reason.substr(0, 120)},
                        [self = shared_from_this()](ErrorCode) { self->end(); });
  }

 private:
  /// The server's first protocol that the viewer supports; its first one if there is none.
  std::string agreed_protocol(const std::string& wanted) const {
    for (const std::string& known : server_.protocols)
      for (const auto& token : http::token_list(wanted))
        if (view(token) == known) return known;
    return server_.protocols.front();
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error || self->server_.is_stopped) return self->end();
      const std::string message = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      if (self->is_closing_) return self->read();
      if (!self->is_valid_message(message)) self->close("the message is invalid");
      self->read();
    });
  }

  bool is_valid_message(const std::string& message) {
    try {
      return server_.handlers.on_message(*this, message, stream_.got_binary());
    } catch (const std::exception&) {
      return false;  // the other viewers are still served
    }
  }

  void write() {
    if (is_writing_ || is_closing_ || !is_open_) return;
    std::optional<WebMessage> message = outbox_.take();
    if (!message) return;
    is_writing_ = true;
    stream_.binary(message->is_binary);
    stream_.async_write(
        asio::buffer(*message->payload),
        [self = shared_from_this(), payload = message->payload](ErrorCode error, std::size_t) {
          self->is_writing_ = false;
          if (error || self->server_.is_stopped) return self->end();
          self->write();
        });
  }

  void end() {
    if (!std::exchange(is_open_, false) || server_.is_stopped) return;
    server_.handlers.on_close(*this);
  }

  Server& server_;
  Stream stream_;
  http::request<http::string_body> request_;
  std::string protocol_;
  beast::flat_buffer buffer_;
  Outbox outbox_;
  bool is_open_ = false, is_writing_ = false, is_closing_ = false;
};

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(Server& server, Socket&& socket) : server_(server), stream_(std::move(socket)) {
    ++server_.connections;
  }
  ~HttpSession() { --server_.connections; }
  HttpSession(const HttpSession&) = delete;
  HttpSession& operator=(const HttpSession&) = delete;

  void read() {
    parser_.emplace();
    parser_->body_limit(WebServer::kMaxRequestBytes);
    parser_->header_limit(WebServer::kMaxRequestBytes);
    stream_.expires_after(kRequestTimeout);
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (self->server_.is_stopped) return;
      if (error == http::error::body_limit || error == http::error::header_limit)
        return self->answer({413, "text/plain", "the request is too large\n"}, true);
      if (error) return;
      self->handle(self->parser_->release());
    });
  }

 private:
  void handle(http::request<http::string_body> request) {
    const RequestSource source = source_of(request);
    const std::string reason = refusal(server_.access, source);
    if (!reason.empty()) return answer({403, "text/plain", reason + "\n"}, true);
    if (server_.connections > WebServer::kMaxConnections)
      return answer({503, "text/plain", "too many connections\n"}, true);
    if (websocket::is_upgrade(request)) {
      std::make_shared<SocketSession>(server_, std::move(stream_))->accept(std::move(request));
      return;
    }
    const bool must_close = !request.keep_alive();
    const std::optional<Url> url = parse_target(view(request.target()));
    if (!url) return answer({400, "text/plain", "the path is not valid\n"}, must_close);
    const WebRequest parsed{std::string(view(request.method_string())), url->path, url->query, request.body(),
                            command_refusal(server_.access, source)};
    if (!is_kept_for_later(parsed, must_close)) answer(response_to(parsed), must_close);
  }

  bool is_kept_for_later(const WebRequest& request, bool must_close) {
    if (!server_.handlers.respond_later) return false;
    const WebReply reply = [session = weak_from_this(), must_close](WebResponse response) {
      const auto self = session.lock();
      if (self && self->server_.waiting.erase(self) > 0) self->answer(std::move(response), must_close);
    };
    server_.waiting.insert(shared_from_this());
    try {
      if (server_.handlers.respond_later(request, reply)) return true;
    } catch (const std::exception& error) {
      reply(failure(error));
      return true;
    }
    server_.waiting.erase(shared_from_this());
    return false;
  }

  WebResponse response_to(const WebRequest& request) {
    try {
      return server_.handlers.respond(request);
    } catch (const std::exception& error) {
      return failure(error);
    }
  }

  static WebResponse failure(const std::exception& error) {
    return {500, "text/plain", std::string("this request cannot be answered: ") + error.what() + "\n"};
  }

  void answer(WebResponse response, bool must_close) {
    const auto message = std::make_shared<http::response<http::string_body>>();
    message->result(response.status);
    message->set(http::field::content_type, response.content_type);
    message->set(http::field::cache_control, "no-store");
    message->set("Content-Security-Policy",
                 "default-src 'self'; connect-src 'self' ws:; img-src 'self' data: blob:; frame-ancestors "
                 "'none'; base-uri 'none'");
    message->set("X-Content-Type-Options", "nosniff");
    message->set("Referrer-Policy", "no-referrer");
    message->keep_alive(!must_close);
    message->body() = std::move(response.body);
    message->prepare_payload();
    stream_.expires_after(kRequestTimeout);
    http::async_write(stream_, *message, [self = shared_from_this(), message](ErrorCode error, std::size_t) {
      if (error || self->server_.is_stopped) return;
      if (message->keep_alive()) return self->read();
      ErrorCode ignored;
      self->stream_.socket().shutdown(Socket::shutdown_send, ignored);
    });
  }

  Server& server_;
  TcpStream stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
};

}  // namespace

struct WebServer::Impl {
  Server server;
  asio::io_context context{1};
  asio::basic_socket_acceptor<Protocol, Executor> acceptor{context};

  void listen() {
    const Protocol::endpoint endpoint(asio::ip::make_address(server.access.address), server.access.port);
    acceptor.open(endpoint.protocol());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    acceptor.bind(endpoint);
    acceptor.listen();
    server.access.port = acceptor.local_endpoint().port();
    accept();
  }

  void accept() {
    acceptor.async_accept([this](ErrorCode error, Socket socket) {
      if (server.is_stopped) return;
      if (!error) {
        ErrorCode ignored;
        socket.set_option(Protocol::no_delay(true), ignored);
        socket.set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
        std::make_shared<HttpSession>(server, std::move(socket))->read();
      }
      accept();
    });
  }

  ~Impl() {
    server.is_stopped = true;
    server.waiting.clear();  // while their sockets' context still exists
  }
};

WebServer::WebServer(const AccessSettings& access, std::vector<std::string> protocols, WebHandlers handlers)
    : impl_(std::make_unique<Impl>()) {
  impl_->server.access = access;
  impl_->server.protocols = std::move(protocols);
  impl_->server.handlers = std::move(handlers);
  try {
    impl_->listen();
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(
        fmt::format("cannot listen on {}:{}: {}", access.address, access.port, error.code().message()));
  }
}

WebServer::~WebServer() = default;

const AccessSettings& WebServer::access() const { return impl_->server.access; }

void WebServer::poll() {
  impl_->context.restart();
  impl_->context.poll();
}

void WebServer::run_for(Duration duration) {
  impl_->context.restart();
  impl_->context.run_for(duration);
}

}  // namespace sidestep
