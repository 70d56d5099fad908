// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

/// A writer or reader that a participant in the domain has announced. The participant's software may be of
/// any vendor.
struct DiscoveredEndpoint {
  enum class Durability : std::uint8_t { kVolatile, kTransientLocal, kTransient, kPersistent };
  enum class Liveliness : std::uint8_t { kAutomatic, kByParticipant, kByTopic };

  std::string guid;
  std::string participant;  ///< name of the endpoint's participant
  std::string host = {};    ///< name of its host; empty if it does not announce one
  std::string topic;
  std::string type;
  bool is_writer = false;
  bool is_keyed = false;
  bool is_reliable = false;
  bool is_exclusive = false;  ///< whether ownership is exclusive
  Durability durability = Durability::kVolatile;
  Liveliness liveliness = Liveliness::kAutomatic;
  Duration lease = Duration::max();  ///< lease duration of its liveliness
  Duration deadline = Duration::max();
  std::vector<std::string> partitions;  ///< empty: the unnamed partition
};

/// What a participant announces about its process.
struct AnnouncedProcess {
  std::string name;  ///< name of the participant
  std::string host;  ///< name of its host; empty if it does not announce one
};

/// The host's name in what Fast DDS announces, which is "name:number", as one printable line.
[[nodiscard]] std::string announced_host(const std::string& announced);

/// What discovery reports about an endpoint: discovered, changed or gone.
enum class EndpointChange : std::uint8_t { kDiscovered, kChanged, kGone };

/// Lists all policies of an endpoint, for example "best effort, volatile, keyed, liveliness automatic (no
/// limit), …".
[[nodiscard]] std::string qos_text(const DiscoveredEndpoint& endpoint);

/// The reasons why this writer and this reader of one topic do not match, in plain words; empty if they
/// match.
[[nodiscard]] std::vector<std::string> qos_mismatches(const DiscoveredEndpoint& writer,
                                                      const DiscoveredEndpoint& reader);

}  // namespace sidestep
