// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/file/output_file.hpp"
#include "deploy/inspect/record/mcap/mcap_format.hpp"

struct ZSTD_CCtx_s;

namespace sidestep {

struct McapWriterSettings {
  bool is_compressed = false;                  ///< with zstd
  std::uint64_t max_chunk_ns = 1'000'000'000;  ///< maximum duration of the messages in a chunk
  std::size_t chunk_bytes = 1 << 20;           ///< a chunk ends with the message that reaches this size
};

/// Writes an MCAP file: messages in chunks, each with an index, and a summary at the end. A chunk's messages
/// are in the file once the chunk has ended, even if the process is killed afterwards. When a write fails,
/// for example because the disk is full, the file ends after the last complete chunk, and the rest is
/// discarded.
class McapWriter {
 public:
  /// Throws std::runtime_error with the reason if the file cannot be written.
  explicit McapWriter(const std::string& path, const McapWriterSettings& settings = {});
  ~McapWriter();
  McapWriter(McapWriter&&) noexcept;
  McapWriter& operator=(McapWriter&&) noexcept;

  /// Returns the id. Throws std::length_error if all 65,535 ids are taken.
  std::uint16_t add_schema(McapSchema schema);
  std::uint16_t add_channel(McapChannel channel);
  /// Messages should be added in the order of their logged times. `append_payload` appends the payload to the
  /// bytes passed to it.
  template <typename Append>
  void add_message(const McapMessage& message, Append append_payload) {
    begin_message(message);
    McapEncoder(chunk_.records).record(McapRecordKind::kMessage, [&] {
      append_message_head(message);
      append_payload(chunk_.records);
    });
    if (chunk_.records.size() >= settings_.chunk_bytes) end_chunk();
  }
  void add_attachment(const McapAttachment& attachment);
  void add_metadata(const McapMetadata& metadata);
  /// Writes the messages that have been added so far to the file.
  void end_chunk();

  /// Calls back with the path and the reason when a write fails for the first time; immediately if a write
  /// has already failed.
  void on_failure(std::function<void(const std::string& failure)> callback);
  /// Empty unless a write has failed.
  const std::string& failure() const { return failure_; }
  std::uint64_t messages() const { return messages_; }
  /// Writes the summary. Anything added afterwards is discarded. Throws std::runtime_error if any write has
  /// failed.
  void close();

 private:
  struct ContextDeleter {
    void operator()(ZSTD_CCtx_s* context) const;
  };
  struct IndexEntry {
    std::uint64_t logged_ns, offset;
  };
  struct Chunk {
    McapBytes records;
    std::vector<std::vector<IndexEntry>> index;  // indexed by channel
    std::uint64_t messages = 0, begin_ns = 0, end_ns = 0;
  };

  void begin_message(const McapMessage& message);
  void append_message_head(const McapMessage& message);
  void append_schema(McapBytes& bytes, std::uint16_t id) const;
  void append_channel(McapBytes& bytes, std::uint16_t id) const;
  void append_statistics(McapBytes& bytes) const;
  std::span<const std::uint8_t> compressed(std::span<const std::uint8_t> records);
  /// Returns the channels of the chunk's messages, each with the offset of its index in the file.
  McapBytes write_message_index();
  /// Everything written so far stays in the file if a later write fails.
  void keep();
  void note_failure();
  /// Writes bytes to the file and counts them.
  void write(std::span<const std::uint8_t> bytes);

  std::string path_;
  McapWriterSettings settings_;
  OutputFile file_;
  std::unique_ptr<ZSTD_CCtx_s, ContextDeleter> compressor_;
  std::uint64_t size_ = 0;
  std::uint32_t checksum_ = 0;  // checksum of everything written
  std::uint64_t kept_bytes_ = 0, kept_messages_ = 0;
  std::string failure_;  // reason of the first failed write; empty: none
  std::function<void(const std::string&)> on_failure_;
  Chunk chunk_;
  McapBytes compressed_;
  std::vector<McapSchema> schemas_;    // indexed by id - 1
  std::vector<McapChannel> channels_;  // indexed by id
  std::vector<std::uint64_t> counts_;  // number of messages, indexed by channel
  std::uint64_t messages_ = 0, begin_ns_ = 0, end_ns_ = 0;
  McapBytes chunk_indices_, attachment_indices_, metadata_indices_;
  std::uint32_t chunks_ = 0, attachments_ = 0, metadata_ = 0;
};

}  // namespace sidestep
