// SPDX-License-Identifier: Apache-2.0
#include "tests/arguments/table.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

namespace sidestep::arguments {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> parts_of(const std::string& line) {
  std::vector<std::string> parts;
  std::size_t at = 0;
  for (std::size_t bar = line.find(" | "); bar != std::string::npos; bar = line.find(" | ", at)) {
    parts.push_back(trimmed(line.substr(at, bar - at)));
    at = bar + 3;
  }
  parts.push_back(trimmed(line.substr(at)));
  return parts;
}

const Section& section(const std::vector<Section>& table, const std::string& heading) {
  const auto found = std::ranges::find(table, heading, &Section::heading);
  if (found == table.end()) throw std::runtime_error("the table has no section " + heading);
  return *found;
}

/// Numbers just beyond the limits of an option.
void add_beyond(Placeholders& placeholders) {
  const std::string &low = placeholders["low"], &high = placeholders["high"];
  const bool is_whole = (low + high).find_first_of(".e") == std::string::npos;
  if (high.size() > 12) return;  // the limits are those of the number's type
  const double step = is_whole ? 1 : 1e-4 * std::stod(high);
  placeholders["below"] = fmt::format("{:.10g}", std::stod(low) - step);
  placeholders["above"] = fmt::format("{:.10g}", std::stod(high) + step);
}

void add_rows(const std::vector<Section>& table, const Placeholders& given, const std::string& command,
              const std::vector<std::string>& option, std::vector<Row>& rows) {
  if (option.size() == 1) {
    for (const auto& shared : section(table, "group " + option[0]).rows)
      add_rows(table, given, command, shared, rows);
    return;
  }
  Placeholders placeholders = given;
  placeholders["option"] = option[0];
  if (option.size() > 3) {
    placeholders["low"] = option[2];
    placeholders["high"] = option[3];
    add_beyond(placeholders);
  }
  const bool is_positional = std::isupper(static_cast<unsigned char>(option[0][0])) != 0;
  for (const auto& value : section(table, "kind " + option[1]).rows) {
    Row row{2, {filled_in(value.at(1), placeholders)}, words_of(command, placeholders)};
    const std::string text = words_of(value[0], placeholders).at(0);
    if (is_positional) {
      // After "--", an argument such as "-1" is not an option.
      row.command.insert(row.command.end(), {"--", text});
    } else {
      // An empty value as its own argument, as shells pass --option "$UNSET"; "--option=" would mean no
      // value.
      if (text.empty())
        row.command.insert(row.command.end(), {option[0], text});
      else
        row.command.push_back(option[0] + "=" + text);
      row.messages.push_back(option[0]);
    }
    rows.push_back(row);
  }
}

}  // namespace

std::vector<Section> read_table(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file);
  std::vector<Section> sections;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] != ' ')
      sections.push_back({trimmed(line), {}});
    else
      sections.back().rows.push_back(parts_of(line));
  }
  return sections;
}

std::string filled_in(const std::string& text, const Placeholders& placeholders) {
  std::string result;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text.compare(at, 2, "\\x") == 0 && at + 3 < text.size()) {
      result += static_cast<char>(std::stoi(text.substr(at + 2, 2), nullptr, 16));
      at += 3;
      continue;
    }
    const std::size_t end = text[at] == '{' ? text.find('}', at) : std::string::npos;
    const auto found =
        end == std::string::npos ? placeholders.end() : placeholders.find(text.substr(at + 1, end - at - 1));
    if (found == placeholders.end()) {
      result += text[at];
      continue;
    }
    result += found->second;
    at = end;
  }
  return result;
}

std::vector<std::string> words_of(const std::string& text, const Placeholders& placeholders) {
  std::vector<std::string> words;
  bool is_quoted = false, is_word = false;
  std::string word;
  const auto end = [&] {
    if (is_word) words.push_back(filled_in(word, placeholders));
    word.clear();
    is_word = false;
  };
  for (const char c : text) {
    if (c == '"') {
      is_quoted = !is_quoted;
      is_word = true;
    } else if (c == ' ' && !is_quoted) {
      end();
    } else {
      word += c;
      is_word = true;
    }
  }
  end();
  return words;
}

std::vector<Row> option_rows(const std::vector<Section>& table, const Placeholders& placeholders) {
  constexpr std::string_view kHeading = "options ";
  std::vector<Row> rows;
  for (const Section& commands : table) {
    if (!commands.heading.starts_with(kHeading)) continue;
    for (const auto& option : commands.rows)
      add_rows(table, placeholders, commands.heading.substr(kHeading.size()), option, rows);
  }
  return rows;
}

std::vector<Row> single_rows(const std::vector<Section>& table, const Placeholders& placeholders) {
  std::vector<Row> rows;
  for (const auto& parts : section(table, "rows").rows)
    rows.push_back({std::stoi(parts.at(0)),
                    {filled_in(parts.at(1), placeholders)},
                    words_of(parts.at(2), placeholders)});
  return rows;
}

std::vector<WritingCommand> writing_commands(const std::vector<Section>& table) {
  std::vector<WritingCommand> commands;
  for (const auto& parts : section(table, "writes").rows)
    commands.push_back({words_of(parts.at(0), {}), parts.at(1)});
  return commands;
}

std::vector<std::string> commands_of(const std::vector<Section>& table, const std::string& heading) {
  std::vector<std::string> commands;
  for (const auto& parts : section(table, heading).rows) commands.push_back(parts.at(0));
  return commands;
}

}  // namespace sidestep::arguments
