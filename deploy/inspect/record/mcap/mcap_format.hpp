// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace sidestep {

/// The container format MCAP (https://mcap.dev/spec). A file is the magic bytes, records and the magic bytes
/// again. A record is its kind, the size of its content in 8 bytes, and its content. All numbers are
/// little-endian.
inline constexpr std::array<std::uint8_t, 8> kMcapMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

enum class McapRecordKind : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0a,
  kStatistics = 0x0b,
  kMetadata = 0x0c,
  kMetadataIndex = 0x0d,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

inline constexpr std::size_t kMcapFrameSize = 9;  // size of a record's kind and size fields

using McapBytes = std::vector<std::uint8_t>;
using McapTexts = std::map<std::string, std::string>;

struct McapSchema {
  std::string name;      ///< name of the type, for example sidestep::msg::Verdict
  std::string encoding;  ///< for example omgidl
  std::string text;
};

struct McapChannel {
  std::uint16_t schema = 0;  ///< id of the schema; 0: none
  std::string topic;
  std::string message_encoding;  ///< for example cdr
  McapTexts metadata{};
};

struct McapMessage {
  std::uint16_t channel = 0;  ///< id of the channel
  std::uint32_t sequence = 0;
  std::uint64_t logged_ns = 0;
  std::uint64_t published_ns = 0;
  std::span<const std::uint8_t> payload{};  ///< valid until the next call of the function that returned it
};

struct McapAttachment {
  std::uint64_t logged_ns = 0;
  std::string name;
  std::string media_type;
  McapBytes content;
};

struct McapMetadata {
  std::string name;
  McapTexts texts;
};

/// Appends numbers and texts to bytes.
class McapEncoder {
 public:
  explicit McapEncoder(McapBytes& bytes) : bytes_(bytes) {}

  template <typename Number>
  requires std::is_unsigned_v<Number>
  void number(Number number) {
    for (std::size_t i = 0; i < sizeof number; ++i)
      bytes_.push_back(static_cast<std::uint8_t>(std::uint64_t{number} >> 8 * i));
  }
  void raw(std::span<const std::uint8_t> content) {
    bytes_.insert(bytes_.end(), content.begin(), content.end());
  }
  void text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
  }
  void texts(const McapTexts& texts);
  /// Appends a record whose content is written by `append_content`.
  template <typename Append>
  void record(McapRecordKind kind, Append append_content) {
    number(static_cast<std::uint8_t>(kind));
    const std::size_t at = bytes_.size();
    number(std::uint64_t{0});
    append_content();
    const std::uint64_t size = bytes_.size() - at - sizeof size;
    for (std::size_t i = 0; i < sizeof size; ++i) bytes_[at + i] = static_cast<std::uint8_t>(size >> 8 * i);
  }

 private:
  McapBytes& bytes_;
};

/// Reads numbers and texts from the front of untrusted bytes. After the first read beyond their end, is_ok()
/// is false, and all results are zero or empty.
class McapDecoder {
 public:
  explicit McapDecoder(std::span<const std::uint8_t> bytes) : left_(bytes) {}

  bool is_ok() const { return is_ok_; }
  std::span<const std::uint8_t> left() const { return left_; }
  std::span<const std::uint8_t> raw(std::uint64_t size);
  template <typename Number>
  Number number() {
    std::uint64_t value = 0;
    std::size_t shift = 0;
    for (const std::uint8_t byte : raw(sizeof(Number))) value |= std::uint64_t{byte} << shift++ * 8;
    return static_cast<Number>(value);
  }
  std::string text();
  McapTexts texts();

 private:
  std::span<const std::uint8_t> left_;
  bool is_ok_ = true;
};

/// CRC-32 as used in ZIP; `sum` is the checksum of the bytes before these.
[[nodiscard]] std::uint32_t mcap_checksum(std::span<const std::uint8_t> bytes, std::uint32_t sum = 0);

}  // namespace sidestep
