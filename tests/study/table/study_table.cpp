// SPDX-License-Identifier: Apache-2.0
#include "tests/study/table/study_table.hpp"

#include <algorithm>
#include <filesystem>
#include <unistd.h>

#include "common/file/console.hpp"
#include "common/file/write_file.hpp"
#include "common/terminal/redrawn_text.hpp"
#include "common/terminal/terminal.hpp"
#include "common/version/version.hpp"

namespace sidestep {

void StudyProgress::operator()(std::size_t done, std::size_t of) {
  const bool can_redraw = terminal_of(STDERR_FILENO).can_redraw;
  const auto now = std::chrono::steady_clock::now();
  if (done < of && now < next_) return;
  next_ = now + (can_redraw ? std::chrono::milliseconds(200) : std::chrono::seconds(5));
  const std::string line = fmt::format("{}: {} of {} runs", name_, done, of);
  print_to(stderr, "{}{}", can_redraw ? redrawn_line(line, STDERR_FILENO) : line,
           can_redraw && done < of ? "" : "\n");
}

void require_study_output(const StudyOptions& options) {
  require_gnuplot();
  const std::filesystem::path trial = std::filesystem::path(options.folder) / ".trial";
  write_file(trial.string(), "");
  std::filesystem::remove(trial);
}

void write_study_table(const StudyTable& table, const std::string& study, const StudyOptions& options) {
  const std::filesystem::path folder = options.folder;
  std::string text = fmt::format("# sidestep study {} --out {} --seed {}{}\n# commit {}\n{}\n", study,
                                 options.folder, options.seed, options.is_quick ? " --quick" : "",
                                 kBuildCommit, fmt::join(table.columns, ","));
  for (const auto& row : table.rows) text += fmt::format("{}\n", fmt::join(row, ","));
  write_file((folder / (table.name + ".csv")).string(), text);
  if (!table.plots.empty()) draw(table.plots, (folder / (table.name + ".png")).string());
  fmt::print("{0}/{1}.csv{2}\n", folder.string(), table.name,
             table.plots.empty() ? "" : fmt::format(", {}/{}.png", folder.string(), table.name));
  std::fflush(stdout);
}

std::string markdown_of(const StudyTable& table) {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    widths.push_back(table.columns[i].size());
    for (const auto& row : table.rows) widths[i] = std::max(widths[i], row[i].size());
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text = "|";
    for (std::size_t i = 0; i < cells.size(); ++i) text += fmt::format(" {:>{}} |", cells[i], widths[i]);
    return text + "\n";
  };
  std::string text = line(table.columns) + "|";
  for (const std::size_t width : widths) text += fmt::format("{:->{}}:|", "", width + 1);
  text += "\n";
  for (const auto& row : table.rows) text += line(row);
  return text;
}

}  // namespace sidestep
