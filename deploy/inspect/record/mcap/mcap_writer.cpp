// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/mcap/mcap_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>
#include <unistd.h>
#include <utility>
#include <zstd.h>

namespace sidestep {
namespace {

using Kind = McapRecordKind;

constexpr std::size_t kMaxId = std::numeric_limits<std::uint16_t>::max();
constexpr int kCompressionLevel = 1;

}  // namespace

void McapWriter::ContextDeleter::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }

McapWriter::McapWriter(const std::string& path, const McapWriterSettings& settings)
    : path_(path), settings_(settings), file_(open_output(path)) {
  // Without a buffer, nothing is written after a failure.
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);
  if (settings.is_compressed) compressor_.reset(ZSTD_createCCtx());
  McapBytes bytes(kMcapMagic.begin(), kMcapMagic.end());
  McapEncoder encoder(bytes);
  encoder.record(Kind::kHeader, [&] {
    encoder.text("");
    encoder.text("sidestep");
  });
  write(bytes);
  keep();
}

McapWriter::~McapWriter() = default;
McapWriter::McapWriter(McapWriter&&) noexcept = default;
McapWriter& McapWriter::operator=(McapWriter&&) noexcept = default;

void McapWriter::on_failure(std::function<void(const std::string&)> callback) {
  on_failure_ = std::move(callback);
  if (!failure_.empty()) on_failure_(failure_);
}

void McapWriter::keep() {
  if (!failure_.empty()) return;
  kept_bytes_ = size_;
  kept_messages_ = messages_;
}

void McapWriter::note_failure() {
  if (!failure_.empty()) return;
  const std::string kept =
      kept_messages_ > 0 ? fmt::format("; the recording ends after {} messages", kept_messages_) : "";
  failure_ = fmt::format("{}: {}{}", path_, std::strerror(errno), kept);
  // Removes the incomplete record. Devices and pipes cannot be shortened.
  if (file_) (void)!ftruncate(fileno(file_.get()), static_cast<off_t>(kept_bytes_));
  if (on_failure_) on_failure_(failure_);
}

void McapWriter::write(std::span<const std::uint8_t> bytes) {
  if (!file_) return;
  if (failure_.empty() && std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    note_failure();
  size_ += bytes.size();
  checksum_ = mcap_checksum(bytes, checksum_);
}

std::uint16_t McapWriter::add_schema(McapSchema schema) {
  if (schemas_.size() >= kMaxId) throw std::length_error(path_ + ": too many schemas");
  schemas_.push_back(std::move(schema));
  const auto id = static_cast<std::uint16_t>(schemas_.size());
  append_schema(chunk_.records, id);
  return id;
}

std::uint16_t McapWriter::add_channel(McapChannel channel) {
  if (channels_.size() >= kMaxId) throw std::length_error(path_ + ": too many channels");
  const auto id = static_cast<std::uint16_t>(channels_.size());
  channels_.push_back(std::move(channel));
  counts_.push_back(0);
  append_channel(chunk_.records, id);
  return id;
}

void McapWriter::begin_message(const McapMessage& message) {
  if (chunk_.messages > 0 && message.logged_ns >= chunk_.begin_ns + settings_.max_chunk_ns) end_chunk();
  if (chunk_.messages == 0) chunk_.begin_ns = chunk_.end_ns = message.logged_ns;
  chunk_.begin_ns = std::min(chunk_.begin_ns, message.logged_ns);
  chunk_.end_ns = std::max(chunk_.end_ns, message.logged_ns);
  if (messages_ == 0) begin_ns_ = end_ns_ = message.logged_ns;
  begin_ns_ = std::min(begin_ns_, message.logged_ns);
  end_ns_ = std::max(end_ns_, message.logged_ns);
  ++chunk_.messages;
  ++messages_;
  ++counts_.at(message.channel);
  if (chunk_.index.size() < channels_.size()) chunk_.index.resize(channels_.size());
  chunk_.index[message.channel].push_back({message.logged_ns, chunk_.records.size()});
}

void McapWriter::append_message_head(const McapMessage& message) {
  McapEncoder encoder(chunk_.records);
  encoder.number(message.channel);
  encoder.number(message.sequence);
  encoder.number(message.logged_ns);
  encoder.number(message.published_ns);
}

void McapWriter::append_schema(McapBytes& bytes, std::uint16_t id) const {
  const McapSchema& schema = schemas_[id - 1u];
  McapEncoder encoder(bytes);
  encoder.record(Kind::kSchema, [&] {
    encoder.number(id);
    encoder.text(schema.name);
    encoder.text(schema.encoding);
    encoder.text(schema.text);
  });
}

void McapWriter::append_channel(McapBytes& bytes, std::uint16_t id) const {
  const McapChannel& channel = channels_[id];
  McapEncoder encoder(bytes);
  encoder.record(Kind::kChannel, [&] {
    encoder.number(id);
    encoder.number(channel.schema);
    encoder.text(channel.topic);
    encoder.text(channel.message_encoding);
    encoder.texts(channel.metadata);
  });
}

std::span<const std::uint8_t> McapWriter::compressed(std::span<const std::uint8_t> records) {
  if (!compressor_) return records;
  compressed_.resize(ZSTD_compressBound(records.size()));
  const std::size_t size = ZSTD_compressCCtx(compressor_.get(), compressed_.data(), compressed_.size(),
                                             records.data(), records.size(), kCompressionLevel);
  if (ZSTD_isError(size)) throw std::runtime_error(path_ + ": " + ZSTD_getErrorName(size));
  return std::span(compressed_).first(size);
}

void McapWriter::end_chunk() {
  if (chunk_.records.empty()) return;
  const std::span<const std::uint8_t> records = compressed(chunk_.records);
  const std::string compression = compressor_ ? "zstd" : "";
  const std::uint64_t chunk_at = size_;
  McapBytes head;
  McapEncoder encoder(head);
  encoder.number(static_cast<std::uint8_t>(Kind::kChunk));
  encoder.number(std::uint64_t{8 + 8 + 8 + 4 + 4 + compression.size() + 8 + records.size()});
  encoder.number(chunk_.begin_ns);
  encoder.number(chunk_.end_ns);
  encoder.number(std::uint64_t{chunk_.records.size()});
  encoder.number(mcap_checksum(chunk_.records));
  encoder.text(compression);
  encoder.number(std::uint64_t{records.size()});
  write(head);
  write(records);
  const std::uint64_t index_at = size_;
  const McapBytes offsets = write_message_index();
  McapEncoder summary(chunk_indices_);
  summary.record(Kind::kChunkIndex, [&] {
    summary.number(chunk_.begin_ns);
    summary.number(chunk_.end_ns);
    summary.number(chunk_at);
    summary.number(index_at - chunk_at);
    summary.number(static_cast<std::uint32_t>(offsets.size()));
    summary.raw(offsets);
    summary.number(size_ - index_at);
    summary.text(compression);
    summary.number(std::uint64_t{records.size()});
    summary.number(std::uint64_t{chunk_.records.size()});
  });
  ++chunks_;
  chunk_.records.clear();
  chunk_.messages = chunk_.begin_ns = chunk_.end_ns = 0;
  keep();
}

McapBytes McapWriter::write_message_index() {
  McapBytes offsets, index;
  McapEncoder offset_encoder(offsets), index_encoder(index);
  for (std::size_t channel = 0; channel < chunk_.index.size(); ++channel) {
    std::vector<IndexEntry>& entries = chunk_.index[channel];
    if (entries.empty()) continue;
    offset_encoder.number(static_cast<std::uint16_t>(channel));
    offset_encoder.number(size_ + index.size());
    index_encoder.record(Kind::kMessageIndex, [&] {
      index_encoder.number(static_cast<std::uint16_t>(channel));
      index_encoder.number(static_cast<std::uint32_t>(16 * entries.size()));
      for (const IndexEntry& entry : entries) {
        index_encoder.number(entry.logged_ns);
        index_encoder.number(entry.offset);
      }
    });
    entries.clear();
  }
  write(index);
  return offsets;
}

void McapWriter::add_attachment(const McapAttachment& attachment) {
  end_chunk();
  McapBytes bytes;
  McapEncoder encoder(bytes);
  encoder.record(Kind::kAttachment, [&] {
    encoder.number(attachment.logged_ns);
    encoder.number(attachment.logged_ns);
    encoder.text(attachment.name);
    encoder.text(attachment.media_type);
    encoder.number(std::uint64_t{attachment.content.size()});
    encoder.raw(attachment.content);
    encoder.number(mcap_checksum(std::span(bytes).subspan(kMcapFrameSize)));
  });
  McapEncoder index(attachment_indices_);
  index.record(Kind::kAttachmentIndex, [&] {
    index.number(size_);
    index.number(std::uint64_t{bytes.size()});
    index.number(attachment.logged_ns);
    index.number(attachment.logged_ns);
    index.number(std::uint64_t{attachment.content.size()});
    index.text(attachment.name);
    index.text(attachment.media_type);
  });
  write(bytes);
  keep();
  ++attachments_;
}

void McapWriter::add_metadata(const McapMetadata& metadata) {
  end_chunk();
  McapBytes bytes;
  McapEncoder encoder(bytes);
  encoder.record(Kind::kMetadata, [&] {
    encoder.text(metadata.name);
    encoder.texts(metadata.texts);
  });
  McapEncoder index(metadata_indices_);
  index.record(Kind::kMetadataIndex, [&] {
    index.number(size_);
    index.number(std::uint64_t{bytes.size()});
    index.text(metadata.name);
  });
  write(bytes);
  keep();
  ++metadata_;
}

void McapWriter::append_statistics(McapBytes& bytes) const {
  McapEncoder encoder(bytes);
  encoder.record(Kind::kStatistics, [&] {
    encoder.number(messages_);
    encoder.number(static_cast<std::uint16_t>(schemas_.size()));
    encoder.number(static_cast<std::uint32_t>(channels_.size()));
    encoder.number(attachments_);
    encoder.number(metadata_);
    encoder.number(chunks_);
    encoder.number(begin_ns_);
    encoder.number(end_ns_);
    encoder.number(static_cast<std::uint32_t>(10 * counts_.size()));
    for (std::size_t channel = 0; channel < counts_.size(); ++channel) {
      encoder.number(static_cast<std::uint16_t>(channel));
      encoder.number(counts_[channel]);
    }
  });
}

void McapWriter::close() {
  end_chunk();
  McapBytes bytes;
  McapEncoder encoder(bytes);
  encoder.record(Kind::kDataEnd, [&] { encoder.number(checksum_); });
  write(bytes);

  // The summary: a group of records of each kind, followed by the position of each group.
  bytes.clear();
  const std::uint64_t summary_at = size_;
  McapBytes offsets;
  McapEncoder offset_encoder(offsets);
  const auto add_group = [&](Kind kind, auto append) {
    const std::uint64_t begin = bytes.size();
    append();
    if (bytes.size() == begin) return;
    offset_encoder.record(Kind::kSummaryOffset, [&] {
      offset_encoder.number(static_cast<std::uint8_t>(kind));
      offset_encoder.number(summary_at + begin);
      offset_encoder.number(bytes.size() - begin);
    });
  };
  add_group(Kind::kSchema, [&] {
    for (std::size_t i = 1; i <= schemas_.size(); ++i) append_schema(bytes, static_cast<std::uint16_t>(i));
  });
  add_group(Kind::kChannel, [&] {
    for (std::size_t i = 0; i < channels_.size(); ++i) append_channel(bytes, static_cast<std::uint16_t>(i));
  });
  add_group(Kind::kStatistics, [&] { append_statistics(bytes); });
  add_group(Kind::kChunkIndex, [&] { encoder.raw(chunk_indices_); });
  add_group(Kind::kAttachmentIndex, [&] { encoder.raw(attachment_indices_); });
  add_group(Kind::kMetadataIndex, [&] { encoder.raw(metadata_indices_); });
  const std::uint64_t offsets_at = summary_at + bytes.size();
  encoder.raw(offsets);
  // The checksum also covers the footer's size.
  encoder.number(static_cast<std::uint8_t>(Kind::kFooter));
  encoder.number(std::uint64_t{8 + 8 + 4});
  encoder.number(summary_at);
  encoder.number(offsets_at);
  encoder.number(mcap_checksum(bytes));
  encoder.raw(kMcapMagic);
  write(bytes);
  if (std::fclose(file_.release()) != 0) note_failure();
  if (!failure_.empty()) throw std::runtime_error(failure_);
}

}  // namespace sidestep
