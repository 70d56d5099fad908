// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/file/temporary_folder.hpp"
#include "deploy/run/launch/process_group.hpp"

namespace sidestep {

/// A headless Chromium, driven by WebDriver (w3.org/TR/webdriver2) over HTTP. It ends with this object.
class Browser {
 public:
  /// Throws std::runtime_error if Chromium does not start.
  explicit Browser(int width_px = 1400, int height_px = 900);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void open(const std::string& url);
  /// Gives the page this many pixels, from now on.
  void resize(int width_px, int height_px);
  /// Lets the system prefer "dark" or "light" pages, from now on.
  void prefer(const std::string& theme);
  /// Runs a file of JavaScript in the page; what it defines stays until the next page is opened.
  void load_script(const std::string& path);
  /// The value of a JavaScript function body, e.g. "return document.title".
  nlohmann::json run(const std::string& script);
  /// The text of the element with this id.
  std::string text(const std::string& id);
  void click(const std::string& id);
  void press(const std::string& key);
  /// Waits until a JavaScript expression is true, for at most 20 s, and calls `meanwhile` repeatedly. Returns
  /// whether it became true.
  bool wait_until(
      const std::string& expression, const std::function<void()>& meanwhile = [] {});
  /// Script errors and loading errors that the page has logged; not advice to tests that often read pixels.
  std::string logged_errors();
  void save_screenshot(const std::string& path);

 private:
  nlohmann::json call(const std::string& method, const std::string& path,
                      const nlohmann::json& body = nlohmann::json::object());

  TemporaryFolder folder_;
  ProcessGroup group_;
  std::uint16_t port_;
  std::string session_;
  pid_t pid_ = 0;  ///< process id of Chromium
};

}  // namespace sidestep
