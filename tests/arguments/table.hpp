// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

namespace sidestep::arguments {

/// A command line and the expected result.
struct Row {
  int exit_code = 2;
  std::vector<std::string> messages;  ///< texts that stderr must contain
  std::vector<std::string> command;   ///< the program's name and its arguments
};

/// A section of the table: its heading, and the parts of each of its rows.
struct Section {
  std::string heading;
  std::vector<std::vector<std::string>> rows;
};

using Placeholders = std::map<std::string, std::string>;

/// Throws std::runtime_error if the file cannot be read.
[[nodiscard]] std::vector<Section> read_table(const std::string& file);

/// The text with placeholders such as {low} replaced, and \xNN by bytes.
[[nodiscard]] std::string filled_in(const std::string& text, const Placeholders& placeholders);

/// The words of a command, with placeholders filled in.
[[nodiscard]] std::vector<std::string> words_of(const std::string& text, const Placeholders& placeholders);

/// A row for each option of the table and each value of its kind.
[[nodiscard]] std::vector<Row> option_rows(const std::vector<Section>& table,
                                           const Placeholders& placeholders);

/// The rows of the section "rows".
[[nodiscard]] std::vector<Row> single_rows(const std::vector<Section>& table,
                                           const Placeholders& placeholders);

/// A command of the section "writes".
struct WritingCommand {
  std::vector<std::string> flaws;  ///< "full", "read-only" or "closed"
  std::string command;             ///< with {out} for the folder with the flaw
};
[[nodiscard]] std::vector<WritingCommand> writing_commands(const std::vector<Section>& table);

/// The commands of a section such as "yaml"; {file} remains.
[[nodiscard]] std::vector<std::string> commands_of(const std::vector<Section>& table,
                                                   const std::string& heading);

}  // namespace sidestep::arguments
