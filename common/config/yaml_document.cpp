// SPDX-License-Identifier: Apache-2.0
#include "common/config/yaml_document.hpp"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>
#include <yaml-cpp/eventhandler.h>

#include "common/config/config_error.hpp"
#include "common/file/read_file.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxValues = 400'000;

/// Records the line on which the last document began, and counts values: each use of an anchor as often as
/// what it stands for has values. yaml-cpp takes about half a kilobyte for each.
class FirstReading : public YAML::EventHandler {
 public:
  int line = 1;

  explicit FirstReading(const std::string& file_name) : file_name_(file_name) {}

  void OnDocumentStart(const YAML::Mark& mark) override { line = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add_value(mark, anchor); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(mark, values_of_[anchor]); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                const std::string&) override {
    add_value(mark, anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(mark, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(mark, anchor);
  }
  void OnMapEnd() override { end(); }

 private:
  void add(const YAML::Mark& mark, std::size_t values) {
    values_ += values;
    if (values_ > kMaxValues)
      throw ConfigError(file_name_, mark.line + 1, fmt::format("more than {} values", kMaxValues));
  }
  void add_value(const YAML::Mark& mark, YAML::anchor_t anchor) {
    add(mark, 1);
    values_of_[anchor] = 1;
  }
  void begin(const YAML::Mark& mark, YAML::anchor_t anchor) {
    open_.emplace_back(anchor, values_);
    add(mark, 1);
  }
  void end() {
    const auto [anchor, before] = open_.back();
    open_.pop_back();
    values_of_[anchor] = values_ - before;
  }

  const std::string& file_name_;
  std::size_t values_ = 0;
  std::vector<std::pair<YAML::anchor_t, std::size_t>> open_;  // collections, and the values before each
  std::map<YAML::anchor_t, std::size_t> values_of_;           // by anchor; 0 stands for none
};

}  // namespace

std::string read_yaml_file(const std::string& path, const std::string& expected) {
  constexpr std::size_t kMaxBytes = 16'000'000;
  try {
    return read_file(path, kMaxBytes);
  } catch (const std::runtime_error& error) {
    throw ConfigError(path, 1,
                      fmt::format("cannot read the file ({}), expected {} in YAML", error.what(), expected));
  }
}

// In yaml-cpp 0.7, Load silently ignores all documents after the first, and LoadAll does not return for some
// malformed files. So the documents are counted first, up to the second.
YAML::Node parse_yaml(const std::string& text, const std::string& file_name, const std::string& expected) {
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    FirstReading document(file_name);
    if (!parser.HandleNextDocument(document))
      throw ConfigError(file_name, 1, "the file is empty, expected " + expected);
    if (parser.HandleNextDocument(document)) {
      throw ConfigError(file_name, document.line,
                        "a second YAML document begins here, expected a single document");
    }
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ConfigError(file_name, std::max(1, error.mark.line + 1), "not YAML: " + error.msg);
  }
}

}  // namespace sidestep
