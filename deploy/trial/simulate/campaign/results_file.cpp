// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/results_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
#include <sys/file.h>

namespace sidestep {

ResultsFile::ResultsFile(const std::string& path, const std::string& campaign) : path_(path) {
  file_ = open_output(path, WriteMode::kAppend);
  if (flock(fileno(file_.get()), LOCK_EX | LOCK_NB) != 0)
    throw std::runtime_error(fmt::format("{}: another campaign is writing to this file", path));
  if (std::filesystem::file_size(path) == 0)
    write(campaign);
  else
    read(campaign);
}

void ResultsFile::read(const std::string& campaign) {
  std::ifstream in(path_);
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be read: {}", path_, std::strerror(errno)));
  std::uintmax_t complete = 0;  // number of bytes in complete lines
  std::string line;
  for (int number = 1; std::getline(in, line) && !in.eof(); ++number) {
    complete += line.size() + 1;
    if (number == 1 && line != campaign) {
      throw std::runtime_error(
          fmt::format("{}: contains results of another campaign: {}; expected: {}", path_, line, campaign));
    }
    if (number == 1) continue;
    try {
      found_.push_back(parse_trial_result(line));
    } catch (const std::exception& error) {
      throw std::runtime_error(fmt::format("{}:{}: not a result: {}", path_, number, error.what()));
    }
  }
  if (complete == 0) throw std::runtime_error(fmt::format("{}: not a results file", path_));
  in.close();
  std::filesystem::resize_file(path_, complete);
}

void ResultsFile::write(const std::string& line) {
  if (std::fputs((line + '\n').c_str(), file_.get()) < 0 || std::fflush(file_.get()) != 0)
    throw_unwritable(path_, std::strerror(errno));
}

void ResultsFile::add(const TrialResult& result) { write(to_line(result)); }

}  // namespace sidestep
