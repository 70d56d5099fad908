// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/network_view.hpp"

#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "common/messaging/dds/listener.hpp"
#include "deploy/inspect/topic/graph.hpp"

namespace sidestep {

NetworkView::NetworkView(const DdsSettings& dds) : dds_(dds) { dds_.participant += "-discovery"; }

NetworkView::~NetworkView() = default;

std::string NetworkView::json() {
  if (!listener_) listener_ = std::make_unique<DdsListener>(dds_);
  const ProcessGraph graph = graph_of(listener_->endpoints());
  nlohmann::ordered_json hosts = nlohmann::ordered_json::array();
  for (const ProcessGraph::Process& process : graph.processes) {
    if (hosts.empty() || hosts.back().at("host") != process.host)
      hosts.push_back({{"host", process.host}, {"participants", nlohmann::ordered_json::array()}});
    hosts.back()["participants"].push_back(process.name);
  }
  const nlohmann::ordered_json json{{"hosts", hosts}, {"mismatches", graph.mismatches}};
  return json_text(json);
}

}  // namespace sidestep
