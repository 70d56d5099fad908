// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/page/report_command.hpp"

#include <csignal>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "common/file/console.hpp"
#include "common/file/read_file.hpp"
#include "common/file/write_file.hpp"
#include "common/json/json_text.hpp"
#include "common/process/output_paths.hpp"
#include "deploy/audit/page/report_page.hpp"
#include "deploy/audit/picture/run_picture.hpp"
#include "deploy/inspect/record/recorded_report.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxBytes = 256 << 20;

struct ReportOptions {
  std::string file;
  std::optional<std::string> page_file;  ///< empty: named after the report
  std::string picture_file;
};

/// The text of a report, or of the report in a recording.
std::string text_of(const std::string& file) {
  if (file.ends_with(".mcap")) {
    if (const auto text = recorded_report(file)) return *text;
    throw std::invalid_argument(fmt::format(
        "{}: the recording has no report; `run` and `simulate` add one at the end of the run", file));
  }
  try {
    return read_file(file, kMaxBytes);
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(fmt::format("{}: cannot read the report ({})", file, error.what()));
  }
}

/// The page's file; empty: none is wanted.
std::string page_file_of(const ReportOptions& options) {
  if (!options.page_file || !options.page_file->empty()) return options.page_file.value_or("");
  return std::filesystem::path(options.file).replace_extension(".html").string();
}

int show_report(const ReportOptions& options) {
  // The page is written even if the reader of the output disappears.
  std::signal(SIGPIPE, SIG_IGN);
  const std::string page_file = page_file_of(options);
  require_separate_outputs({{"FILE", options.file}},
                           {{"--html", page_file}, {"--svg", options.picture_file}});
  const Json report = parse_ordered_json(text_of(options.file), false);
  if (report.is_discarded()) throw std::invalid_argument(options.file + ": is not JSON");
  try {
    const int error = write_text(stdout, report_text(report));
    if (!page_file.empty()) {
      write_file(page_file, report_page(report));
      print_to(stdout, "page: {}\n", page_file);
    }
    if (!options.picture_file.empty()) {
      write_file(options.picture_file, run_picture(report));
      print_to(stdout, "picture: {}\n", options.picture_file);
    }
    require_printed(error);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", options.file, error.what()));
  }
  return 0;
}

}  // namespace

void add_report_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<ReportOptions>();
  const CliCommand command = root.add_subcommand(
      "report", "Shows the report of a run as text, as a page for a browser, or as a picture");
  command
      .add_option("FILE", options->file,
                  "report, e.g. reports/crossing-1.json; or a recording of `run` or `simulate` (.mcap)")
      .required();
  command.add_optional_value("--html", options->page_file, "",
                             "write a page that needs no other file: verdict, paths, speeds, latencies, "
                             "events; an earlier file is replaced "
                             "[FILE with the ending .html]");
  command.add_option(
      "--svg", options->picture_file,
      "draw the robots' paths to this SVG file, which plays in a browser; an earlier file is replaced");
  command.on_parsed([options, &action] { action = [options] { return show_report(*options); }; });
}

}  // namespace sidestep
