// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/results_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

#include "deploy/simulate/campaign/campaign_summary.hpp"

namespace sidestep {

ResultsFile::ResultsFile(const std::string& path, const std::string& of_what) : path_(path) {
  const bool is_new = !std::filesystem::exists(path) || std::filesystem::file_size(path) == 0;
  if (!is_new) read(of_what);
  file_.reset(std::fopen(path.c_str(), "a"));
  if (!file_) throw std::runtime_error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  if (is_new) write(of_what);
}

void ResultsFile::read(const std::string& of_what) {
  std::ifstream in(path_);
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be read: {}", path_, std::strerror(errno)));
  std::uintmax_t whole = 0;  // bytes in lines that end
  std::string line;
  for (int number = 1; std::getline(in, line) && !in.eof(); ++number) {
    whole += line.size() + 1;
    if (number == 1 && line != of_what) {
      throw std::runtime_error(
          fmt::format("{}: holds results of another search: {}; this one is: {}", path_, line, of_what));
    }
    if (number == 1) continue;
    try {
      found_.push_back(result_from(line));
    } catch (const std::exception& error) {
      throw std::runtime_error(fmt::format("{}:{}: is no result: {}", path_, number, error.what()));
    }
  }
  if (whole == 0) throw std::runtime_error(fmt::format("{}: holds no results of a search", path_));
  in.close();
  std::filesystem::resize_file(path_, whole);
}

void ResultsFile::write(const std::string& line) {
  if (std::fputs((line + '\n').c_str(), file_.get()) < 0 || std::fflush(file_.get()) != 0)
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
}

void ResultsFile::add(const TrialResult& result) { write(to_line(result)); }

}  // namespace sidestep
