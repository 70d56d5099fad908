// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/client_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

namespace sidestep {

std::string client_text(ClientId client, const ClientName& name) {
  if (is_coordinator(client))
    return fmt::format("coordinator {}", client - static_cast<ClientId>(Sender::kCoordinator));
  switch (rank_of(client)) {
    case Rank::kOperator:
      return "operator";
    case Rank::kReferee:
      return "referee";
    case Rank::kScenario:
      return "scenario";
    case Rank::kClient:
      break;
  }
  const std::string text = to_text(name);
  return "client " + (text.empty() ? std::to_string(client) : text);
}

std::string client_phrase(ClientId client, const ClientName& name) {
  const bool is_named = rank_of(client) == Rank::kClient;
  return (is_named ? "" : "the ") + client_text(client, name);
}

std::string unknown_zone_text(std::uint32_t number, ClientId client, const ClientName& name,
                              const std::vector<Order>& zones) {
  std::set<std::string> known;
  for (const Order& zone : zones)
    known.insert(fmt::format("{} of {}", zone.zone_number, client_phrase(zone.client, zone.client_name)));
  return fmt::format("remove zone {}: refused, {} has no zone {}; {}", number, client_phrase(client, name),
                     number,
                     known.empty() ? "there are no zones" : fmt::format("zones: {}", fmt::join(known, ", ")));
}

}  // namespace sidestep
