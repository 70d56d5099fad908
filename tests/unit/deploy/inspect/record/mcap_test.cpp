// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "common/file/temporary_folder.hpp"
#include "common/random/rng.hpp"
#include "deploy/inspect/record/mcap/mcap_reader.hpp"
#include "deploy/inspect/record/mcap/mcap_writer.hpp"
#include "tests/catch.hpp"
#include "tests/file_limit.hpp"
#include "tests/forked.hpp"

namespace sidestep::mcap_test {

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

struct Message {
  std::string topic;
  std::uint32_t sequence;
  std::uint64_t logged_ns, published_ns;
  McapBytes payload;

  friend bool operator==(const Message&, const Message&) = default;
};

struct Contents {
  std::vector<Message> messages;
  std::vector<std::string> attachments, metadata;
  std::string damage;
};

Contents read(const std::string& path) {
  McapReader reader(path);
  Contents result;
  for (;;) {
    const McapRecord record = reader.next();
    if (const auto* message = std::get_if<McapMessage>(&record))
      result.messages.push_back({reader.channel(*message).topic,
                                 message->sequence,
                                 message->logged_ns,
                                 message->published_ns,
                                 {message->payload.begin(), message->payload.end()}});
    else if (const auto* attachment = std::get_if<McapAttachment>(&record))
      result.attachments.push_back(attachment->name + ":" + attachment->media_type + ":" +
                                   std::string(attachment->content.begin(), attachment->content.end()));
    else if (const auto* metadata = std::get_if<McapMetadata>(&record))
      for (const auto& [key, value] : metadata->texts)
        result.metadata.push_back(metadata->name + ":" + key + "=" + value);
    else
      break;
  }
  result.damage = reader.damage();
  return result;
}

/// Writes messages of random sizes, with an attachment and metadata before and after them.
std::vector<Message> write_file(const std::string& path, std::uint64_t seed, std::size_t count,
                                const McapWriterSettings& settings) {
  Rng rng(seed);
  McapWriter writer(path, settings);
  writer.add_metadata({"begin", {{"a", "1"}, {"b", ""}}});
  writer.add_attachment({5, "x.txt", "text/plain", {'h', 'i'}});
  std::vector<std::uint16_t> channels;
  std::vector<Message> messages;
  const std::uint16_t schema = writer.add_schema({"T", "omgidl", "struct T { long a; };"});
  for (std::size_t i = 0; i < count; ++i) {
    if (channels.empty() || rng.chance(0.1))
      channels.push_back(writer.add_channel({rng.chance(0.5) ? schema : std::uint16_t{0},
                                             "topic/" + std::to_string(channels.size()),
                                             "cdr",
                                             {}}));
    const std::uint16_t channel = channels[rng.below(channels.size())];
    Message message{"topic/" + std::to_string(channel), static_cast<std::uint32_t>(i),
                    1'000'000'000 + 7'000'000 * i, rng.bits(), McapBytes(rng.below(200))};
    for (std::uint8_t& byte : message.payload) byte = static_cast<std::uint8_t>(rng.below(4));
    writer.add_message(
        {channel, message.sequence, message.logged_ns, message.published_ns},
        [&](McapBytes& bytes) { bytes.insert(bytes.end(), message.payload.begin(), message.payload.end()); });
    messages.push_back(std::move(message));
  }
  CHECK(writer.messages() == count);
  writer.add_metadata({"end", {}});
  writer.close();
  return messages;
}

TEST_CASE("messages written to an MCAP file are read back") {
  const TemporaryFolder folder;
  const std::string file = folder.file("test.mcap");
  const bool is_compressed = GENERATE(false, true);
  const std::size_t count = GENERATE(0, 1, 1000);
  CAPTURE(is_compressed, count);
  const auto written = write_file(file, 1, count, {.is_compressed = is_compressed, .chunk_bytes = 5000});
  const Contents result = read(file);
  CHECK(result.damage == "");
  CHECK(result.messages == written);
  CHECK(result.attachments == std::vector<std::string>{"x.txt:text/plain:hi"});
  CHECK(result.metadata == std::vector<std::string>{"begin:a=1", "begin:b="});
}

TEST_CASE("all complete messages are read from an MCAP file that is truncated anywhere") {
  const TemporaryFolder folder;
  const std::string file = folder.file("test.mcap");
  const auto written = write_file(file, 2, 60, {.max_chunk_ns = 100'000'000});
  const std::string whole = contents(file);
  std::size_t before = 0;
  for (std::size_t size = kMcapMagic.size(); size < whole.size(); ++size) {
    CAPTURE(size, whole.size());
    write(file, whole.substr(0, size));
    const Contents result = read(file);
    REQUIRE(result.damage != "");
    REQUIRE(result.messages.size() >= before);
    REQUIRE(result.messages.size() <= before + 1);
    REQUIRE(std::equal(result.messages.begin(), result.messages.end(), written.begin()));
    before = result.messages.size();
  }
  CHECK(before == written.size());
}

TEST_CASE("a chunk is written after a second of messages and on end_chunk()") {
  const TemporaryFolder folder;
  const std::string file = folder.file("test.mcap");
  McapWriter writer(file);
  const std::uint16_t channel = writer.add_channel({0, "t", "cdr", {}});
  const auto add = [&](std::uint64_t ms) {
    writer.add_message({channel, 0, ms * 1'000'000, 0}, [](McapBytes& bytes) { bytes.push_back(1); });
  };
  add(10);
  add(1009);
  CHECK(read(file).messages.empty());
  add(1010);
  CHECK(read(file).messages.size() == 2);
  writer.end_chunk();
  const Contents result = read(file);
  CHECK(result.messages.size() == 3);
  CHECK(result.damage == "the file was not finished");
}

TEST_CASE("reading a damaged MCAP file does no harm and reports the damage") {
  const TemporaryFolder folder;
  const std::string file = folder.file("test.mcap");
  const bool is_compressed = GENERATE(false, true);
  CAPTURE(is_compressed);
  write_file(file, 3, 60, {.is_compressed = is_compressed, .max_chunk_ns = 100'000'000});
  const std::string whole = contents(file);
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::string broken = whole;
    for (std::uint64_t i = 0; i <= rng.below(4); ++i)
      broken[kMcapMagic.size() + rng.below(broken.size() - kMcapMagic.size())] =
          static_cast<char>(rng.bits());
    if (broken == whole) continue;
    write(file, broken);
    REQUIRE(read(file).damage != "");
  }
}

TEST_CASE("no memory is allocated for sizes that an MCAP file states without containing the data") {
  const TemporaryFolder folder;
  const std::string file = folder.file("test.mcap");
  const std::string magic(kMcapMagic.begin(), kMcapMagic.end());
  const std::string huge("\x06\xff\xff\xff\xff\xff\xff\xff\x7f", 9),
      large("\x06\x00\x00\x00\x03\x00\x00\x00\x00", 9);
  write(file, magic + huge);
  CHECK_THAT(read(file).damage, ContainsSubstring("claims a size of"));
  write(file, magic + large);
  CHECK_THAT(read(file).damage, ContainsSubstring("middle of a record"));
  // A chunk that claims to decompress to 200 MB, none of which is in the file.
  const std::string chunk = std::string("\x06\x28\0\0\0\0\0\0\0", 9) + std::string(16, '\0') +
                            std::string("\x00\x00\x80\x0c\0\0\0\0", 8) + std::string(16, '\0');
  write(file, magic + chunk);
  CHECK(read(file).damage == "a chunk claims to contain 209715200 bytes, more than the limit of 67108864");
}

TEST_CASE("an MCAP file with many large schemas and channels is refused before it exhausts memory") {
  const TemporaryFolder folder;
  const std::string file = folder.file("test.mcap");
  // A schema record, which the file repeats: number 7, without name and encoding, with a megabyte of text.
  const std::string text(1 << 20, 'x');
  const std::string schema = std::string("\x03\x0e\x00\x10\x00\x00\x00\x00\x00", 9) +
                             std::string("\x07\x00", 2) + std::string(8, '\0') +
                             std::string("\x00\x00\x10\x00", 4) + text;
  std::string bytes(kMcapMagic.begin(), kMcapMagic.end());
  for (int i = 0; i < 31; ++i) bytes += schema;
  write(file, bytes);
  CHECK_THAT(read(file).damage, ContainsSubstring("was not finished"));
  write(file, bytes + schema + schema);
  CHECK_THAT(read(file).damage, ContainsSubstring("schemas and channels take more than"));
}

TEST_CASE("a chunk with records other than schemas, channels and messages counts as damaged") {
  const TemporaryFolder folder;
  const std::string file = folder.file("test.mcap");
  const auto kind = GENERATE(McapRecordKind::kAttachment, McapRecordKind::kMetadata, McapRecordKind::kChunk,
                             McapRecordKind::kDataEnd, McapRecordKind{0x00}, McapRecordKind{0x90});
  CAPTURE(kind);
  McapBytes records, bytes(kMcapMagic.begin(), kMcapMagic.end());
  McapEncoder inside(records), outside(bytes);
  const auto add_message = [&] {
    inside.record(McapRecordKind::kMessage, [&] {
      inside.number(std::uint16_t{1});
      inside.number(std::uint32_t{0});
      inside.number(std::uint64_t{0});
      inside.number(std::uint64_t{0});
    });
  };
  inside.record(McapRecordKind::kChannel, [&] {
    inside.number(std::uint16_t{1});
    inside.number(std::uint16_t{0});
    inside.text("topic");
    inside.text("cdr");
    inside.texts({});
  });
  add_message();
  inside.record(kind, [] {});
  add_message();
  outside.record(McapRecordKind::kChunk, [&] {
    outside.number(std::uint64_t{0});
    outside.number(std::uint64_t{0});
    outside.number(std::uint64_t{records.size()});
    outside.number(std::uint32_t{0});
    outside.text("");
    outside.number(std::uint64_t{records.size()});
    outside.raw(records);
  });
  outside.record(McapRecordKind::kMetadata, [&] {
    outside.text("outside");
    outside.texts({{"key", "value"}});
  });
  write(file, {bytes.begin(), bytes.end()});
  const Contents found = read(file);
  CHECK(found.messages.size() == 1);
  CHECK(found.metadata.empty());
  CHECK(found.damage == fmt::format("a chunk holds a record of kind 0x{:02x}, expected schemas, channels and "
                                    "messages",
                                    static_cast<unsigned>(kind)));
}

TEST_CASE("a file that is not an MCAP file is rejected with its name") {
  const TemporaryFolder folder;
  const std::string file = folder.file("test.mcap");
  write(file, "MCAP");
  CHECK_THROWS_WITH(McapReader(file), ContainsSubstring(file + ": is not an MCAP file"));
  CHECK_THROWS_WITH(McapReader("/nowhere/at/all"), ContainsSubstring("cannot be read: No such file"));
  CHECK_THROWS_WITH(McapReader("/tmp"), ContainsSubstring("a directory"));
  CHECK_THROWS_WITH(McapReader("/dev/zero"), ContainsSubstring("not a regular file"));
  CHECK_THROWS_WITH(McapWriter("/nowhere/at/all"), ContainsSubstring("cannot write "));
  McapWriter full("/dev/full");
  CHECK_THROWS_WITH(full.close(), "/dev/full: No space left on device");
}

TEST_CASE("a failure to write a recording is reported once, as soon as it occurs") {
  McapWriter full("/dev/full");
  std::vector<std::string> failures;
  full.on_failure([&](const std::string& failure) { failures.push_back(failure); });
  CHECK(failures == std::vector<std::string>{"/dev/full: No space left on device"});
  full.add_metadata({"name", {}});
  CHECK_THROWS(full.close());
  CHECK(failures.size() == 1);
}

TEST_CASE("a recording on a full disk says so, and keeps every message of the chunks before") {
  const TemporaryFolder folder;
  const std::string whole = folder.file("whole.mcap"), cut = folder.file("cut.mcap");
  const McapWriterSettings settings{.chunk_bytes = 2000};
  constexpr std::size_t kCount = 200, kMaxPerChunk = 64;
  const auto written = write_file(whole, 3, kCount, settings);
  const std::size_t limit = GENERATE(100, 1500, 10'000, 20'000);
  REQUIRE(limit < contents(whole).size());
  const std::string problem = forked([&]() -> std::string {
    if (!limit_files(limit)) return "no limit";
    try {
      (void)write_file(cut, 3, kCount, settings);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  });
  const Contents result = read(cut);
  const std::size_t kept = result.messages.size();
  write(folder.file("part.mcap"), contents(whole).substr(0, limit));
  const std::size_t possible = read(folder.file("part.mcap")).messages.size();
  CAPTURE(limit, kept, possible);
  CHECK(kept <= possible);
  CHECK(kept + kMaxPerChunk >= possible);
  CHECK((kept > 0) == (limit > 1500));
  CHECK(std::equal(result.messages.begin(), result.messages.end(), written.begin()));
  CHECK(result.damage == "the file was not finished");
  const std::string end = kept > 0 ? fmt::format("; the recording ends after {} messages", kept) : "";
  CHECK(problem == cut + ": File too large" + end);
}

}  // namespace sidestep::mcap_test
