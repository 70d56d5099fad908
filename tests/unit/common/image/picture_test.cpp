// SPDX-License-Identifier: Apache-2.0
#include "common/image/picture.hpp"

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <sys/resource.h>
#include <turbojpeg.h>

#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "tests/capture_output.hpp"
#include "tests/catch.hpp"

namespace sidestep::picture_test {

using namespace std::string_literals;

/// The largest difference between samples of a JPEG image that two versions of its library read or write.
constexpr int kJpegTolerance = 3;

/// A picture with a different colour in every pixel.
cv::Mat3b gradient(int width_px = 12, int height_px = 9) {
  cv::Mat3b picture(height_px, width_px);
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      picture(y, x) =
          cv::Vec3b(static_cast<std::uint8_t>(20 * x), static_cast<std::uint8_t>(90 + 2 * x + 3 * y),
                    static_cast<std::uint8_t>(25 * y));
  return picture;
}

std::string encoded(const char* extension, const std::vector<int>& settings = {},
                    const cv::Mat& picture = gradient()) {
  std::vector<std::uint8_t> bytes;
  REQUIRE(cv::imencode(extension, picture, bytes, settings));
  return {bytes.begin(), bytes.end()};
}

cv::Mat3b decoded_by_opencv(const std::string& bytes) {
  return cv::imdecode(std::vector<std::uint8_t>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
}

cv::Mat3b read(const std::string& bytes) {
  const TemporaryFolder folder;
  write_file(folder.file("picture"), bytes);
  return bgr_of(read_picture(folder.file("picture")).view());
}

/// The largest difference between a sample that read_picture() and OpenCV read.
int difference(const cv::Mat3b& read, const cv::Mat3b& expected) {
  REQUIRE(read.size() == expected.size());
  return static_cast<int>(cv::norm(read, expected, cv::NORM_INF));
}
int difference(const std::string& bytes) { return difference(read(bytes), decoded_by_opencv(bytes)); }

/// Why a picture is refused; empty if it is not.
std::string error_of(const std::string& bytes) {
  const TemporaryFolder folder;
  const std::string path = folder.file("picture");
  write_file(path, bytes);
  try {
    static_cast<void>(read_picture(path));
    return "";
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    REQUIRE(text.starts_with(path + ": "));
    return text.substr(path.size() + 2);
  }
}

/// Replaces the bytes from a given position on.
std::string with(std::string bytes, std::size_t at, const std::string& others) {
  return bytes.replace(at, others.size(), others);
}

long peak_memory_kb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

/// A PNG image whose header states another size, with the checksum that belongs to it.
std::string with_png_size(const std::string& size) {
  constexpr std::size_t kHeader = 12, kChecksum = 29;
  const std::string png = with(encoded(".png"), kHeader + 4, size);
  std::uint32_t crc = 0xffffffff;
  for (const char c : png.substr(kHeader, kChecksum - kHeader)) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xedb88320 ^ (crc >> 1) : crc >> 1;
  }
  std::string checksum(4, '\0');
  for (std::size_t i = 0; i < 4; ++i) checksum[i] = static_cast<char>(~crc >> (24 - 8 * i));
  return with(png, kChecksum, checksum);
}

TEST_CASE("PNG, PGM and PPM images are read exactly as OpenCV reads them") {
  const cv::Mat grey(9, 12, CV_8U, cv::Scalar(77));
  CHECK(difference(encoded(".png")) == 0);
  CHECK(difference(encoded(".png", {}, grey)) == 0);
  CHECK(difference(encoded(".png", {cv::IMWRITE_PNG_BILEVEL, 1}, grey)) == 0);
  CHECK(difference(encoded(".ppm")) == 0);
  CHECK(difference(encoded(".ppm", {cv::IMWRITE_PXM_BINARY, 0})) == 0);
  CHECK(difference(encoded(".pgm", {}, grey)) == 0);
  CHECK(difference(encoded(".pgm", {cv::IMWRITE_PXM_BINARY, 0}, grey)) == 0);
}

TEST_CASE("transparency of a picture is ignored") {
  cv::Mat4b picture(9, 12);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      picture(y, x) =
          cv::Vec4b(static_cast<std::uint8_t>(20 * x), 90, 200, static_cast<std::uint8_t>(31 * y));
  CHECK(difference(encoded(".png", {}, picture)) == 0);
}

TEST_CASE("samples of 16 bits are rounded to 8") {
  cv::Mat wide(9, 12, CV_16UC3);
  for (int y = 0; y < wide.rows; ++y)
    for (int x = 0; x < wide.cols; ++x)
      wide.at<cv::Vec3w>(y, x) = cv::Vec3w(static_cast<std::uint16_t>(5'000 * x), 30'123, 65'535);
  for (const char* const extension : {".png", ".ppm"}) {
    const cv::Mat3b picture = read(encoded(extension, {}, wide));
    CHECK(picture(4, 7) == cv::Vec3b(136, 117, 255));  // 136.19, 117.2
    CHECK(picture(8, 0)[0] == 0);
  }
}

TEST_CASE("samples up to another maximum are scaled") {
  CHECK(read("P3\n# a comment\n1 1 7\n0 7 2")(0, 0) == cv::Vec3b(73, 255, 0));
  CHECK(read("P5 2 1 1\n\0\1"s)(0, 1) == cv::Vec3b(255, 255, 255));
}

TEST_CASE("JPEG images are read as OpenCV reads them") {
  const cv::Mat3b large = gradient(97, 61);
  CHECK(difference(encoded(".jpg")) <= kJpegTolerance);
  CHECK(difference(encoded(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1}, large)) <= kJpegTolerance);
  CHECK(difference(encoded(".jpg", {cv::IMWRITE_JPEG_QUALITY, 30}, large)) <= kJpegTolerance);
  CHECK(difference(encoded(".jpg", {cv::IMWRITE_JPEG_RST_INTERVAL, 2}, large)) <= kJpegTolerance);
  CHECK(difference(encoded(".jpg", {}, cv::Mat(9, 12, CV_8U, cv::Scalar(77)))) <= kJpegTolerance);
}

TEST_CASE("JPEG images in CMYK are refused") {
  const std::vector<std::uint8_t> pixels(std::size_t{4} * 12 * 9, 100);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  const tjhandle turbo = tjInitCompress();
  REQUIRE(tjCompress2(turbo, pixels.data(), 12, 0, 9, TJPF_CMYK, &data, &size, TJSAMP_444, 90, 0) == 0);
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  tjFree(data);
  tjDestroy(turbo);
  CHECK(error_of(bytes) == "it is a JPEG image in CMYK, expected colour or grey");
}

TEST_CASE("written pictures are read by OpenCV") {
  const TemporaryFolder folder;
  const cv::Mat3b picture = gradient(41, 30);
  const cv::Mat3b part = picture(cv::Rect(3, 2, 30, 20));  // rows are not contiguous
  for (const cv::Mat3b& written : {picture, part}) {
    write_png(written, folder.file("a.png"));
    CHECK(difference(cv::imread(folder.file("a.png")), written) == 0);
    CHECK(difference(decoded_by_opencv(jpeg_of(written)), decoded_by_opencv(encoded(".jpg", {}, written))) <=
          kJpegTolerance);
  }
  CHECK_THROWS_WITH(write_png(cv::Mat3b(), folder.file("b.png")),
                    ContainsSubstring("the picture has no pixels"));
  CHECK_THROWS_AS(jpeg_of(cv::Mat3b()), std::runtime_error);
}

TEST_CASE("an image whose header states a huge size is rejected before memory is allocated") {
  const std::string huge = "a picture of 32767 x 32767 pixels, expected at most 16777216 pixels";
  const long before_kb = peak_memory_kb();
  const std::string jpeg = encoded(".jpg");
  const std::size_t frame = jpeg.find("\xff\xc0");
  REQUIRE(frame != std::string::npos);
  CHECK(error_of(with(jpeg, frame + 5, "\x7f\xff\x7f\xff")) == huge);
  CHECK(error_of(with_png_size("\0\0\x7f\xff\0\0\x7f\xff"s)) == huge);
  CHECK(error_of("P6\n# wide\n32767 32767\n255\nabc") == huge);
  CHECK(error_of("P2 32767 32767 255 1") == huge);
  CHECK_THAT(error_of(with_png_size(std::string(8, '\xff'))), StartsWith("it is not a valid PNG image"));
  CHECK_THAT(error_of(with_png_size("\0\0\x0f\xff\0\0\x0f\xff"s)), ContainsSubstring("truncated"));
  CHECK_THAT(error_of("P6 4095 4095 255\nabc"), ContainsSubstring("truncated"));
  // 32767 x 32767 pixels take 3 GB.
  CHECK(peak_memory_kb() - before_kb < 50'000);
}

TEST_CASE("data that is not an image is rejected") {
  const std::string other = "expected a picture in PNG, JPEG, PGM or PPM";
  CHECK(error_of("") == other);
  CHECK(error_of("P") == other);
  CHECK(error_of(std::string(100, 'P')) == other);
  CHECK(error_of(encoded(".bmp")) == other);
  CHECK(error_of("P4 8 1 \1") == other);
  CHECK(error_of("P5 0 9 255 ") == "the picture has no pixels");
  CHECK_THROWS_WITH(read_picture("/nowhere/a.png"),
                    "/nowhere/a.png: cannot be read: No such file or directory");
}

TEST_CASE("truncated images are rejected without a message of the library") {
  const CaptureStderr captured;
  const auto check = [](const std::string& bytes, std::size_t unneeded) {
    for (std::size_t size = 2; size + unneeded < bytes.size(); ++size) {
      CAPTURE(size);
      CHECK_THAT(error_of(bytes.substr(0, size)), StartsWith("it "));
    }
  };
  check(encoded(".png"), 16);  // the checksum of the pixels and the last chunk
  check(encoded(".jpg"), 2);   // the marker of the end
  check(encoded(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1}), 2);
  check(encoded(".ppm"), 0);
  check("P2 2 1 255 10 200", 3);
  CHECK(captured.text().empty());
}

TEST_CASE("damaged images are rejected or read, without a message of the library") {
  const CaptureStderr captured;
  for (const std::string& bytes : {encoded(".png"), encoded(".jpg"), encoded(".ppm")}) {
    for (std::size_t at = 2; at < bytes.size(); ++at) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
      static_cast<void>(error_of(damaged));
    }
  }
  CHECK(captured.text().empty());
  std::string png = encoded(".png");
  png[png.find("IDAT") + 8] ^= 0x55;
  CHECK_THAT(error_of(png), StartsWith("it is not a valid PNG image"));
  CHECK(error_of("P2 2 1 7 1 8") == "a pixel is 8, but its maximum sample is 7");
}

TEST_CASE("a picture that cannot be written is reported with the cause") {
  const cv::Mat3b picture(4, 4, cv::Vec3b(1, 2, 3));
  CHECK_THROWS_WITH(write_png(picture, "/dev/null/a.png"), "cannot write /dev/null/a.png: Not a directory");
  CHECK_THROWS_WITH(write_png(picture, "/dev/full"), "cannot write /dev/full: No space left on device");
}

}  // namespace sidestep::picture_test
