// SPDX-License-Identifier: Apache-2.0
#include "common/league/log_file.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

#include "common/file/temporary_folder.hpp"
#include "tests/catch.hpp"
#include "tests/file_limit.hpp"
#include "tests/forked.hpp"
#include "tests/unit/common/league/random_packets.hpp"

namespace sidestep::league::log_file_test {

using std::chrono::milliseconds;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

class TemporaryFile {
 public:
  std::string path() const { return folder_.file("log"); }
  std::string content() const {
    std::ifstream file(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  TemporaryFolder folder_;
};

/// Records of alternating vision and tracked packets, one every 10 ms.
std::vector<LogRecord> random_records(Rng& rng, int count) {
  std::vector<LogRecord> records;
  for (int i = 0; i < count; ++i) {
    const Time received = kBegin + milliseconds(10) * i;
    if (i % 2 == 0) {
      records.push_back({received, LogType::kVision, encode(test::random_vision_packet(rng))});
    } else {
      records.push_back({received, LogType::kTracked, encode(test::random_tracked_packet(rng))});
    }
  }
  return records;
}

std::string log_of(const std::vector<LogRecord>& records) {
  TemporaryFile file;
  LogWriter writer(file.path());
  for (const LogRecord& record : records) writer.add(record.received, record.type, record.bytes);
  writer.close();
  return file.content();
}

LogReader reader_of(const std::string& content) {
  return LogReader(std::make_unique<std::istringstream>(content), "x.log");
}

/// Reads and returns all remaining records.
std::vector<LogRecord> all_of(LogReader& reader) {
  std::vector<LogRecord> records;
  LogRecord record;
  while (reader.next(record)) records.push_back(record);
  return records;
}

void check_same(const std::vector<LogRecord>& a, std::span<const LogRecord> b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].received == b[i].received);
    CHECK(a[i].type == b[i].type);
    CHECK(a[i].bytes == b[i].bytes);
  }
}

std::string error_of(const std::string& content) {
  try {
    (void)reader_of(content);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

/// The header of a record, big-endian.
std::string header(std::int64_t received_ns, std::int32_t type, std::int32_t size) {
  std::string bytes;
  for (int i = 7; i >= 0; --i) bytes += static_cast<char>(received_ns >> 8 * i & 0xff);
  for (const std::int32_t number : {type, size}) {
    for (int i = 3; i >= 0; --i) bytes += static_cast<char>(number >> 8 * i & 0xff);
  }
  return bytes;
}

const std::string kFileHeader = std::string("SSL_LOG_FILE") + std::string("\0\0\0\1", 4);

TEST_CASE("a written log is read back unchanged") {
  Rng rng(1);
  const auto records = random_records(rng, 300);
  TemporaryFile file;
  LogWriter writer(file.path());
  for (const LogRecord& record : records) writer.add(record.received, record.type, record.bytes);
  CHECK(writer.records() == 300);
  writer.close();
  LogReader reader(file.path());
  check_same(all_of(reader), records);
  CHECK(reader.status() == LogStatus::kComplete);
  CHECK(reader.error().empty());
}

TEST_CASE("a log has the league's format: magic, version and big-endian records") {
  const std::byte payload[] = {std::byte{0xaa}, std::byte{0xbb}};
  const std::string content =
      log_of({{time_from_ns(0x0102030405060708), LogType::kVision, {payload[0], payload[1]}}});
  CHECK(content == kFileHeader + std::string("\1\2\3\4\5\6\7\10\0\0\0\4\0\0\0\2\xaa\xbb", 18));
}

TEST_CASE("a log on a full disk says so, and keeps all records that fit") {
  Rng rng(4);
  const auto records = random_records(rng, 8);
  std::size_t limit = kFileHeader.size();
  for (std::size_t kept = 0; kept < records.size(); ++kept) {
    const std::size_t missing_bytes = 1 + kept;
    const std::size_t full = limit + 16 + records[kept].bytes.size();
    const TemporaryFile file;
    const std::string problem = forked([&]() -> std::string {
      if (!limit_files(full - missing_bytes)) return "no limit";
      try {
        LogWriter writer(file.path());
        for (const LogRecord& record : records) writer.add(record.received, record.type, record.bytes);
      } catch (const std::runtime_error& error) {
        return error.what();
      }
      return "";
    });
    CAPTURE(kept, missing_bytes);
    CHECK(problem == "cannot write " + file.path() + ": File too large" +
                         (kept > 0 ? fmt::format("; the log ends after {} packets", kept) : ""));
    CHECK(file.content().size() == limit);
    LogReader reader(file.path());
    check_same(all_of(reader), std::span(records).first(kept));
    CHECK(reader.status() == LogStatus::kComplete);
    limit = full;
  }
  CHECK_THROWS_WITH(LogWriter("/dev/full"), "cannot write /dev/full: No space left on device");
}

TEST_CASE("all complete records of a truncated log are read") {
  Rng rng(2);
  const auto records = random_records(rng, 8);
  const std::string whole = log_of(records);
  std::vector<std::size_t> ends{kFileHeader.size()};
  for (const LogRecord& record : records) ends.push_back(ends.back() + 16 + record.bytes.size());
  REQUIRE(ends.back() == whole.size());
  for (std::size_t length = kFileHeader.size(); length <= whole.size(); ++length) {
    CAPTURE(length);
    LogReader reader = reader_of(whole.substr(0, length));
    const auto read = all_of(reader);
    const auto complete =
        static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), length) - ends.begin()) - 1;
    REQUIRE(read.size() == complete);
    if (length % 97 == 0) check_same(read, std::span(records).first(complete));
    const bool is_whole = ends[complete] == length;
    REQUIRE(reader.status() == (is_whole ? LogStatus::kComplete : LogStatus::kTruncated));
    if (!is_whole)
      REQUIRE_THAT(reader.error(), ContainsSubstring("x.log: byte " + std::to_string(ends[complete]) + ": "));
  }
}

TEST_CASE("a file that is not a log is rejected with the position and the expected content") {
  CHECK_THAT(error_of(""), ContainsSubstring("x.log: byte 0: not a log"));
  CHECK_THAT(error_of(std::string("SSL_LOG_FILX\0\0\0\1", 16)),
             ContainsSubstring("x.log: byte 0: not a log"));
  CHECK_THAT(error_of("\x1f\x8b and so on, long enough to be one"), ContainsSubstring("gunzip"));
  CHECK_THAT(error_of("SSL_LOG_FILE"), ContainsSubstring("x.log: byte 12: the file ends"));
  CHECK_THAT(error_of(std::string("SSL_LOG_FILE\0\0\0\2", 16)),
             ContainsSubstring("x.log: byte 12: format version 2"));
  CHECK_THAT(error_of(std::string("SSL_LOG_FILE\1\0\0\0", 16)), ContainsSubstring("version 16777216"));
  CHECK(error_of(kFileHeader) == "accepted");
  CHECK_THROWS_WITH(LogReader("/nowhere/x.log"),
                    ContainsSubstring("/nowhere/x.log: cannot read the file: No such file"));
  CHECK_THROWS_WITH(LogReader("/tmp"), ContainsSubstring("/tmp: "));
  CHECK_THROWS_WITH(LogWriter("/nowhere/x.log"),
                    "cannot write /nowhere/x.log: the folder /nowhere does not exist");
}

TEST_CASE("reading stops at an invalid record and reports its position") {
  const std::string first = kFileHeader + header(5, 4, 3) + "abc";
  const auto error_after_first = [&](const std::string& more) {
    LogReader reader = reader_of(first + more);
    CHECK(all_of(reader).size() == 1);
    CHECK(reader.status() == LogStatus::kCorrupt);
    LogRecord record;
    CHECK_FALSE(reader.next(record));
    CHECK_THAT(reader.error(), ContainsSubstring("x.log: byte 35: "));
    return reader.error();
  };
  CHECK_THAT(error_after_first(header(6, 4, -1) + "xyz"),
             ContainsSubstring("the size -1, expected 0 to 65507"));
  CHECK_THAT(error_after_first(header(6, 4, 65508) + std::string(65508, 'x')),
             ContainsSubstring("the size 65508"));
  CHECK_THAT(error_after_first(header(6, 99, -5)), ContainsSubstring("type 99 with the size -5"));
  CHECK_THAT(error_after_first(header(-6, 4, 0)), ContainsSubstring("receive time -6 ns"));
  CHECK_THAT(error_after_first(header(std::int64_t{1} << 62, 4, 0)),
             ContainsSubstring("receive time 4611686018427387904"));
}

TEST_CASE("records of unknown types and any length are skipped") {
  LogReader reader = reader_of(kFileHeader + header(1, 6, 200'000) + std::string(200'000, 'x') +
                               header(2, 1, 0) + header(3, 3, 2) + "ab");
  const auto records = all_of(reader);
  REQUIRE(records.size() == 1);
  CHECK(records[0].type == LogType::kReferee);
  CHECK(reader.status() == LogStatus::kComplete);
  LogReader truncated = reader_of(kFileHeader + header(1, 6, 0x7fffffff) + "short");
  CHECK(all_of(truncated).empty());
  CHECK(truncated.status() == LogStatus::kTruncated);
}

TEST_CASE("seeking finds the first record at or after an offset, forwards and backwards") {
  Rng rng(3);
  const auto records = random_records(rng, 100);
  LogReader reader = reader_of(log_of(records));
  LogRecord record;
  REQUIRE(reader.next(record));
  for (const int ms : {0, 500, 505, 10, 990, 0}) {
    CAPTURE(ms);
    REQUIRE(reader.seek(milliseconds(ms)));
    check_same(all_of(reader), std::span(records).subspan(static_cast<std::size_t>((ms + 9) / 10)));
    CHECK(reader.status() == LogStatus::kComplete);
  }
  CHECK_FALSE(reader.seek(milliseconds(991)));
  CHECK(reader.status() == LogStatus::kComplete);
  CHECK_FALSE(reader.next(record));
  REQUIRE(reader.seek(milliseconds(20)));
  REQUIRE(reader.next(record));
  CHECK(record.received == kBegin + milliseconds(20));
}

}  // namespace sidestep::league::log_file_test
