// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <istream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/league/refusal.hpp"
#include "common/time/time.hpp"

namespace sidestep::league {

/// The packets that a log holds, by the numbers that they have in the file.
enum class LogType : std::int32_t {
  kVision2010 = 2,  ///< with the geometry of that year
  kReferee = 3,
  kVision = 4,
  kTracked = 5
};

/// One packet, and when it was received.
struct LogRecord {
  Time received{};
  LogType type = LogType::kVision;
  std::vector<std::byte> bytes;
};

enum class LogEnd {
  kNotYet,
  kWhole,   ///< the file ends where a record ends
  kCutOff,  ///< the file ends within a record, as when its writer died
  kDamaged  ///< what comes next is no record
};

/// Reads a log of version 1 from its front, one record at a time. Whatever is in the file, nothing worse
/// happens than that the reading ends; what came before is good.
class LogReader {
 public:
  /// Throws std::runtime_error, saying where the file is no log of this version or why it cannot be read.
  explicit LogReader(const std::string& path);
  /// The same from any stream that can be rewound; `name` stands before what is said about it.
  LogReader(std::unique_ptr<std::istream> stream, std::string name);

  /// False at the end. Records of other types are skipped.
  bool next(LogRecord& record);
  /// The record that comes next is the first that was received so long or longer after the file's first one;
  /// false when there is none.
  bool seek(Duration after_first);
  LogEnd end() const { return end_; }
  /// Of an end that is not whole, what is wrong: "FILE: byte 28: ..."; else empty.
  const std::string& damage() const { return damage_; }
  /// Records so far of types that are not in LogType.
  std::uint64_t skipped() const { return skipped_; }

 private:
  struct Head {
    std::int64_t received_ns;
    std::int32_t type;
    std::int32_t size;
  };
  void read_magic();
  void rewind();
  std::optional<Head> read_head();
  bool skip(std::int32_t size);
  bool read(std::byte* to, std::size_t size);
  void finish(LogEnd end, const std::string& why);

  std::unique_ptr<std::istream> stream_;
  std::string name_;
  std::int64_t offset_ = 0;        ///< bytes taken so far
  std::int64_t record_at_ = 0;     ///< where the record begins that is being read
  std::optional<LogRecord> held_;  ///< read already, and to be given next
  LogEnd end_ = LogEnd::kNotYet;
  std::string damage_;
  std::uint64_t skipped_ = 0;
};

/// Writes a log of version 1.
class LogWriter {
 public:
  /// Throws std::runtime_error, saying why the file cannot be written.
  explicit LogWriter(const std::string& path);

  /// Precondition: no longer than a datagram.
  void add(Time received, LogType type, std::span<const std::byte> bytes);
  std::uint64_t records() const { return records_; }
  /// Writes out what is still in memory; throws std::runtime_error when not all of it could be written.
  void close();

 private:
  std::string path_;
  std::ofstream file_;
  std::uint64_t records_ = 0;
};

}  // namespace sidestep::league
