// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/marking/layout.hpp"

namespace sidestep {

/// A rotation about the centre marker that maps every dot to a dot of the same radius.
struct RotationalSymmetry {
  double angle_rad = 0;
  std::vector<std::size_t> permutation;  ///< the index of each dot's image
};

/// Dots closer than this coincide.
inline constexpr double kSamePosition_m = 0.001;

/// The rotational symmetries of a layout's dots, regardless of colour, by ascending angle; the first is the
/// identity. The angles are the multiples of 2 pi / n, where n is the number of symmetries. Precondition: no
/// dot overlaps another dot or the centre.
std::vector<RotationalSymmetry> rotational_symmetries(const MarkerLayout& layout);

/// The number of dots whose colour differs between `pattern` and `rotated` turned by the symmetry.
std::size_t hamming_distance(const std::vector<Colour>& pattern, const std::vector<Colour>& rotated,
                             const RotationalSymmetry& symmetry);

}  // namespace sidestep
