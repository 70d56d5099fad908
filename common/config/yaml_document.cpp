// SPDX-License-Identifier: Apache-2.0
#include "common/config/yaml_document.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <sstream>
#include <yaml-cpp/eventhandler.h>

#include "common/config/scenario_loader.hpp"

namespace sidestep {
namespace {

/// Remembers where the last document began.
class DocumentMarks : public YAML::EventHandler {
 public:
  int line = 1;

  void OnDocumentStart(const YAML::Mark& mark) override { line = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
  }
  void OnMapEnd() override {}
};

}  // namespace

std::string read_yaml_file(const std::string& path, const std::string& expected) {
  const auto refuse = [&](const std::string& why) {
    throw ScenarioError(path, 1,
                        fmt::format("cannot read the file ({}), expected {} in YAML", why, expected));
  };
  if (std::filesystem::is_directory(path)) refuse("a directory");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(std::strerror(errno));
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Load takes the first document and silently leaves the rest, and LoadAll never returns from some broken
// files (yaml-cpp 0.7): so the documents are counted to two at most.
YAML::Node parse_yaml(const std::string& text, const std::string& file_name, const std::string& expected) {
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    DocumentMarks marks;
    if (!parser.HandleNextDocument(marks))
      throw ScenarioError(file_name, 1, "the file is empty, expected " + expected);
    if (parser.HandleNextDocument(marks)) {
      throw ScenarioError(file_name, marks.line, "a second YAML document begins here, expected one");
    }
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ScenarioError(file_name, std::max(1, error.mark.line + 1), "not YAML: " + error.msg);
  }
}

}  // namespace sidestep
