// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <variant>

#include "deploy/inspect/record/mcap/mcap_format.hpp"

namespace sidestep {

/// A record that McapReader returns; std::monostate at the end of the file.
using McapRecord = std::variant<std::monostate, McapMessage, McapAttachment, McapMetadata>;

/// Whether a file begins as MCAP files do. False also if it cannot be read.
[[nodiscard]] bool is_mcap_file(const std::string& path);

/// Reads an MCAP file from its beginning to its end. Its contents are not trusted. If the file is truncated,
/// all complete records before the cut are returned, including those in a truncated chunk.
class McapReader {
 public:
  static constexpr std::uint64_t kMaxRecordSize = 64 << 20;

  /// Throws std::runtime_error if the file cannot be read or is not an MCAP file.
  explicit McapReader(const std::string& path);

  /// The next record; messages come in the order of the file. After the end of the data, also checks the rest
  /// of the file.
  [[nodiscard]] McapRecord next();
  /// Ends reading soon: next() returns the end. May be called from signal handlers and other threads while
  /// next() skips gigabytes without messages.
  void stop() { *is_stopped_ = true; }
  /// The fraction of the file that has been read, 0 to 1.
  double progress() const;
  /// The file offset of the chunk of the last record; 0 before the first chunk.
  std::uint64_t chunk_offset() const { return chunk_offset_; }
  /// Continues at a chunk found by another reader of the same file. From then on, the checksum of the whole
  /// file is not checked.
  void seek(const McapReader& known, std::uint64_t chunk_offset);
  /// Why the file ended prematurely; empty if it did not, or has not ended yet.
  const std::string& damage() const { return damage_; }

  /// The channel of a returned message.
  const McapChannel& channel(const McapMessage& message) const { return channels_.at(message.channel); }
  /// The channel's schema; nullptr if it has none.
  const McapSchema* schema(const McapChannel& channel) const;

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  struct Frame {
    McapRecordKind kind{};
    std::span<const std::uint8_t> content{};
  };

  /// Reads bytes of the file; the result is shorter at the end of the file.
  std::span<const std::uint8_t> read(std::size_t size);
  /// Reads a record's kind and size. False at the end of the file, or if it is damaged.
  bool read_frame(Frame& frame);
  /// Why a chunk cannot be opened, given its header; empty if it can. `decoder` has already read the header.
  std::string chunk_problem(const McapDecoder& decoder, std::uint64_t size, std::uint64_t stored_size,
                            const std::string& compression) const;
  bool open_chunk(std::span<const std::uint8_t> content);
  bool decompress(std::span<const std::uint8_t> compressed, std::uint64_t size);
  /// The next record of the open chunk. False: the chunk has ended, or is damaged by a record of a kind that
  /// does not belong there.
  bool read_chunk_frame(Frame& frame);
  McapRecord record_of(const Frame& frame);
  McapRecord message_of(std::span<const std::uint8_t> content);
  McapRecord attachment_of(std::span<const std::uint8_t> content);
  /// Counts data that must be kept until the end of the file. Beyond the limit, calls fail() and returns
  /// false.
  bool count_kept(std::span<const std::uint8_t> content);
  void learn_schema(std::span<const std::uint8_t> content);
  void learn_channel(std::span<const std::uint8_t> content);
  void check_end(std::span<const std::uint8_t> data_end, std::uint32_t sum);
  /// Ends reading. If called again, keeps the first reason.
  void fail(const std::string& damage);

  std::unique_ptr<std::FILE, Closer> file_;
  std::uint64_t file_bytes_ = 0;
  std::uint32_t checksum_ = 0;  // checksum of everything read
  McapBytes bytes_, chunk_;
  McapDecoder records_{{}};  // records of the open chunk
  bool is_cut_ = false;      // the file ends within the open chunk
  bool is_at_end_ = false;
  bool was_seek_called_ = false;
  std::unique_ptr<std::atomic<bool>> is_stopped_ = std::make_unique<std::atomic<bool>>(false);
  std::uint64_t chunk_offset_ = 0;
  std::string damage_;
  std::size_t kept_bytes_ = 0;  // size of schemas and channels, including replaced ones
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
};

}  // namespace sidestep
