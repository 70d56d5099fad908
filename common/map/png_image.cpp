// SPDX-License-Identifier: Apache-2.0
#include "common/map/png_image.hpp"

#include <iterator>
#include <string>
#include <vector>

#include "common/image/png.hpp"
#include "common/image/pnm.hpp"
#include "common/map/image_size.hpp"
#include "common/map/map_grid.hpp"

namespace sidestep {
namespace {

/// Enough for 64 bits per pixel without compression.
constexpr long kMaxFileBytes = 8 * kMaxMapCells;

}  // namespace

ImageCells read_png(std::istream& file, const StateOf& state_of, UnknownCells unknown) {
  constexpr int kChannels = 4;
  if (bytes_left(file) > kMaxFileBytes) throw ImageError("the file is too large for a map");
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const RgbaImage image = decode_png(bytes, check_image_size);

  std::vector<MapCellState> states;
  for (int sum = 0; sum <= 3 * 255; ++sum) states.push_back(state_of(sum / (3 * 255.0)));
  ImageCells cells{BitGrid(image.width_px, image.height_px)};
  const std::uint8_t* pixel = image.samples.data();
  for (int row = image.height_px - 1; row >= 0; --row) {
    for (int column = 0; column < image.width_px; ++column, pixel += kChannels) {
      const auto sum = static_cast<std::size_t>(pixel[0] + pixel[1] + pixel[2]);
      set_cell(cells, column, row, pixel[3] == 255 ? states[sum] : MapCellState::kUnknown, unknown);
    }
  }
  return cells;
}

}  // namespace sidestep
