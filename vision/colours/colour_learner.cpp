// SPDX-License-Identifier: Apache-2.0
#include "vision/colours/colour_learner.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vision/colours/labelled_pixels.hpp"

namespace sidestep {
namespace {

constexpr int kGrey = 128;
constexpr int kMinChroma = 25;  // distance from grey on U or V beyond which a pixel is coloured
constexpr int kRangeMargin =
    14;  // margin around the observed range on a channel, U or V, on which a colour is nearly grey
constexpr double kEdgeShare = 0.4;  // fraction of the way from grey to a colour at which its box begins
// Weight of gaps in brightness relative to U and V, because light is uneven.
constexpr double kBrightnessWeight = 0.5;
constexpr double kOutlierShare = 0.002, kFloorOutlierShare = 0.1;

// Bands of brightness, each with its own boxes of kOtherColour.
constexpr std::array<int, 4> kBandEdges{0, 96, 160, 256};  // limits of the bands
constexpr double kGroundOutlierShare = 0.001;              // white lines cover less than 1 % of the floor
constexpr int kGroundMargin = 8;                           // margin around the observed background, on U or V
// Chroma of grey with 10 % more red or blue, as a fraction of its brightness.
constexpr double kTintShare = 0.07;
constexpr int kNoiseMargin = 4;  // margin on U or V
constexpr int kCoarseStep = 16;  // range of a high nibble, by which segmentation excludes pixels

}  // namespace

void ColourLearner::Histogram::add(const Yuv& pixel) {
  ++count;
  ++bins[0][pixel.y];
  ++bins[1][pixel.u];
  ++bins[2][pixel.v];
}

/// The quantile: the smallest value such that more than this fraction of all pixels do not exceed it.
int ColourLearner::Histogram::quantile(std::size_t channel, double share) const {
  const double target = share * static_cast<double>(count);
  std::uint64_t sum = 0;
  for (int value = 0; value < 256; ++value) {
    sum += bins[channel][static_cast<std::size_t>(value)];
    if (static_cast<double>(sum) > target) return value;
  }
  return 255;
}

ColourLearner::Ranges ColourLearner::Histogram::ranges(double outlier_share) const {
  Ranges ranges;
  for (std::size_t c = 0; c < ranges.size(); ++c)
    ranges[c] = {quantile(c, outlier_share), quantile(c, 1 - outlier_share)};
  return ranges;
}

void ColourLearner::add_background(const Yuv& pixel) {
  background_.add(pixel);
  std::size_t band = 0;
  while (pixel.y >= kBandEdges[band + 1]) ++band;
  background_bands_[band].add(pixel);
}

void ColourLearner::add(const ImageView& image, std::span<const LabelledDisc> discs,
                        std::span<const LabelledDisc> ignored) {
  for_labelled_pixels(
      image, discs, ignored,
      [&](const LabelledDisc& disc, int x, int y) { add(disc.colour, pixel_at(image, x, y)); },
      [&](int x, int y) { add_background(pixel_at(image, x, y)); });
}

/// The box of a colour before it is separated from its neighbours.
ColourLearner::Ranges ColourLearner::extended_box(const Histogram& histogram) const {
  const Ranges observed = histogram.ranges(kOutlierShare);
  Ranges box;
  box[0] = {static_cast<int>(min_light_ratio_ * observed[0].low), 255};
  for (std::size_t c = 1; c < 3; ++c) {
    const int median = histogram.quantile(c, 0.5) - kGrey, edge = static_cast<int>(kEdgeShare * median);
    if (median <= -kMinChroma) {
      box[c] = {0, std::max(observed[c].high, kGrey + edge)};
    } else if (median >= kMinChroma) {
      box[c] = {std::min(observed[c].low, kGrey + edge), 255};
    } else {
      box[c] = {observed[c].low - kRangeMargin, observed[c].high + kRangeMargin};
    }
  }
  return box;
}

/// Gap on a channel between two observed ranges: 0 if they overlap, positive if `own` is the higher range.
int ColourLearner::gap(const Range& own, const Range& other) {
  const int below = own.low - other.high, above = other.low - own.high;
  return below >= above ? std::max(0, below) : -std::max(0, above);
}

void ColourLearner::cut(Range& box, const Range& own, const Range& other) {
  const int signed_gap = gap(own, other);
  if (signed_gap > 0) box.low = std::max(box.low, (own.low + other.high) / 2 + 1);
  if (signed_gap < 0) box.high = std::min(box.high, (own.high + other.low) / 2);
}

bool ColourLearner::overlap(const Ranges& a, const Ranges& b) {
  for (std::size_t c = 0; c < a.size(); ++c) {
    if (a[c].high < b[c].low || b[c].high < a[c].low) return false;
  }
  return true;
}

/// Cuts two overlapping boxes on the channel with the widest gap between their observed ranges, if there is a
/// gap.
void ColourLearner::separate(Ranges& a, const Ranges& observed_a, Ranges& b, const Ranges& observed_b) {
  if (!overlap(a, b)) return;
  const auto weighted_gap = [&](std::size_t c) {
    return (c == 0 ? kBrightnessWeight : 1.0) * std::abs(gap(observed_a[c], observed_b[c]));
  };
  std::size_t best = 0;
  for (std::size_t c = 1; c < a.size(); ++c) {
    if (weighted_gap(c) > weighted_gap(best)) best = c;
  }
  cut(a[best], observed_a[best], observed_b[best]);
  cut(b[best], observed_b[best], observed_a[best]);
}

std::vector<ColourBox> ColourLearner::named_boxes() const {
  struct Learned {
    std::uint32_t colour;
    Ranges observed, box;
  };
  std::vector<Learned> learned;
  for (std::size_t k = 0; k < colours_.size(); ++k) {
    if (colours_[k].count > 0)
      learned.push_back(
          {static_cast<std::uint32_t>(k), colours_[k].ranges(kOutlierShare), extended_box(colours_[k])});
  }
  if (background_.count > 0) {
    // The floor covers most pixels, so boxes are cut on every channel that has a gap.
    const Ranges floor = background_.ranges(kFloorOutlierShare);
    for (Learned& one : learned) {
      for (std::size_t c = 0; c < floor.size(); ++c) cut(one.box[c], one.observed[c], floor[c]);
    }
  }
  for (std::size_t i = 0; i < learned.size(); ++i) {
    for (std::size_t j = i + 1; j < learned.size(); ++j)
      separate(learned[i].box, learned[i].observed, learned[j].box, learned[j].observed);
  }
  std::vector<ColourBox> boxes;
  for (const Learned& one : learned) {
    const auto byte = [](int value) { return static_cast<std::uint8_t>(std::clamp(value, 0, 255)); };
    const auto& [y, u, v] = one.box;
    boxes.push_back(
        {{byte(y.low), byte(u.low), byte(v.low)}, {byte(y.high), byte(u.high), byte(v.high)}, one.colour});
  }
  return boxes;
}

std::vector<ColourBox> ColourLearner::other_boxes() const {
  std::vector<ColourBox> boxes;
  if (background_.count == 0) return boxes;
  const Ranges floor = background_.ranges(kFloorOutlierShare),
               ground = background_.ranges(kGroundOutlierShare);
  for (std::size_t band = 0; band < kBands; ++band) {
    const auto darkest = static_cast<std::uint8_t>(kBandEdges[band]);
    const auto brightest = static_cast<std::uint8_t>(kBandEdges[band + 1] - 1);
    const int grey_margin = static_cast<int>(kTintShare * brightest) + kNoiseMargin;
    // The floor's chroma also appears at the edges of brighter and darker objects.
    Ranges excluded = floor;
    if (background_bands_[band].count > 0) {
      const Ranges observed = background_bands_[band].ranges(kGroundOutlierShare);
      for (std::size_t c = 1; c < 3; ++c)
        excluded[c] = {std::min(excluded[c].low, observed[c].low),
                       std::max(excluded[c].high, observed[c].high)};
    }
    for (std::size_t c = 1; c < 3; ++c) {
      excluded[c] = {std::min(excluded[c].low - kGroundMargin, kGrey - grey_margin),
                     std::max(excluded[c].high + kGroundMargin, kGrey + grey_margin)};
      // Values that share a high nibble with the floor are excluded: segmentation would otherwise have to
      // compare most pixels exactly.
      excluded[c].low = std::min(excluded[c].low, ground[c].low / kCoarseStep * kCoarseStep);
      excluded[c].high =
          std::max(excluded[c].high, floor[c].high / kCoarseStep * kCoarseStep + kCoarseStep - 1);
      const auto add = [&](int low, int high) {
        ColourBox box{{darkest, 0, 0}, {brightest, 255, 255}, kOtherColour};
        (c == 1 ? box.low.u : box.low.v) = static_cast<std::uint8_t>(low);
        (c == 1 ? box.high.u : box.high.v) = static_cast<std::uint8_t>(high);
        boxes.push_back(box);
      };
      if (excluded[c].low > 0) add(0, excluded[c].low - 1);
      if (excluded[c].high < 255) add(excluded[c].high + 1, 255);
    }
  }
  return boxes;
}

std::vector<ColourBox> ColourLearner::boxes() const {
  std::vector<ColourBox> all = named_boxes();
  const std::vector<ColourBox> others = other_boxes();
  const std::size_t free_boxes = kMaxColours - all.size();
  all.insert(all.end(), others.begin(),
             others.begin() + static_cast<std::ptrdiff_t>(std::min(free_boxes, others.size())));
  return all;
}

}  // namespace sidestep
