// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/image/image.hpp"
#include "common/marking/colours.hpp"
#include "vision/segmentation/colour_classes.hpp"

namespace sidestep {

/// Of boxes: the colour of what nobody named, which is neither the floor nor a colour that was learned. It
/// stands behind those of Colours.
inline constexpr std::uint32_t kOtherColour = kColours.size();

/// As files spell it. Precondition: one of Colours, or kOtherColour.
constexpr std::string_view name_of_colour(std::uint32_t colour) {
  return colour == kOtherColour ? "other" : kColours[colour].name;
}

/// A disc of one colour that is known to be in a frame.
struct KnownDisc {
  Colour colour{};
  Vec2 centre_px{0, 0};
  double radius_px = 0;

  /// Whether a pixel shows nothing else: the lens blurs the disc's edge.
  bool is_inside(int x, int y) const { return (Vec2(x, y) - centre_px).norm() <= 0.6 * radius_px; }
  /// Whether a pixel may show something of it.
  bool is_near(int x, int y) const { return (Vec2(x, y) - centre_px).norm() < 1.6 * radius_px + 3; }
};

/// Learns from frames in which is known what stands where by what numbers colours are to be told from each
/// other and from the floor.
class ColourLearner {
 public:
  /// Light may fall to this share of the least that was seen.
  explicit ColourLearner(double least_light = 0.5) : least_light_(least_light) {}

  /// The inner parts of discs are their colours; what is far from all discs is background, most of it floor.
  /// `unknown` are discs of whatever colour, of which nothing is learned.
  void add(const ImageView& image, std::span<const KnownDisc> discs, std::span<const KnownDisc> unknown = {});
  /// One pixel of a colour.
  void add(Colour colour, const Yuv& pixel) { classes_[static_cast<std::size_t>(colour)].add(pixel); }
  /// One pixel of the background.
  void add_background(const Yuv& pixel);

  /// Pixels seen of a colour so far.
  std::uint64_t seen(Colour colour) const { return classes_[static_cast<std::size_t>(colour)].count; }

  /// A box for each colour that was seen. It reaches from two fifths of the way from grey to the colour, so
  /// that patches keep their size and darker light does no harm, to the end of the range; where that comes
  /// upon another colour or the floor the border lies half way between what was seen of the two. Colours that
  /// cannot be told apart by a box keep boxes that overlap: then the first counts.
  std::vector<ColourBox> named_boxes() const;

  /// Boxes of kOtherColour for what is clearly none of the background that was seen, and not grey in light
  /// that has a colour of its own; none when no background was seen. They overlap with each other and with
  /// those of the colours, which have to count first.
  std::vector<ColourBox> other_boxes() const;

  /// Both, in the order in which they are to count.
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

  static constexpr std::size_t kBands = 3;

  double least_light_;
  std::array<Seen, kColours.size()> classes_;
  Seen background_;
  std::array<Seen, kBands> by_brightness_;  ///< the same, in bands
};

}  // namespace sidestep
