// SPDX-License-Identifier: Apache-2.0
#include "tests/study/camera/camera_picture.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "common/image/picture.hpp"
#include "tests/study/camera/first_view.hpp"

namespace sidestep {
namespace {

const cv::Scalar kBlocked(90, 90, 200), kDiamond(255, 255, 255), kOnCells(40, 150, 255),
    kOnGraph(255, 200, 60);

cv::Point point(const Vec2& pixel) {
  return {static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))};
}

void draw_cells(const PixelCells& cells, cv::Mat3b& picture) {
  cv::Mat3b tinted = picture.clone();
  for (int row = 0; row < cells.blocked.rows(); ++row) {
    for (int column = 0; column < cells.blocked.columns(); ++column) {
      const int side = cells.cell_px;
      const cv::Rect square(column * side, row * side, side - 1, side - 1);
      if (cells.blocked.get(column, row)) cv::rectangle(tinted, square, kBlocked, cv::FILLED);
    }
  }
  cv::addWeighted(tinted, 0.35, picture, 0.65, 0, picture);
}

void draw_line(const std::vector<Vec2>& points, bool is_closed, const cv::Scalar& ink, cv::Mat3b& picture) {
  std::vector<cv::Point> line;
  for (const Vec2& p : points) line.push_back(point(p));
  cv::polylines(picture, std::vector<std::vector<cv::Point>>{line}, is_closed, ink, is_closed ? 1 : 2,
                cv::LINE_AA);
}

}  // namespace

void write_camera_picture(std::uint64_t seed, const std::string& path) {
  FirstView view(seed);
  const PixelPaths paths = view.guide().plan_all();
  cv::Mat3b picture = bgr_of(view.image().view());
  draw_cells(view.guide().cells(), picture);
  for (const ObstacleBlob& blob : view.guide().blobs().obstacles)
    draw_line(std::vector<Vec2>(blob.diamond.begin(), blob.diamond.end()), true, kDiamond, picture);
  draw_line(paths[static_cast<std::size_t>(PixelPlanner::kCells)], false, kOnCells, picture);
  draw_line(paths[static_cast<std::size_t>(PixelPlanner::kDiamonds)], false, kOnGraph, picture);
  write_png(picture, path);
}

}  // namespace sidestep
