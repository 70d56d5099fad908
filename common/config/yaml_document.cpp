// SPDX-License-Identifier: Apache-2.0
#include "common/config/yaml_document.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <sstream>
#include <stdexcept>
#include <yaml-cpp/eventhandler.h>

#include "common/config/config_error.hpp"
#include "common/file/read_file.hpp"

namespace sidestep {
namespace {

/// Records the line on which the last document began.
class DocumentLine : public YAML::EventHandler {
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
    DocumentLine document;
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
