// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/file/output_file.hpp"
#include "common/league/decode_error.hpp"
#include "common/time/time.hpp"

namespace sidestep::league {

/// The packet types of a log, with their numbers in the file.
enum class LogType : std::int32_t {
  kVision2010 = 2,  ///< vision packets with the geometry format of 2010
  kReferee = 3,
  kVision = 4,
  kTracked = 5
};

/// A packet and its time of arrival.
struct LogRecord {
  Time received{};
  LogType type = LogType::kVision;
  std::vector<std::byte> bytes;
};

enum class LogStatus {
  kReading,
  kComplete,   ///< the file ends after a complete record
  kTruncated,  ///< the file ends within a record, for example because its writer died
  kCorrupt     ///< the next bytes are not a record
};

/// Reads a log of version 1 sequentially. Accepts arbitrary content: an invalid record ends the reading, and
/// the records before it are valid.
class LogReader {
 public:
  /// Throws std::runtime_error if the file cannot be read or is not a log of this version.
  explicit LogReader(const std::string& path);
  /// Reads a log from a seekable stream; `name` prefixes error messages.
  LogReader(std::unique_ptr<std::istream> stream, std::string name);

  /// Reads the next record, skipping unknown types. False at the end.
  [[nodiscard]] bool next(LogRecord& record);
  /// Positions the reader before the first record that was received at least `after_first` later than the
  /// file's first record. False if there is none.
  [[nodiscard]] bool seek(Duration after_first);
  LogStatus status() const { return status_; }
  /// Why the log is truncated or corrupt, as "FILE: byte 28: ..."; else empty.
  const std::string& error() const { return error_; }

 private:
  struct RecordHeader {
    std::int64_t received_ns;
    std::int32_t type;
    std::int32_t size;
  };
  void read_magic();
  void rewind();
  std::optional<RecordHeader> read_header();
  bool skip(std::int32_t size);
  bool read(std::byte* to, std::size_t size);
  void finish(LogStatus status, const std::string& why);

  std::unique_ptr<std::istream> stream_;
  std::string name_;
  std::int64_t offset_ = 0;           ///< number of bytes read so far
  std::int64_t record_offset_ = 0;    ///< offset of the current record
  std::optional<LogRecord> pending_;  ///< already read; returned by the next call of next()
  LogStatus status_ = LogStatus::kReading;
  std::string error_;
};

/// Writes a log of version 1. Each record is in the file as soon as it has been added. If one cannot be
/// written, for example because the disk is full, the file ends after the previous one.
class LogWriter {
 public:
  /// Throws std::runtime_error if the file cannot be written.
  explicit LogWriter(const std::string& path);

  /// Throws std::runtime_error if the record cannot be written; add none after that. Precondition: at most
  /// kMaxDatagramSize bytes.
  void add(Time received, LogType type, std::span<const std::byte> bytes);
  std::uint64_t records() const { return records_; }
  /// Throws std::runtime_error if the file system reports an error only now.
  void close();

 private:
  void write(std::span<const char> bytes);

  std::string path_;
  OutputFile file_;
  std::uint64_t size_ = 0, records_ = 0;
};

}  // namespace sidestep::league
