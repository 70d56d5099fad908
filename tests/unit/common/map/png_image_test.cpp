// SPDX-License-Identifier: Apache-2.0
#include "common/map/png_image.hpp"

#include <png.h>
#include <sstream>
#include <vector>

#include "tests/catch.hpp"
#include "tests/unit/common/map/map_folder.hpp"

namespace sidestep::png_image_test {

using test::kMapYaml;
using test::replaced;

/// A PNG image with 8-bit samples, or with linear 16-bit samples.
std::string encoded(unsigned columns, unsigned rows, png_uint_32 format, const void* samples) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = columns;
  image.height = rows;
  image.format = format;
  png_alloc_size_t size = 0;
  REQUIRE(png_image_write_to_memory(&image, nullptr, &size, 0, samples, 0, nullptr) != 0);
  std::string bytes(size, '\0');
  REQUIRE(png_image_write_to_memory(&image, bytes.data(), &size, 0, samples, 0, nullptr) != 0);
  bytes.resize(size);
  return bytes;
}

std::string grey(unsigned columns, unsigned rows, const std::vector<png_byte>& samples) {
  return encoded(columns, rows, PNG_FORMAT_GRAY, samples.data());
}

std::string big_endian(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

/// A chunk with its checksum (PNG specification, annex D).
std::string chunk(const std::string& type, const std::string& data) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : type + data) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xedb88320 ^ (crc >> 1) : crc >> 1;
  }
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(~crc);
}

/// A PNG image in which the chunks between header and pixels are replaced.
std::string with_chunks(const std::string& png, const std::string& chunks) {
  constexpr std::size_t kHeaderEnd = 33;
  return png.substr(0, kHeaderEnd) + chunks + png.substr(png.find("IDAT") - 4);
}

std::string drawing(const std::string& png, double free_above) {
  std::istringstream file(png);
  const auto state_of = [&](double brightness) {
    return brightness > free_above ? MapCellState::kFree : MapCellState::kOccupied;
  };
  const BitGrid bits = read_png(file, state_of, UnknownCells::kBlocked).blocked;
  return test::drawing({MapGrid{bits.columns(), bits.rows(), 1, {0, 0}}, bits});
}

std::string error_of(const std::string& png) {
  try {
    return drawing(png, 0.5);
  } catch (const ImageError& error) {
    return error.what();
  }
}

TEST_CASE("a PNG image is read as a map") {
  const test::MapFolder folder;
  const std::string yaml = replaced(kMapYaml, "map.pgm", "map.png");
  write_file(folder / "map.png", grey(3, 2, {254, 205, 0, 254, 254, 255}));
  CHECK(test::drawing(folder.load(yaml, "")) == ".##/.../");
  write_file(folder / "map.png", "\x89PNG");
  CHECK_THAT(folder.error(yaml, ""), StartsWith("map.yaml:1: image: "));
  CHECK_THAT(folder.error(yaml, ""), ContainsSubstring("map.png: it is not a valid PNG image"));
}

TEST_CASE("grey values are used as stored") {
  std::vector<png_byte> all(256);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<png_byte>(i);
  const std::string png = grey(256, 1, all);
  for (const int limit : {0, 1, 50, 128, 205, 254}) {
    const auto blocked = static_cast<std::size_t>(limit) + 1;
    const std::string expected = std::string(blocked, '#') + std::string(256 - blocked, '.') + "/";
    CHECK(drawing(png, (limit + 0.5) / 255) == expected);
    CHECK(drawing(with_chunks(png, ""), (limit + 0.5) / 255) == expected);
    CHECK(drawing(with_chunks(png, chunk("gAMA", big_endian(45'455))), (limit + 0.5) / 255) == expected);
  }
}

TEST_CASE("16-bit samples are not brightened") {
  const std::vector<png_uint_16> samples{0, 0x3fff, 0x7fff, 0xbfff, 0xffff};
  const std::string png = with_chunks(encoded(5, 1, PNG_FORMAT_LINEAR_Y, samples.data()), "");
  CHECK(drawing(png, 0.55) == "###../");
  CHECK(drawing(png, 0.45) == "##.../");
}

TEST_CASE("colours are averaged and transparent pixels are blocked") {
  const std::vector<png_byte> colours{255, 0, 0, 255, 255, 0, 255, 255, 255};
  const std::string rgb = encoded(3, 1, PNG_FORMAT_RGB, colours.data());
  CHECK(drawing(rgb, 0.33) == ".../");
  CHECK(drawing(rgb, 0.34) == "#../");
  CHECK(drawing(rgb, 0.67) == "##./");
  const std::vector<png_byte> pixels{255, 255, 255, 255, 255, 255, 255, 254, 255, 255, 255, 0};
  CHECK(drawing(encoded(3, 1, PNG_FORMAT_RGBA, pixels.data()), 0.5) == ".##/");
}

TEST_CASE("an image whose gamma would change its values is rejected") {
  const std::string png = grey(2, 1, {0, 205});
  for (const std::uint32_t gamma : {0U, 1U, 10'000U, 60'000U, 100'000U, 0xffffffffU}) {
    CHECK_THAT(error_of(with_chunks(png, chunk("gAMA", big_endian(gamma)))),
               ContainsSubstring("its gAMA chunk is"));
    CHECK_THAT(error_of(with_chunks(png, chunk("tEXt", "a=b") + chunk("gAMA", big_endian(gamma)))),
               ContainsSubstring("its gAMA chunk is"));
  }
}

TEST_CASE("damaged PNG images are rejected") {
  const std::string png = grey(40, 30, std::vector<png_byte>(1200, 200));
  // The necessary data ends with the compressed pixels, before the checksum and the IEND chunk.
  for (std::size_t size = 2; size + 16 < png.size(); ++size) {
    CAPTURE(size);
    CHECK_THAT(error_of(png.substr(0, size)), StartsWith("it is"));
  }
  std::string broken = png;
  broken[png.find("IDAT") + 8] ^= 0x55;
  CHECK_THAT(error_of(broken), ContainsSubstring("not a valid PNG image"));
}

TEST_CASE("PNG images that are too large are rejected before they are decompressed") {
  const auto with_size = [](std::uint32_t columns, std::uint32_t rows) {
    const std::string png = grey(1, 1, {255});
    const std::string header = big_endian(columns) + big_endian(rows) + std::string("\x8\0\0\0\0", 5);
    return png.substr(0, 8) + chunk("IHDR", header) + png.substr(png.find("IDAT") - 4);
  };
  CHECK(error_of(with_size(1, 1)) == "./");
  CHECK_THAT(error_of(with_size(16'385, 1)), ContainsSubstring("16385 x 1 pixels, expected 1 to 16384"));
  CHECK_THAT(error_of(with_size(16'384, 16'384)), ContainsSubstring("at most 67108864 pixels"));
  CHECK_THAT(error_of(with_size(8'192, 8'192)), ContainsSubstring("truncated"));
  CHECK_THAT(error_of(with_size(0, 1)), ContainsSubstring("not a valid PNG image"));
}

}  // namespace sidestep::png_image_test
