// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace sidestep {

/// A summary of an MCAP file that any program has written.
struct BagInfo {
  struct Channel {
    std::string type;
    std::uint64_t messages = 0, bytes = 0;  // bytes: total size of the payloads
    std::uint64_t first_ns = 0, last_ns = 0;
  };
  std::map<std::string, Channel> channels;  ///< indexed by topic
  std::vector<std::string> attachments;     ///< for example "map.pgm (image/x-portable-graymap), 3,000 bytes"
  std::map<std::string, std::string> metadata;
  std::vector<std::string> events;  ///< for example "12.345 s: bookmark: here"
  std::uint64_t file_bytes = 0, messages = 0;
  std::uint64_t first_ns = 0, last_ns = 0;  ///< times of the first and the last message
  std::string damage;                       ///< why the file ended prematurely; empty if it did not
};

/// Reads a file. This and the functions below throw std::runtime_error if a file cannot be accessed.
[[nodiscard]] BagInfo bag_info(const std::string& path);
/// Formats the information as a table.
[[nodiscard]] std::string to_text(const BagInfo& info);

struct BagCut {
  double from_s = 0;  ///< begin, relative to the first message
  double to_s = std::numeric_limits<double>::infinity();
  std::set<std::string>
      topics;  ///< for example truth, feedback/3, or feedback for the channels of all robots; empty: all
};

/// Copies a part of a file's messages, and everything that is not a message, to another file. Returns a
/// description of damage to the file, or an empty text; everything before the damage is used. Throws
/// std::invalid_argument, and writes nothing, if that part has no message.
std::string cut_bag(const std::string& path, const BagCut& cut, const std::string& out);

/// Merges files in the order of the reception times of their messages. Throws std::invalid_argument if they
/// are recordings of different scenarios. Returns a description of damage to the files, or an empty text.
std::string merge_bags(const std::vector<std::string>& paths, const std::string& out);

}  // namespace sidestep
