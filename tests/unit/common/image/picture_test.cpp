// SPDX-License-Identifier: Apache-2.0
#include "common/image/picture.hpp"

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sys/resource.h>

#include "common/file/temporary_folder.hpp"
#include "common/image/picture_size.hpp"
#include "tests/catch.hpp"

namespace sidestep::picture_test {

using Bytes = std::vector<std::uint8_t>;

Bytes encoded(const char* extension, const std::vector<int>& settings = {}) {
  cv::Mat3b picture(9, 12, cv::Vec3b(10, 200, 90));
  Bytes bytes;
  REQUIRE(cv::imencode(extension, picture, bytes, settings));
  return bytes;
}

std::string error_of(const Bytes& bytes) {
  const TemporaryFolder folder;
  const std::string path = folder.file("picture");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  try {
    const Image image = read_picture(path);
    CHECK(image.view().width_px == 12);
    CHECK(image.view().height_px == 9);
    CHECK(std::abs(image.view().row(4)[4] - 200) < 4);
    return "";
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    REQUIRE(text.starts_with(path + ": "));
    return text.substr(path.size() + 2);
  }
}

/// Replaces the bytes from a given position on.
Bytes with(Bytes bytes, std::size_t at, const Bytes& others) {
  std::ranges::copy(others, bytes.begin() + static_cast<std::ptrdiff_t>(at));
  return bytes;
}

std::size_t find(const Bytes& bytes, const Bytes& part) {
  return static_cast<std::size_t>(std::ranges::search(bytes, part).begin() - bytes.begin());
}

long peak_memory_kb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST_CASE("PNG, JPEG and PNM images are read") {
  CHECK(error_of(encoded(".png")).empty());
  CHECK(error_of(encoded(".jpg")).empty());
  CHECK(error_of(encoded(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1})).empty());
  CHECK(error_of(encoded(".ppm")).empty());
  CHECK(error_of(encoded(".ppm", {cv::IMWRITE_PXM_BINARY, 0})).empty());
}

TEST_CASE("an image whose header states a huge size is rejected before memory is allocated") {
  const long before_kb = peak_memory_kb();
  const Bytes jpeg = encoded(".jpg");
  const std::size_t frame = find(jpeg, {0xff, 0xc0});
  REQUIRE(frame < jpeg.size());
  CHECK(error_of(with(jpeg, frame + 5, {0x7f, 0xff, 0x7f, 0xff})) ==
        "a picture of 32767 x 32767 pixels, expected at most 16777216 pixels");
  CHECK(error_of(with(encoded(".png"), 16, {0, 0, 0x7f, 0xff, 0, 0, 0x7f, 0xff})) ==
        "a picture of 32767 x 32767 pixels, expected at most 16777216 pixels");
  const std::string ppm = "P6\n# wide\n32767 32767\n255\nabc";
  CHECK(error_of({ppm.begin(), ppm.end()}) ==
        "a picture of 32767 x 32767 pixels, expected at most 16777216 pixels");
  CHECK(error_of(with(encoded(".png"), 16, Bytes(8, 0xff))) ==
        "a picture of 4294967295 x 4294967295 pixels, expected at most 16777216 pixels");
  // 32767 x 32767 pixels take 3 GB.
  CHECK(peak_memory_kb() - before_kb < 50'000);
}

TEST_CASE("damaged images and data that is not an image are rejected") {
  CHECK(error_of({}) == "expected a picture in PNG, JPEG or PNM");
  CHECK(error_of(Bytes(100, 'P')) == "expected a picture in PNG, JPEG or PNM");
  CHECK(error_of(encoded(".bmp")) == "expected a picture in PNG, JPEG or PNM");
  Bytes png = encoded(".png");
  png.resize(30);
  CHECK(error_of(png) == "the picture is damaged");
  CHECK_THROWS_WITH(read_picture("/nowhere/a.png"),
                    "/nowhere/a.png: cannot be read: No such file or directory");
}

TEST_CASE("a picture that cannot be written is reported with the cause") {
  const cv::Mat3b picture(4, 4, cv::Vec3b(1, 2, 3));
  CHECK_THROWS_WITH(write_png(picture, "/dev/null/a.png"), "cannot write /dev/null/a.png: Not a directory");
  CHECK_THROWS_WITH(write_png(picture, "/dev/full"), "cannot write /dev/full: No space left on device");
}

TEST_CASE("the size that an image's header states is read without decoding the image") {
  const auto size = [](std::string_view text) -> std::string {
    const auto found = stated_size(text);
    return found ? std::to_string(found->width_px) + " x " + std::to_string(found->height_px) : "none";
  };
  CHECK(size("P5 12 9 255 ") == "12 x 9");
  CHECK(size("P2\n# 1 2\r\n 12\n#\n9") == "12 x 9");
  CHECK(size("P2\n# 1 2") == "none");
  CHECK(size("P5 12") == "none");
  CHECK(size("P5 x 9") == "none");
  CHECK(size("P5 1234567890 9") == "none");
  CHECK(size("P7 12 9") == "none");
  CHECK(size("\xff\xd8") == "none");
  CHECK(size("\xff\xd8garbage\xff\xc0") == "none");
  const Bytes jpeg = encoded(".jpg");
  for (std::size_t length = 0; length < find(jpeg, {0xff, 0xc0}); ++length)
    CHECK(size({reinterpret_cast<const char*>(jpeg.data()), length}) == "none");
}

}  // namespace sidestep::picture_test
