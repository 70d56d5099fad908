// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fnmatch.h>

#include "common/messaging/dds/listen.hpp"

namespace sidestep {
namespace {

const char* word(bool is_reliable) { return is_reliable ? "reliable" : "best effort"; }

const char* word(DdsEndpoint::Durability durability) {
  constexpr const char* kWords[] = {"volatile", "transient local", "transient", "persistent"};
  return kWords[static_cast<int>(durability)];
}

const char* word(DdsEndpoint::Liveliness liveliness) {
  constexpr const char* kWords[] = {"automatic", "manual by participant", "manual by topic"};
  return kWords[static_cast<int>(liveliness)];
}

std::string in_words(Duration d) {
  return d == Duration::max() ? std::string("no limit") : fmt::format("{:.3g} s", to_seconds(d));
}

/// Partition names may be patterns on either side (DDS 1.4, 2.2.3.13).
bool partitions_meet(const DdsEndpoint& writer, const DdsEndpoint& reader) {
  const std::vector<std::string> unnamed{""};
  for (const std::string& a : writer.partitions.empty() ? unnamed : writer.partitions) {
    for (const std::string& b : reader.partitions.empty() ? unnamed : reader.partitions) {
      if (fnmatch(a.c_str(), b.c_str(), 0) == 0 || fnmatch(b.c_str(), a.c_str(), 0) == 0) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::string> dds_mismatches(const DdsEndpoint& writer, const DdsEndpoint& reader) {
  std::vector<std::string> result;
  const auto differ = [&](const char* policy, const std::string& wanted, const std::string& offered) {
    result.push_back(fmt::format("{}: the reader wants {}, the writer offers {}", policy, wanted, offered));
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
  if (reader.lease < writer.lease) differ("liveliness lease", in_words(reader.lease), in_words(writer.lease));
  if (reader.deadline < writer.deadline)
    differ("deadline", in_words(reader.deadline), in_words(writer.deadline));
  if (reader.is_exclusive != writer.is_exclusive) {
    differ("ownership", reader.is_exclusive ? "exclusive" : "shared",
           writer.is_exclusive ? "exclusive" : "shared");
  }
  if (!partitions_meet(writer, reader)) result.push_back("partition: no name in common");
  return result;
}

}  // namespace sidestep
