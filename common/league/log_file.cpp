// SPDX-License-Identifier: Apache-2.0
#include "common/league/log_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <unistd.h>

#include "common/file/read_file.hpp"

namespace sidestep::league {
namespace {

constexpr std::string_view kMagic = "SSL_LOG_FILE";
constexpr std::int32_t kVersion = 1;
constexpr std::size_t kHeaderSize = 16;

template <typename Number>
Number big_endian(const std::byte* bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    value = value << 8 | std::to_integer<std::uint64_t>(bytes[i]);
  return static_cast<Number>(value);
}

template <typename Number>
void put_big_endian(std::vector<char>& bytes, Number number) {
  for (std::size_t i = sizeof(Number); i-- > 0;) {
    bytes.push_back(static_cast<char>(static_cast<std::uint64_t>(number) >> 8 * i & 0xff));
  }
}

bool is_known(std::int32_t type) {
  return type >= static_cast<std::int32_t>(LogType::kVision2010) &&
         type <= static_cast<std::int32_t>(LogType::kTracked);
}

[[noreturn]] void fail(const std::string& name, std::int64_t offset, const std::string& why) {
  throw std::runtime_error(fmt::format("{}: byte {}: {}", name, offset, why));
}

std::unique_ptr<std::istream> opened(const std::string& path) {
  try {
    require_regular_file(path);
    auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
    if (!*file) throw std::runtime_error(std::strerror(errno));
    return file;
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(fmt::format("{}: cannot read the file: {}", path, error.what()));
  }
}

}  // namespace

LogReader::LogReader(const std::string& path) : LogReader(opened(path), path) {}

LogReader::LogReader(std::unique_ptr<std::istream> stream, std::string name)
    : stream_(std::move(stream)), name_(std::move(name)) {
  read_magic();
}

void LogReader::read_magic() {
  std::array<std::byte, kMagic.size() + sizeof kVersion> bytes{};
  const bool is_long_enough = read(bytes.data(), bytes.size());
  if (bytes[0] == std::byte{0x1f} && bytes[1] == std::byte{0x8b}) {
    fail(name_, 0, "the file is compressed, expected an uncompressed log (use gunzip)");
  }
  if (std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
    fail(name_, 0, fmt::format("not a log, expected {} at the beginning", kMagic));
  }
  if (!is_long_enough) fail(name_, kMagic.size(), "the file ends before the version number");
  const auto version = big_endian<std::int32_t>(bytes.data() + kMagic.size());
  if (version != kVersion) {
    fail(name_, kMagic.size(), fmt::format("format version {}, expected {}", version, kVersion));
  }
}

void LogReader::rewind() {
  stream_->clear();
  stream_->seekg(0);
  offset_ = 0;
  pending_.reset();
  status_ = LogStatus::kReading;
  error_.clear();
  read_magic();
}

bool LogReader::read(std::byte* to, std::size_t size) {
  stream_->read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(size));
  offset_ += stream_->gcount();
  return static_cast<std::size_t>(stream_->gcount()) == size;
}

bool LogReader::skip(std::int32_t size) {
  stream_->ignore(size);
  offset_ += stream_->gcount();
  return stream_->gcount() == size;
}

void LogReader::finish(LogStatus status, const std::string& why) {
  status_ = status;
  if (status != LogStatus::kComplete) error_ = fmt::format("{}: byte {}: {}", name_, record_offset_, why);
}

std::optional<LogReader::RecordHeader> LogReader::read_header() {
  std::array<std::byte, kHeaderSize> bytes{};
  record_offset_ = offset_;
  if (!read(bytes.data(), bytes.size())) {
    finish(offset_ == record_offset_ ? LogStatus::kComplete : LogStatus::kTruncated,
           "the file ends within a record header");
    return std::nullopt;
  }
  const RecordHeader header{big_endian<std::int64_t>(bytes.data()),
                            big_endian<std::int32_t>(bytes.data() + 8),
                            big_endian<std::int32_t>(bytes.data() + 12)};
  if (header.received_ns < 0 || header.received_ns > to_ns(kMaxTime)) {
    finish(LogStatus::kCorrupt, fmt::format("a record with the receive time {} ns, expected 0 to {}",
                                            header.received_ns, to_ns(kMaxTime)));
    return std::nullopt;
  }
  if (header.size < 0 ||
      (is_known(header.type) && header.size > static_cast<std::int32_t>(kMaxDatagramSize))) {
    finish(LogStatus::kCorrupt, fmt::format("a record of type {} with the size {}, expected 0 to {}",
                                            header.type, header.size, kMaxDatagramSize));
    return std::nullopt;
  }
  return header;
}

bool LogReader::next(LogRecord& record) {
  if (pending_) {
    record = std::move(*pending_);
    pending_.reset();
    return true;
  }
  while (status_ == LogStatus::kReading) {
    const auto header = read_header();
    if (!header) return false;
    const bool is_packet = is_known(header->type);
    record.bytes.resize(is_packet ? static_cast<std::size_t>(header->size) : 0);
    const bool is_complete = is_packet ? read(record.bytes.data(), record.bytes.size()) : skip(header->size);
    if (!is_complete) {
      finish(LogStatus::kTruncated, "the file ends within a record");
      return false;
    }
    if (!is_packet) continue;
    record.received = time_from_ns(header->received_ns);
    record.type = static_cast<LogType>(header->type);
    return true;
  }
  return false;
}

bool LogReader::seek(Duration after_first) {
  rewind();
  LogRecord record;
  std::optional<Time> first;
  while (next(record)) {
    if (!first) first = record.received;
    if (record.received - *first < after_first) continue;
    pending_ = std::move(record);
    break;
  }
  return pending_.has_value();
}

LogWriter::LogWriter(const std::string& path) : path_(path), file_(open_output(path)) {
  // Without a buffer, nothing is written after a failure.
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);
  std::vector<char> bytes(kMagic.begin(), kMagic.end());
  put_big_endian(bytes, kVersion);
  write(bytes);
}

void LogWriter::write(std::span<const char> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size()) {
    size_ += bytes.size();
    return;
  }
  const std::string reason = std::strerror(errno);
  // Removes the incomplete record. Devices and pipes cannot be shortened.
  (void)!ftruncate(fileno(file_.get()), static_cast<off_t>(size_));
  throw_unwritable(
      path_, records_ > 0 ? fmt::format("{}; the log ends after {} packets", reason, records_) : reason);
}

void LogWriter::add(Time received, LogType type, std::span<const std::byte> bytes) {
  std::vector<char> record;
  put_big_endian(record, to_ns(received));
  put_big_endian(record, static_cast<std::int32_t>(type));
  put_big_endian(record, static_cast<std::int32_t>(bytes.size()));
  const auto* const packet = reinterpret_cast<const char*>(bytes.data());
  record.insert(record.end(), packet, packet + bytes.size());
  write(record);
  ++records_;
}

void LogWriter::close() {
  if (std::fclose(file_.release()) != 0) throw_unwritable(path_, std::strerror(errno));
}

}  // namespace sidestep::league
