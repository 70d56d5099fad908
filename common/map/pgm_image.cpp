// SPDX-License-Identifier: Apache-2.0
#include "common/map/pgm_image.hpp"

#include <vector>

#include "common/image/pnm.hpp"
#include "common/map/image_size.hpp"

namespace sidestep {

ImageCells read_pgm(std::istream& file, const StateOf& state_of, UnknownCells unknown) {
  PnmReader reader(file, check_image_size);
  std::vector<MapCellState> states;
  for (int sample = 0; sample <= reader.max_sample(); ++sample)
    states.push_back(state_of(static_cast<double>(sample) / reader.max_sample()));
  ImageCells cells{BitGrid(reader.width_px(), reader.height_px())};
  std::vector<std::uint16_t> samples(static_cast<std::size_t>(reader.width_px()));
  for (int row = reader.height_px() - 1; row >= 0; --row) {
    reader.read_row(samples);
    for (int column = 0; column < reader.width_px(); ++column)
      set_cell(cells, column, row, states[samples[static_cast<std::size_t>(column)]], unknown);
  }
  return cells;
}

}  // namespace sidestep
