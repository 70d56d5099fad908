// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <variant>

#include "deploy/monitor/record/mcap/mcap_format.hpp"

namespace sidestep {

/// A record that McapReader returns; std::monostate: the end of the file.
using McapRecord = std::variant<std::monostate, McapMessage, McapAttachment, McapMetadata>;

/// Reads an MCAP file from its beginning to its end. Its contents are not trusted. If the file is truncated,
/// all whole records before the cut are returned, also those of a chunk that is cut off.
class McapReader {
 public:
  static constexpr std::uint64_t kMaxRecordSize = 64 << 20;

  /// Throws std::runtime_error when the file cannot be read or is not an MCAP file.
  explicit McapReader(const std::string& path);

  /// Messages in the order of the file. After the end of the data, all that follows is checked, too.
  [[nodiscard]] McapRecord next();
  /// Ends reading soon: next() returns the end. Signal handlers and other threads may call it while next()
  /// passes over gigabytes that hold no message.
  void stop() { *is_stopped_ = true; }
  /// The share of the file that has been read, 0 to 1.
  double progress() const;
  /// Where the chunk of the last record begins in the file; 0: in no chunk yet.
  std::uint64_t chunk_offset() const { return chunk_offset_; }
  /// Continues at a chunk that another reader of the same file has found. From then on, the checksum of the
  /// whole file is not checked.
  void seek(const McapReader& known, std::uint64_t chunk_offset);
  /// Why the file ended early; empty: it did not, or has not ended yet.
  const std::string& damage() const { return damage_; }

  /// The channel of a message that was returned.
  const McapChannel& channel(const McapMessage& message) const { return channels_.at(message.channel); }
  /// nullptr: the channel has none.
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
  /// False: at the end of the file, or damaged.
  bool read_frame(Frame& frame);
  /// Why a chunk cannot be opened, given its header; empty: it can. `decoder` has read the header.
  std::string chunk_problem(const McapDecoder& decoder, std::uint64_t size, std::uint64_t stored_size,
                            const std::string& compression) const;
  bool open_chunk(std::span<const std::uint8_t> content);
  bool decompress(std::span<const std::uint8_t> compressed, std::uint64_t size);
  /// The next record of the open chunk of a kind that belongs there. False: the chunk has ended.
  bool read_chunk_frame(Frame& frame);
  McapRecord record_of(const Frame& frame);
  McapRecord message_of(std::span<const std::uint8_t> content);
  McapRecord attachment_of(std::span<const std::uint8_t> content);
  /// Whether what is kept until the end of the file has not become too large.
  bool may_keep(std::span<const std::uint8_t> content);
  void learn_schema(std::span<const std::uint8_t> content);
  void learn_channel(std::span<const std::uint8_t> content);
  void check_end(std::span<const std::uint8_t> data_end, std::uint32_t sum);
  /// Ends reading. Keeps the first reason.
  void fail(const std::string& damage);

  std::unique_ptr<std::FILE, Closer> file_;
  std::uint64_t file_bytes_ = 0;
  std::uint32_t checksum_ = 0;  // of all that was read
  McapBytes bytes_, chunk_;
  McapDecoder records_{{}};  // of the open chunk
  bool is_cut_ = false;      // the open chunk is the last that there is
  bool is_at_end_ = false;
  bool is_sought_ = false;
  std::unique_ptr<std::atomic<bool>> is_stopped_ = std::make_unique<std::atomic<bool>>(false);
  std::uint64_t chunk_offset_ = 0;
  std::string damage_;
  std::size_t kept_bytes_ = 0;  // of schemas and channels, also of those that were replaced
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
};

}  // namespace sidestep
