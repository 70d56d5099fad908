// SPDX-License-Identifier: Apache-2.0
#include "common/yaml/yaml_document.hpp"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>
#include <yaml-cpp/eventhandler.h>

#include "common/file/read_file.hpp"
#include "common/yaml/config_error.hpp"
#include "common/yaml/yaml_merge.hpp"
#include "common/yaml/yaml_structure.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxValues = 400'000;

/// Records the line on which the last document began, and counts values. Every use of an anchor, and
/// every merge, counts as many values as the anchor has. yaml-cpp takes about half a kilobyte for each value.
class DocumentScanner : public YAML::EventHandler {
 public:
  int line = 1;
  bool has_merge_key = false;  ///< true also if other text contains "<<"

  explicit DocumentScanner(const std::string& file_name) : file_name_(file_name) {}

  void OnDocumentStart(const YAML::Mark& mark) override { line = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add_value(mark, anchor); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto is_it = [anchor](const auto& collection) { return collection.first == anchor; };
    if (std::ranges::any_of(open_, is_it))
      throw ConfigError(file_name_, mark.line + 1, "an anchor is used inside its own value");
    add(mark, values_of_[anchor]);
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                const std::string& text) override {
    has_merge_key |= text == "<<";
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
  std::vector<std::pair<YAML::anchor_t, std::size_t>>
      open_;  // open anchors, with the number of values before each
  // Number of values by anchor; 0 means no anchor.
  std::map<YAML::anchor_t, std::size_t> values_of_;
};

/// Whether the line, counted from 1, is indented by a tab. yaml-cpp reports other errors for such a line.
bool is_indented_by_tab(const std::string& text, int line) {
  std::istringstream stream(text);
  std::string content;
  for (int i = 0; i < line; ++i)
    if (!std::getline(stream, content)) return false;
  const std::size_t indentation = std::min(content.find_first_not_of(" \t"), content.size());
  return content.substr(0, indentation).find('\t') != std::string::npos;
}

/// The reason for an error on this line, counted from 1: an indentation by a tab, or else yaml-cpp's message.
std::string reason_of(const YAML::Exception& error, const std::string& text, int line) {
  return is_indented_by_tab(text, line) ? "a tab indents this line, expected spaces"
                                        : "not YAML: " + error.msg;
}

}  // namespace

std::string read_yaml_file(const std::string& path, const std::string& expected) {
  constexpr std::size_t kMaxBytes = 16'000'000;
  try {
    return read_file(path, kMaxBytes);
  } catch (const std::runtime_error& error) {
    throw ConfigError(path,
                      fmt::format("cannot read the file ({}), expected {} in YAML", error.what(), expected));
  }
}

// In yaml-cpp 0.7, Load() silently ignores all documents after the first, and LoadAll() does not return for
// some malformed files. Therefore the documents are counted first, stopping at the second.
YAML::Node parse_yaml(const std::string& text, const std::string& file_name, const std::string& expected) {
  check_yaml_structure(text, file_name, kMaxValues);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    DocumentScanner document(file_name);
    if (!parser.HandleNextDocument(document))
      throw ConfigError(file_name, 1, "the file is empty, expected " + expected);
    if (parser.HandleNextDocument(document)) {
      throw ConfigError(file_name, document.line,
                        "a second YAML document begins here, expected a single document");
    }
    const YAML::Node root = YAML::Load(text);
    if (document.has_merge_key) apply_merge_keys(root, file_name);
    return root;
  } catch (const YAML::Exception& error) {
    const int line = std::max(1, error.mark.line + 1);
    throw ConfigError(file_name, line, reason_of(error, text, line));
  }
}

}  // namespace sidestep
