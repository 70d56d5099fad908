// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace sidestep {

/// A condition on a message, for example robot=3 or header.sender=3.
struct MessageFilter {
  std::vector<std::string> path;  ///< names of members, or indices of lists
  std::string value;
};

/// Parses MEMBER=VALUE. Throws std::invalid_argument for any other text.
[[nodiscard]] MessageFilter parse_message_filter(const std::string& text);

struct MessagePrinterSettings {
  std::vector<MessageFilter> filters;  ///< only messages that satisfy all of them are printed
  bool is_csv = false;
  std::uint64_t count = 0;  ///< number of messages to print; 0: all
};

/// Formats described messages of one type as lines: JSON, or CSV with one column per member, in which lists
/// are JSON.
class MessagePrinter {
 public:
  /// `print` receives each line without its line break.
  MessagePrinter(MessagePrinterSettings settings, std::function<void(const std::string&)> print)
      : settings_(std::move(settings)), print_(std::move(print)) {}

  /// Prints the message if it is wanted. Throws std::invalid_argument if a filter names an unknown member.
  void print_if_wanted(const nlohmann::ordered_json& message);
  bool is_done() const { return settings_.count > 0 && printed_ == settings_.count; }
  std::uint64_t printed() const { return printed_; }
  /// Number of messages so far, wanted or not.
  std::uint64_t received() const { return received_; }

 private:
  [[nodiscard]] bool is_wanted(const nlohmann::ordered_json& message) const;

  MessagePrinterSettings settings_;
  std::function<void(const std::string&)> print_;
  std::uint64_t printed_ = 0, received_ = 0;
};

}  // namespace sidestep
