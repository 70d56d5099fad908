// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/server/viewer_json.hpp"

#include <nlohmann/json.hpp>

namespace sidestep {

nlohmann::json parse_viewer_json(const std::string& text) {
  using Json = nlohmann::json;
  bool is_too_deep = false;
  const auto keep = [&](int depth, Json::parse_event_t, Json&) {
    is_too_deep = is_too_deep || depth > kMaxViewerJsonDepth;
    return !is_too_deep;
  };
  Json json = Json::parse(text, keep, false);
  return is_too_deep ? Json(Json::value_t::discarded) : json;
}

}  // namespace sidestep
