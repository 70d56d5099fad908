// SPDX-License-Identifier: Apache-2.0
#include "common/league/log_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <stdexcept>
#include <string_view>

namespace sidestep::league {
namespace {

constexpr std::string_view kMagic = "SSL_LOG_FILE";
constexpr std::int32_t kVersion = 1;
constexpr std::size_t kHeadSize = 16;
constexpr std::int64_t kLatest_ns = std::int64_t{1} << 61;  // the year 2043; sums of two stay within 64 bits

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
  auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
  // A folder can be opened, but not read.
  if (!*file || (file->peek(), file->bad())) {
    throw std::runtime_error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  }
  file->clear();
  return file;
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
    fail(name_, 0, "this is compressed, expected a log as it was written: unpack it with gunzip");
  }
  if (std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
    fail(name_, 0, fmt::format("this is no log, expected it to begin with {}", kMagic));
  }
  if (!is_long_enough) fail(name_, kMagic.size(), "the file ends, expected its version");
  const auto version = big_endian<std::int32_t>(bytes.data() + kMagic.size());
  if (version != kVersion) {
    fail(name_, kMagic.size(), fmt::format("version {} of the format, expected {}", version, kVersion));
  }
}

void LogReader::rewind() {
  stream_->clear();
  stream_->seekg(0);
  offset_ = 0;
  held_.reset();
  end_ = LogEnd::kNotYet;
  damage_.clear();
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

void LogReader::finish(LogEnd end, const std::string& why) {
  end_ = end;
  if (end != LogEnd::kWhole) damage_ = fmt::format("{}: byte {}: {}", name_, record_at_, why);
}

std::optional<LogReader::Head> LogReader::read_head() {
  std::array<std::byte, kHeadSize> bytes{};
  record_at_ = offset_;
  if (!read(bytes.data(), bytes.size())) {
    finish(offset_ == record_at_ ? LogEnd::kWhole : LogEnd::kCutOff, "the file ends within a record's head");
    return std::nullopt;
  }
  const Head head{big_endian<std::int64_t>(bytes.data()), big_endian<std::int32_t>(bytes.data() + 8),
                  big_endian<std::int32_t>(bytes.data() + 12)};
  if (head.received_ns < 0 || head.received_ns > kLatest_ns) {
    finish(LogEnd::kDamaged, fmt::format("a record was received at {} ns after 1970, expected 0 to {}",
                                         head.received_ns, kLatest_ns));
    return std::nullopt;
  }
  if (head.size < 0 || (is_known(head.type) && head.size > static_cast<std::int32_t>(kLongestDatagram))) {
    finish(LogEnd::kDamaged, fmt::format("a record of type {} has a size of {}, expected 0 to {}", head.type,
                                         head.size, kLongestDatagram));
    return std::nullopt;
  }
  return head;
}

bool LogReader::next(LogRecord& record) {
  if (held_) {
    record = std::move(*held_);
    held_.reset();
    return true;
  }
  while (end_ == LogEnd::kNotYet) {
    const auto head = read_head();
    if (!head) return false;
    const bool is_packet = is_known(head->type);
    record.bytes.resize(is_packet ? static_cast<std::size_t>(head->size) : 0);
    const bool is_complete = is_packet ? read(record.bytes.data(), record.bytes.size()) : skip(head->size);
    if (!is_complete) {
      finish(LogEnd::kCutOff, "the file ends within a record");
      return false;
    }
    if (!is_packet) {
      ++skipped_;
      continue;
    }
    record.received = time_from_ns(head->received_ns);
    record.type = static_cast<LogType>(head->type);
    return true;
  }
  return false;
}

bool LogReader::seek(Duration after_first) {
  rewind();
  const std::uint64_t skipped_before = skipped_;
  LogRecord record;
  std::optional<Time> first;
  while (next(record)) {
    if (!first) first = record.received;
    if (record.received - *first < after_first) continue;
    held_ = std::move(record);
    break;
  }
  skipped_ = skipped_before;
  return held_.has_value();
}

LogWriter::LogWriter(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  if (!file_) throw std::runtime_error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  std::vector<char> bytes(kMagic.begin(), kMagic.end());
  put_big_endian(bytes, kVersion);
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void LogWriter::add(Time received, LogType type, std::span<const std::byte> bytes) {
  std::vector<char> head;
  put_big_endian(head, to_ns(received));
  put_big_endian(head, static_cast<std::int32_t>(type));
  put_big_endian(head, static_cast<std::int32_t>(bytes.size()));
  file_.write(head.data(), static_cast<std::streamsize>(head.size()));
  file_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  ++records_;
}

void LogWriter::close() {
  file_.close();
  if (!file_) throw std::runtime_error(fmt::format("{}: not all could be written", path_));
}

}  // namespace sidestep::league
