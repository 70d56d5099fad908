// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/image/image.hpp"
#include "common/marking/colours.hpp"
#include "vision/segmentation/colour_classes.hpp"

namespace sidestep {

/// A disc of one colour that is known to be in a frame.
struct KnownDisc {
  Colour colour{};
  Vec2 centre_px{0, 0};
  double radius_px = 0;
};

/// Learns from frames in which is known what stands where by what numbers colours are to be told from each
/// other and from the floor.
class ColourLearner {
 public:
  /// The inner parts of discs are their colours; what is far from all discs is background, most of it floor.
  void add(const ImageView& image, std::span<const KnownDisc> discs);

  /// Pixels seen of a colour so far.
  std::uint64_t seen(Colour colour) const { return classes_[static_cast<std::size_t>(colour)].count; }

  /// A box for each colour that was seen. It reaches from two fifths of the way from grey to the colour, so
  /// that patches keep their size and darker light does no harm, to the end of the range; where that comes
  /// upon another colour or the floor the border lies half way between what was seen of the two. Colours that
  /// cannot be told apart by a box keep boxes that overlap: then the first counts.
  std::vector<ColourBox> boxes() const;

 private:
  struct Range {
    int low = 0, high = 0;
  };
  using Ranges = std::array<Range, 3>;  ///< of Y, U and V
  struct Seen {
    std::uint64_t count = 0;
    std::array<std::array<std::uint64_t, 256>, 3> of{};  ///< by number, of Y, U and V

    void add(const Yuv& pixel);
    int at(std::size_t channel, double share) const;
    Ranges ranges(double left_out) const;
  };

  Ranges generous(const Seen& seen) const;
  static int gap(const Range& own, const Range& other);
  static void cut(Range& box, const Range& own, const Range& other);
  static bool overlap(const Ranges& a, const Ranges& b);
  static void separate(Ranges& a, const Ranges& seen_a, Ranges& b, const Ranges& seen_b);

  std::array<Seen, kColours.size()> classes_;
  Seen background_;
};

}  // namespace sidestep
