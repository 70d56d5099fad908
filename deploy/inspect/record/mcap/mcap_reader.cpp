// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/mcap/mcap_reader.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <zstd.h>

#include "common/file/read_file.hpp"

namespace sidestep {
namespace {

using Kind = McapRecordKind;
using Bytes = std::span<const std::uint8_t>;

/// The only record kinds that the specification allows in a chunk. Other kinds are refused, because skipping
/// them could take seconds: a compressed chunk of some kilobytes may contain millions of empty records.
bool is_for_chunks(Kind kind) {
  return kind == Kind::kSchema || kind == Kind::kChannel || kind == Kind::kMessage;
}

}  // namespace

bool is_mcap_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::ifstream file(path, std::ios::binary);
  std::array<std::uint8_t, kMcapMagic.size()> bytes{};
  file.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
  return file && bytes == kMcapMagic;
}

McapReader::McapReader(const std::string& path) {
  try {
    require_regular_file(path);
    file_.reset(std::fopen(path.c_str(), "rb"));
    if (!file_) throw std::runtime_error(std::strerror(errno));
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(fmt::format("{}: cannot be read: {}", path, error.what()));
  }
  if (!std::ranges::equal(read(kMcapMagic.size()), kMcapMagic))
    throw std::invalid_argument(path + ": is not an MCAP file");
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error) file_bytes_ = size;
}

void McapReader::fail(const std::string& damage) {
  if (damage_.empty()) damage_ = damage;
  is_at_end_ = true;
}

Bytes McapReader::read(std::size_t size) {
  // Memory grows with the bytes that the file contains, not with the size that a record claims.
  constexpr std::size_t kStep = 1 << 20;
  bytes_.clear();
  while (bytes_.size() < size) {
    const std::size_t before = bytes_.size(), step = std::min(kStep, size - before);
    bytes_.resize(before + step);
    const std::size_t got = std::fread(bytes_.data() + before, 1, step, file_.get());
    bytes_.resize(before + got);
    if (got < step) break;
  }
  checksum_ = mcap_checksum(bytes_, checksum_);
  return bytes_;
}

bool McapReader::read_frame(Frame& frame) {
  const long position = std::ftell(file_.get());
  const std::uint32_t sum_before = checksum_;
  const Bytes head = read(kMcapFrameSize);
  if (head.size() < kMcapFrameSize) {
    fail(head.empty() ? "the file was not finished" : "the file ends in the middle of a record");
    return false;
  }
  McapDecoder decoder(head);
  frame.kind = static_cast<Kind>(decoder.number<std::uint8_t>());
  const auto size = decoder.number<std::uint64_t>();
  if (size > kMaxRecordSize) {
    fail(fmt::format("a record claims a size of {} bytes", size));
    return false;
  }
  frame.content = read(static_cast<std::size_t>(size));
  if (frame.content.size() < size) {
    is_cut_ = true;
    fail("the file ends in the middle of a record");
    if (frame.kind != Kind::kChunk) return false;
  }
  if (frame.kind == Kind::kChunk && position > 0) chunk_offset_ = static_cast<std::uint64_t>(position);
  if (frame.kind == Kind::kDataEnd) {
    check_end(frame.content, sum_before);
    return false;
  }
  return true;
}

void McapReader::check_end(Bytes data_end, std::uint32_t sum) {
  is_at_end_ = true;
  if (was_seek_called_) return;
  const auto expected = McapDecoder(data_end).number<std::uint32_t>();
  if (expected != 0 && expected != sum) return fail("the checksum of the data is wrong");
  // The summary. Its checksum is the last field of the footer, which ends the file together with the magic.
  constexpr std::size_t kEnd = 4 + kMcapMagic.size();
  McapBytes rest;
  std::uint32_t sum_of_summary = 0;
  for (;;) {
    if (*is_stopped_) return;
    const Bytes some = read(1 << 20);
    if (some.empty()) break;
    rest.insert(rest.end(), some.begin(), some.end());
    const std::size_t summary = rest.size() - std::min(rest.size(), kEnd);
    sum_of_summary = mcap_checksum(Bytes(rest).first(summary), sum_of_summary);
    rest.erase(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(summary));
  }
  if (rest.size() < kEnd || !std::ranges::equal(Bytes(rest).last(kMcapMagic.size()), kMcapMagic))
    return fail("the file was not finished");
  const auto stated = McapDecoder(rest).number<std::uint32_t>();
  if (stated != 0 && stated != sum_of_summary) fail("the checksum of the summary is wrong");
}

bool McapReader::decompress(Bytes compressed, std::uint64_t size) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
  chunk_.resize(static_cast<std::size_t>(size));
  ZSTD_inBuffer in{compressed.data(), compressed.size(), 0};
  ZSTD_outBuffer out{chunk_.data(), chunk_.size(), 0};
  std::size_t left = 1;
  while (left != 0 && in.pos < in.size) {
    const std::size_t in_before = in.pos, out_before = out.pos;
    left = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(left)) return false;
    if (in.pos == in_before && out.pos == out_before) break;
  }
  chunk_.resize(out.pos);
  return true;
}

std::string McapReader::chunk_problem(const McapDecoder& decoder, std::uint64_t size,
                                      std::uint64_t stored_size, const std::string& compression) const {
  if (!decoder.is_ok() || (!is_cut_ && stored_size != decoder.left().size())) return "a chunk is damaged";
  if (size > kMaxRecordSize)
    return fmt::format("a chunk claims to contain {} bytes, more than the limit of {}", size, kMaxRecordSize);
  if (!compression.empty() && compression != "zstd") return "a chunk is compressed, but not with zstd";
  return "";
}

bool McapReader::open_chunk(Bytes content) {
  McapDecoder decoder(content);
  decoder.raw(8 + 8);  // times of the first and last message
  const auto size = decoder.number<std::uint64_t>();
  const auto sum = decoder.number<std::uint32_t>();
  const std::string compression = decoder.text();
  const auto stored_size = decoder.number<std::uint64_t>();
  const std::string problem = chunk_problem(decoder, size, stored_size, compression);
  if (!problem.empty()) {
    fail(problem);
    return false;
  }
  if (compression.empty())
    chunk_.assign(decoder.left().begin(), decoder.left().end());
  else if (!decompress(decoder.left(), size)) {
    fail("a chunk cannot be decompressed");
    return false;
  }
  if (!is_cut_ && (chunk_.size() != size || (sum != 0 && mcap_checksum(chunk_) != sum))) {
    fail("a chunk has a wrong checksum");
    return false;
  }
  records_ = McapDecoder(chunk_);
  return true;
}

bool McapReader::read_chunk_frame(Frame& frame) {
  if (records_.left().empty()) return false;
  frame.kind = static_cast<Kind>(records_.number<std::uint8_t>());
  frame.content = records_.raw(records_.number<std::uint64_t>());
  if (records_.is_ok() && is_for_chunks(frame.kind)) return true;
  fail(records_.is_ok() ? fmt::format("a chunk holds a record of kind 0x{:02x}, expected schemas, channels "
                                      "and messages",
                                      static_cast<unsigned>(frame.kind))
                        : "a record in a chunk is damaged");
  records_ = McapDecoder({});
  return false;
}

void McapReader::seek(const McapReader& known, std::uint64_t chunk_offset) {
  schemas_ = known.schemas_;
  channels_ = known.channels_;
  records_ = McapDecoder({});
  is_cut_ = is_at_end_ = false;
  was_seek_called_ = true;
  damage_.clear();
  if (std::fseek(file_.get(), static_cast<long>(chunk_offset), SEEK_SET) != 0)
    fail("cannot seek in the file");
}

double McapReader::progress() const {
  const long position = std::ftell(file_.get());
  return file_bytes_ > 0 && position > 0
             ? std::min(1.0, static_cast<double>(position) / static_cast<double>(file_bytes_))
             : 0;
}

McapRecord McapReader::next() {
  while (!*is_stopped_) {
    Frame frame;
    if (!read_chunk_frame(frame)) {
      if (is_at_end_ || !read_frame(frame)) return {};
      if (frame.kind == Kind::kChunk) {
        if (!open_chunk(frame.content)) return {};
        continue;
      }
    }
    McapRecord record = record_of(frame);
    if (!std::holds_alternative<std::monostate>(record)) return record;
    if (is_at_end_ && records_.left().empty()) return {};
  }
  return {};
}

McapRecord McapReader::record_of(const Frame& frame) {
  switch (frame.kind) {
    case Kind::kSchema:
      learn_schema(frame.content);
      return {};
    case Kind::kChannel:
      learn_channel(frame.content);
      return {};
    case Kind::kMessage:
      return message_of(frame.content);
    case Kind::kAttachment:
      return attachment_of(frame.content);
    case Kind::kMetadata: {
      McapDecoder decoder(frame.content);
      McapMetadata metadata;
      metadata.name = decoder.text();
      metadata.texts = decoder.texts();
      if (decoder.is_ok()) return metadata;
      fail("metadata are damaged");
      return {};
    }
    default:
      return {};  // indices, and record kinds that this reader does not know
  }
}

McapRecord McapReader::message_of(Bytes content) {
  McapDecoder decoder(content);
  McapMessage message;
  message.channel = decoder.number<std::uint16_t>();
  message.sequence = decoder.number<std::uint32_t>();
  message.logged_ns = decoder.number<std::uint64_t>();
  message.published_ns = decoder.number<std::uint64_t>();
  message.payload = decoder.left();
  if (decoder.is_ok() && channels_.contains(message.channel)) return message;
  fail("a message is damaged, or has no channel");
  records_ = McapDecoder({});
  return {};
}

McapRecord McapReader::attachment_of(Bytes content) {
  McapDecoder decoder(content);
  McapAttachment attachment;
  attachment.logged_ns = decoder.number<std::uint64_t>();
  decoder.number<std::uint64_t>();  // time of creation
  attachment.name = decoder.text();
  attachment.media_type = decoder.text();
  const Bytes bytes = decoder.raw(decoder.number<std::uint64_t>());
  const Bytes summed = content.first(content.size() - decoder.left().size());
  const auto sum = decoder.number<std::uint32_t>();
  if (!decoder.is_ok() || (sum != 0 && sum != mcap_checksum(summed))) {
    fail("an attachment is damaged");
    return {};
  }
  attachment.content.assign(bytes.begin(), bytes.end());
  return attachment;
}

bool McapReader::count_kept(Bytes content) {
  constexpr std::size_t kMaxKept = 32 << 20;
  kept_bytes_ += content.size();
  if (kept_bytes_ > kMaxKept) fail(fmt::format("schemas and channels take more than {} bytes", kMaxKept));
  return kept_bytes_ <= kMaxKept;
}

void McapReader::learn_schema(Bytes content) {
  if (!count_kept(content)) return;
  McapDecoder decoder(content);
  const auto id = decoder.number<std::uint16_t>();
  McapSchema schema{decoder.text(), decoder.text(), decoder.text()};
  if (decoder.is_ok() && id != 0)
    schemas_.insert_or_assign(id, std::move(schema));
  else
    fail("a schema is damaged");
}

void McapReader::learn_channel(Bytes content) {
  if (!count_kept(content)) return;
  McapDecoder decoder(content);
  const auto id = decoder.number<std::uint16_t>();
  McapChannel channel;
  channel.schema = decoder.number<std::uint16_t>();
  channel.topic = decoder.text();
  channel.message_encoding = decoder.text();
  channel.metadata = decoder.texts();
  if (!decoder.is_ok() || (channel.schema != 0 && !schemas_.contains(channel.schema)))
    fail("a channel is damaged, or has no schema");
  else
    channels_.insert_or_assign(id, std::move(channel));
}

const McapSchema* McapReader::schema(const McapChannel& channel) const {
  const auto found = schemas_.find(channel.schema);
  return found == schemas_.end() ? nullptr : &found->second;
}

}  // namespace sidestep
