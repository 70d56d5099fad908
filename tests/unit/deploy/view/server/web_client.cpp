// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/deploy/view/server/web_client.hpp"

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <stdexcept>

namespace sidestep {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
// One named executor and no compression: the general executor and compression double the compile time.
using Protocol = asio::ip::tcp;
using TcpStream = beast::basic_stream<Protocol, asio::io_context::executor_type>;

Protocol::endpoint endpoint(std::uint16_t port) { return {asio::ip::make_address("127.0.0.1"), port}; }

}  // namespace

HttpAnswer http_request(std::uint16_t port, const std::string& method, const std::string& target,
                        const std::map<std::string, std::string>& headers, const std::string& body,
                        Duration timeout) {
  asio::io_context context;
  TcpStream stream(context);
  http::request<http::string_body> request;
  request.method_string(method);
  request.target(target);
  request.version(11);
  request.set(http::field::host, "localhost:" + std::to_string(port));
  for (const auto& [name, value] : headers) request.set(name, value);
  request.body() = body;
  request.prepare_payload();
  http::response_parser<http::string_body> response;
  response.body_limit(256u << 20);
  beast::flat_buffer buffer;
  bool is_answered = false;
  stream.expires_after(timeout);
  stream.async_connect(endpoint(port), [&](beast::error_code error) {
    if (error) return;
    http::async_write(stream, request, [&](beast::error_code write_error, std::size_t) {
      if (write_error) return;
      http::async_read(stream, buffer, response,
                       [&](beast::error_code read_error, std::size_t) { is_answered = !read_error; });
    });
  });
  context.run();
  if (!is_answered) return {};
  HttpAnswer answer{response.get().result_int(), {}, response.get().body()};
  for (const auto& field : response.get())
    answer.headers[std::string(field.name_string().data(), field.name_string().size())] =
        std::string(field.value().data(), field.value().size());
  return answer;
}

struct SocketClient::Impl {
  asio::io_context context;
  websocket::stream<TcpStream, false> stream{context};
  beast::flat_buffer buffer;
  bool is_connected = false, is_reading = false, has_message = false;
};

SocketClient::SocketClient(std::uint16_t port, const std::string& protocol,
                           const std::map<std::string, std::string>& headers)
    : impl_(std::make_unique<Impl>()) {
  beast::get_lowest_layer(impl_->stream).connect(endpoint(port));
  impl_->stream.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    request.set(http::field::sec_websocket_protocol, protocol);
    for (const auto& [name, value] : headers) request.set(name, value);
  }));
  impl_->stream.read_message_max(256u << 20);
  beast::error_code error;
  websocket::response_type response;
  const auto host = headers.find("Host");
  impl_->stream.handshake(
      response, host == headers.end() ? "localhost:" + std::to_string(port) : host->second, "/socket", error);
  if (error) throw std::runtime_error(error.message());
  impl_->is_connected = true;
}

SocketClient::~SocketClient() {
  try {
    beast::get_lowest_layer(impl_->stream).close();
    impl_->context.restart();
    impl_->context.run_for(std::chrono::seconds(1));  // ends a read in progress
  } catch (const std::exception&) {
    // The result does not matter, because the connection is closed.
  }
}

void SocketClient::send(const std::string& message, bool is_binary) {
  impl_->stream.binary(is_binary);
  beast::error_code error;
  impl_->stream.write(asio::buffer(message), error);
}

std::optional<SocketClient::Message> SocketClient::receive(Duration timeout) {
  Impl& impl = *impl_;
  if (!impl.is_connected) return std::nullopt;
  if (!impl.is_reading) {
    impl.is_reading = true;
    impl.stream.async_read(impl.buffer, [&impl](beast::error_code error, std::size_t) {
      impl.is_reading = false;
      if (error)
        impl.is_connected = false;
      else
        impl.has_message = true;
    });
  }
  impl.context.restart();
  impl.context.run_for(timeout);
  if (!impl.has_message) return std::nullopt;
  impl.has_message = false;
  Message message{beast::buffers_to_string(impl.buffer.data()), impl.stream.got_binary()};
  impl.buffer.consume(impl.buffer.size());
  return message;
}

bool SocketClient::is_connected() const { return impl_->is_connected; }

std::string SocketClient::close_reason() const {
  return {impl_->stream.reason().reason.data(), impl_->stream.reason().reason.size()};
}

}  // namespace sidestep
