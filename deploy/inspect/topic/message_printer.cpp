// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/message_printer.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <sstream>
#include <stdexcept>

#include "common/json/json_text.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

/// A string without quotes, or any other value as JSON. Does not throw for invalid UTF-8.
std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : json_text(value);
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) {
    if (c == '"') cell += '"';
    cell += c;
  }
  return cell + '"';
}

struct CsvLine {
  std::string names, cells;

  void add(const std::string& path, const Json& value) {
    if (value.is_object()) {
      for (const auto& [name, member] : value.items()) add(path.empty() ? name : path + '.' + name, member);
      return;
    }
    const char* separator = names.empty() ? "" : ",";
    names += separator + path;
    cells += separator + csv_cell(text_of(value));
  }
};

/// Finds a member; nullptr if a list is too short. Throws std::invalid_argument if a name is unknown.
const Json* find_member(const Json& message, const std::vector<std::string>& path) {
  const Json* value = &message;
  for (const std::string& name : path) {
    if (value->is_array()) {
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
      if (error != std::errc() || end != name.data() + name.size())
        throw std::invalid_argument(fmt::format("'{}' is not the index of an element", name));
      if (index >= value->size()) return nullptr;
      value = &(*value)[index];
    } else if (value->is_object() && value->contains(name)) {
      value = &(*value)[name];
    } else {
      std::string names;
      if (value->is_object())
        for (const auto& [known, member] : value->items()) names += (names.empty() ? "" : ", ") + known;
      throw std::invalid_argument(
          fmt::format("there is no member '{}', expected one of: {}", name, names.empty() ? "none" : names));
    }
  }
  return value;
}

}  // namespace

MessageFilter parse_message_filter(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw std::invalid_argument(fmt::format("'{}' is not MEMBER=VALUE, e.g. robot=3", text));
  MessageFilter filter{{}, text.substr(equals + 1)};
  std::istringstream names(text.substr(0, equals));
  for (std::string name; std::getline(names, name, '.');) filter.path.push_back(name);
  return filter;
}

bool MessagePrinter::is_wanted(const Json& message) const {
  return std::ranges::all_of(settings_.filters, [&](const MessageFilter& filter) {
    const Json* value = find_member(message, filter.path);
    return value != nullptr && text_of(*value) == filter.value;
  });
}

void MessagePrinter::print_if_wanted(const Json& message) {
  ++received_;
  if (is_done() || !is_wanted(message)) return;
  if (settings_.is_csv) {
    CsvLine line;
    line.add("", message);
    if (printed_ == 0) print_(line.names);
    print_(line.cells);
  } else {
    print_(json_text(message));
  }
  ++printed_;
}

}  // namespace sidestep
