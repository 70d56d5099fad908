// SPDX-License-Identifier: Apache-2.0
#include "common/process/output_paths.hpp"

#include <filesystem>
#include <fmt/format.h>

#include "common/process/command_line.hpp"

namespace sidestep {
namespace {

namespace fs = std::filesystem;

/// Whether the paths name the same file, even if it does not exist yet.
bool is_same_file(const std::string& first, const std::string& second) {
  std::error_code error;
  if (fs::exists(first, error) && fs::exists(second, error))
    return fs::equivalent(first, second, error) && !fs::is_character_file(first, error);
  const auto full = [&error](const std::string& path) {
    const fs::path absolute = fs::absolute(path, error), canonical = fs::weakly_canonical(absolute, error);
    return error ? absolute.lexically_normal() : canonical;
  };
  return full(first) == full(second);
}

}  // namespace

void require_separate_outputs(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs) {
  std::vector<NamedPath> others = inputs;
  for (const NamedPath& output : outputs) {
    if (output.path.empty()) continue;
    for (const NamedPath& other : others) {
      if (!other.path.empty() && is_same_file(output.path, other.path))
        throw UsageError(fmt::format("{}: {} is the same file as {}", output.name, output.path, other.name));
    }
    others.push_back(output);
  }
}

void require_new_output(const NamedPath& output, bool may_overwrite) {
  std::error_code error;
  if (may_overwrite || !fs::is_regular_file(output.path, error) || fs::file_size(output.path, error) == 0)
    return;
  throw UsageError(fmt::format("{}: {} exists; --force overwrites it", output.name, output.path));
}

}  // namespace sidestep
