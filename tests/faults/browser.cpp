// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/browser.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <netinet/in.h>
#include <signal.h>
#include <stdexcept>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "common/json/json_text.hpp"
#include "tests/unit/deploy/view/server/web_client.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::json;

// The browser itself: Debian's /usr/bin/chromium-headless-shell is a script, and ending it would not end the
// browser.
constexpr const char* kChromium = "/usr/lib/chromium/chromium-headless-shell";
constexpr auto kPollPeriod = std::chrono::milliseconds(20);
constexpr int kPolls = 1000;

std::uint16_t free_port() {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool is_bound = bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
                        getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  close(fd);
  if (!is_bound) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

std::string decoded_base64(const std::string& text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned value = 0;
  int bits = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string::npos) continue;
    value = value << 6 | static_cast<unsigned>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(value >> bits & 0xff);
  }
  return bytes;
}

}  // namespace

Browser::Browser(int width_px, int height_px) : group_(folder_.file("driver.log")), port_(free_port()) {
  group_.start({"driver", {"/usr/bin/chromedriver", fmt::format("--port={}", port_)}, false});
  for (int i = 0; i < kPolls && http_request(port_, "GET", "/status").status != 200; ++i)
    std::this_thread::sleep_for(kPollPeriod);
  const Json options{{"binary", kChromium},
                     {"args",
                      {"--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                       fmt::format("--window-size={},{}", width_px, height_px)}}};
  const Json always{{"goog:chromeOptions", options}, {"goog:loggingPrefs", {{"browser", "ALL"}}}};
  const Json session = call("POST", "/session", {{"capabilities", {{"alwaysMatch", always}}}});
  session_ = session.at("sessionId");
  pid_ = session.at("capabilities").at("goog:processID");
}

Browser::~Browser() {
  // Otherwise Chromium would outlive its driver.
  if (!session_.empty()) (void)http_request(port_, "DELETE", "/session/" + session_);
  if (pid_ > 0) (void)kill(pid_, SIGKILL);
  (void)group_.terminate(std::chrono::seconds(5));
}

Json Browser::call(const std::string& method, const std::string& path, const Json& body) {
  const std::string target = session_.empty() ? path : "/session/" + session_ + path;
  const HttpAnswer answer = http_request(port_, method, target, {{"Content-Type", "application/json"}},
                                         method == "GET" ? std::string() : json_text(body));
  const Json json = parse_json(answer.body, false);
  if (answer.status != 200 || !json.is_object())
    throw std::runtime_error(fmt::format("browser: {} {}: {} {}", method, path, answer.status, answer.body));
  return json.at("value");
}

void Browser::open(const std::string& url) { call("POST", "/url", {{"url", url}}); }

void Browser::resize(int width_px, int height_px) {
  call("POST", "/goog/cdp/execute",
       {{"cmd", "Emulation.setDeviceMetricsOverride"},
        {"params",
         {{"width", width_px}, {"height", height_px}, {"deviceScaleFactor", 1}, {"mobile", false}}}});
}

void Browser::prefer(const std::string& theme) {
  const Json preference{{"name", "prefers-color-scheme"}, {"value", theme}};
  call("POST", "/goog/cdp/execute",
       {{"cmd", "Emulation.setEmulatedMedia"}, {"params", {{"features", Json::array({preference})}}}});
}

void Browser::load_script(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  run({std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
}

Json Browser::run(const std::string& script) {
  return call("POST", "/execute/sync", {{"script", script}, {"args", Json::array()}});
}

std::string Browser::text(const std::string& id) {
  return run(fmt::format("return document.getElementById('{}').textContent", id));
}

void Browser::click(const std::string& id) { run(fmt::format("document.getElementById('{}').click()", id)); }

void Browser::press(const std::string& key) {
  run(fmt::format("document.body.dispatchEvent(new KeyboardEvent('keydown', {{key: '{}', bubbles: true}}))",
                  key));
}

bool Browser::wait_until(const std::string& expression, const std::function<void()>& meanwhile) {
  for (int i = 0; i < kPolls; ++i) {
    if (run("return Boolean(" + expression + ")") == true) return true;
    meanwhile();
    std::this_thread::sleep_for(kPollPeriod);
  }
  return false;
}

std::string Browser::logged_errors() {
  std::string all;
  for (const Json& entry : call("POST", "/se/log", {{"type", "browser"}})) {
    const auto message = entry.at("message").get<std::string>();
    if (message.find("willReadFrequently") != std::string::npos) continue;
    all += entry.at("level").get<std::string>() + " " + message + "\n";
  }
  return all;
}

void Browser::save_screenshot(const std::string& path) {
  const std::string png = decoded_base64(call("GET", "/screenshot"));
  std::ofstream(path, std::ios::binary).write(png.data(), static_cast<std::streamsize>(png.size()));
}

}  // namespace sidestep
