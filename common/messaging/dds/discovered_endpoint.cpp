// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/discovered_endpoint.hpp"

#include <fmt/core.h>
#include <fnmatch.h>

#include "common/file/utf8.hpp"

namespace sidestep {
namespace {

const char* word(bool is_reliable) { return is_reliable ? "reliable" : "best effort"; }

const char* word(DiscoveredEndpoint::Durability durability) {
  constexpr const char* kWords[] = {"volatile", "transient local", "transient", "persistent"};
  return kWords[static_cast<int>(durability)];
}

const char* word(DiscoveredEndpoint::Liveliness liveliness) {
  constexpr const char* kWords[] = {"automatic", "manual by participant", "manual by topic"};
  return kWords[static_cast<int>(liveliness)];
}

std::string duration_text(Duration d) {
  return d == Duration::max() ? std::string("no limit") : fmt::format("{:.3g} s", to_seconds(d));
}

/// Partition names may be patterns on either side (DDS 1.4, 2.2.3.13).
bool share_partition(const DiscoveredEndpoint& writer, const DiscoveredEndpoint& reader) {
  const std::vector<std::string> unnamed{""};
  for (const std::string& a : writer.partitions.empty() ? unnamed : writer.partitions) {
    for (const std::string& b : reader.partitions.empty() ? unnamed : reader.partitions) {
      if (fnmatch(a.c_str(), b.c_str(), 0) == 0 || fnmatch(b.c_str(), a.c_str(), 0) == 0) return true;
    }
  }
  return false;
}

}  // namespace

std::string announced_host(const std::string& announced) {
  return printable_line(announced.substr(0, announced.rfind(':')));
}

std::string qos_text(const DiscoveredEndpoint& endpoint) {
  std::string text =
      fmt::format("{}, {}, {}, ownership {}, deadline {}, liveliness {} (lease {})",
                  word(endpoint.is_reliable), word(endpoint.durability),
                  endpoint.is_keyed ? "keyed" : "without key", endpoint.is_exclusive ? "exclusive" : "shared",
                  duration_text(endpoint.deadline), word(endpoint.liveliness), duration_text(endpoint.lease));
  for (const std::string& partition : endpoint.partitions) text += ", partition " + partition;
  return text;
}

std::vector<std::string> qos_mismatches(const DiscoveredEndpoint& writer, const DiscoveredEndpoint& reader) {
  std::vector<std::string> result;
  const auto differ = [&](const char* policy, const std::string& requested, const std::string& offered) {
    result.push_back(
        fmt::format("{}: the reader requests {}, the writer offers {}", policy, requested, offered));
  };
  if (reader.type != writer.type) differ("type", reader.type, writer.type);
  if (reader.is_keyed != writer.is_keyed) {
    differ("key", reader.is_keyed ? "a key" : "none", writer.is_keyed ? "a key" : "none");
  }
  if (reader.is_reliable && !writer.is_reliable) differ("reliability", word(true), word(false));
  if (reader.durability > writer.durability)
    differ("durability", word(reader.durability), word(writer.durability));
  if (reader.liveliness > writer.liveliness)
    differ("liveliness", word(reader.liveliness), word(writer.liveliness));
  if (reader.lease < writer.lease)
    differ("liveliness lease", duration_text(reader.lease), duration_text(writer.lease));
  if (reader.deadline < writer.deadline)
    differ("deadline", duration_text(reader.deadline), duration_text(writer.deadline));
  if (reader.is_exclusive != writer.is_exclusive) {
    differ("ownership", reader.is_exclusive ? "exclusive" : "shared",
           writer.is_exclusive ? "exclusive" : "shared");
  }
  if (!share_partition(writer, reader)) result.emplace_back("partition: no name in common");
  return result;
}

}  // namespace sidestep
