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

/// Colour number of boxes for everything that is neither the floor nor a learned colour. It follows the
/// numbers of Colour.
inline constexpr std::uint32_t kOtherColour = kColours.size();

/// The name used in files. Precondition: the number of a Colour, or kOtherColour.
constexpr std::string_view name_of_colour(std::uint32_t colour) {
  return colour == kOtherColour ? "other" : kColours[colour].name;
}

/// A disc of one colour whose position in a frame is known.
struct LabelledDisc {
  Colour colour{};
  Vec2 centre_px{0, 0};
  double radius_px = 0;

  /// Whether a pixel shows only the disc; the lens blurs its edge.
  bool is_inside(int x, int y) const { return (Vec2(x, y) - centre_px).norm() <= 0.6 * radius_px; }
  /// Whether a pixel may show part of the disc.
  bool is_near(int x, int y) const { return (Vec2(x, y) - centre_px).norm() < 1.6 * radius_px + 3; }
};

/// Learns thresholds that separate colours from each other and from the floor, from frames with labelled
/// discs.
class ColourLearner {
 public:
  /// Colours are recognised in light down to `min_light_ratio` of the darkest light observed.
  explicit ColourLearner(double min_light_ratio = 0.5) : min_light_ratio_(min_light_ratio) {}

  /// Adds a frame. The inner parts of `discs` show their colours; pixels far from all discs are background,
  /// mostly floor. Pixels near the discs in `ignored` are skipped.
  void add(const ImageView& image, std::span<const LabelledDisc> discs,
           std::span<const LabelledDisc> ignored = {});
  void add(Colour colour, const Yuv& pixel) { colours_[static_cast<std::size_t>(colour)].add(pixel); }
  void add_background(const Yuv& pixel);

  /// One box per observed colour. A box starts at two fifths of the way from grey to the colour, so that
  /// regions keep their size and darker light is tolerated, and extends to the end of the channel. Towards
  /// another colour or the floor, a box ends midway between the observed ranges. If two colours cannot be
  /// separated, their boxes overlap, and the first one wins.
  [[nodiscard]] std::vector<ColourBox> named_boxes() const;

  /// Boxes of kOtherColour for everything clearly outside the observed background and not grey in tinted
  /// light; empty if no background was observed. The boxes overlap each other and the named boxes, which must
  /// come first.
  [[nodiscard]] std::vector<ColourBox> other_boxes() const;

  /// Named boxes, followed by other boxes up to kMaxColours.
  [[nodiscard]] std::vector<ColourBox> boxes() const;

 private:
  struct Range {
    int low = 0, high = 0;
  };
  using Ranges = std::array<Range, 3>;  ///< of Y, U and V
  struct Histogram {
    std::uint64_t count = 0;
    std::array<std::array<std::uint64_t, 256>, 3> bins{};  ///< of Y, U and V

    void add(const Yuv& pixel);
    int quantile(std::size_t channel, double share) const;
    Ranges ranges(double outlier_share) const;
  };

  Ranges extended_box(const Histogram& histogram) const;
  static int gap(const Range& own, const Range& other);
  static void cut(Range& box, const Range& own, const Range& other);
  static bool overlap(const Ranges& a, const Ranges& b);
  static void separate(Ranges& a, const Ranges& observed_a, Ranges& b, const Ranges& observed_b);

  static constexpr std::size_t kBands = 3;

  double min_light_ratio_;
  std::array<Histogram, kColours.size()> colours_;
  Histogram background_;
  /// Histograms of the background, indexed by brightness band.
  std::array<Histogram, kBands> background_bands_;
};

}  // namespace sidestep
