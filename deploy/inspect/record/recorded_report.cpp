// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/recorded_report.hpp"

#include <variant>

#include "deploy/inspect/record/mcap/mcap_reader.hpp"
#include "deploy/inspect/record/recording.hpp"

namespace sidestep {

std::optional<std::string> recorded_report(const std::string& path) {
  McapReader reader(path);
  std::optional<std::string> text;
  for (McapRecord record = reader.next(); !std::holds_alternative<std::monostate>(record);
       record = reader.next())
    if (const auto* attachment = std::get_if<McapAttachment>(&record);
        attachment && attachment->name == kReportFile)
      text = std::string(attachment->content.begin(), attachment->content.end());
  return text;
}

}  // namespace sidestep
