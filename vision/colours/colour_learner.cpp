// SPDX-License-Identifier: Apache-2.0
#include "vision/colours/colour_learner.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vision/colours/known_pixels.hpp"

namespace sidestep {
namespace {

constexpr int kGrey = 128;
constexpr int kColourful = 25;  // from grey, on U or V; less does not tell a colour
constexpr int kSpread = 14;     // beyond what was seen, on U and V, of a number that is not colourful
constexpr double kEdge = 0.4;   // of the way from grey to a colour: there a patch ends
constexpr double kTrust = 0.5;  // in brightness, against U and V: light is uneven
constexpr double kOutliers = 0.002, kFloorOutliers = 0.1;

// Of other colours.
constexpr std::array<int, 4> kBandEdges{0, 96, 160, 256};  // of brightness
constexpr double kGroundOutliers = 0.001;  // white lines are less than a hundredth of the floor
constexpr int kClear = 8;                  // from the background that was seen, on U or V
constexpr double kTint = 0.07;             // of the brightness: what a tenth more red or blue makes of grey
constexpr int kNoise = 4;                  // and noise, on U or V
constexpr int kCoarse = 16;                // segmentation rules out a sixteenth of the range at once

}  // namespace

void ColourLearner::Seen::add(const Yuv& pixel) {
  ++count;
  ++of[0][pixel.y];
  ++of[1][pixel.u];
  ++of[2][pixel.v];
}

/// The number that this share of all pixels does not exceed.
int ColourLearner::Seen::at(std::size_t channel, double share) const {
  const double wanted = share * static_cast<double>(count);
  std::uint64_t sum = 0;
  for (int value = 0; value < 256; ++value) {
    sum += of[channel][static_cast<std::size_t>(value)];
    if (static_cast<double>(sum) > wanted) return value;
  }
  return 255;
}

ColourLearner::Ranges ColourLearner::Seen::ranges(double left_out) const {
  Ranges ranges;
  for (std::size_t c = 0; c < ranges.size(); ++c) ranges[c] = {at(c, left_out), at(c, 1 - left_out)};
  return ranges;
}

void ColourLearner::add_background(const Yuv& pixel) {
  background_.add(pixel);
  std::size_t band = 0;
  while (pixel.y >= kBandEdges[band + 1]) ++band;
  by_brightness_[band].add(pixel);
}

void ColourLearner::add(const ImageView& image, std::span<const KnownDisc> discs,
                        std::span<const KnownDisc> unknown) {
  for_known_pixels(
      image, discs, unknown,
      [&](const KnownDisc& disc, int x, int y) { add(disc.colour, pixel_at(image, x, y)); },
      [&](int x, int y) { add_background(pixel_at(image, x, y)); });
}

ColourLearner::Ranges ColourLearner::generous(const Seen& seen) const {
  const Ranges own = seen.ranges(kOutliers);
  Ranges box;
  box[0] = {static_cast<int>(least_light_ * own[0].low), 255};
  for (std::size_t c = 1; c < 3; ++c) {
    const int middle = seen.at(c, 0.5) - kGrey, edge = static_cast<int>(kEdge * middle);
    if (middle <= -kColourful) {
      box[c] = {0, std::max(own[c].high, kGrey + edge)};
    } else if (middle >= kColourful) {
      box[c] = {std::min(own[c].low, kGrey + edge), 255};
    } else {
      box[c] = {own[c].low - kSpread, own[c].high + kSpread};
    }
  }
  return box;
}

/// Room on a channel between what was seen of two colours: below 0 none; positive where `own` lies above.
int ColourLearner::gap(const Range& own, const Range& other) {
  const int below = own.low - other.high, above = other.low - own.high;
  return below >= above ? std::max(0, below) : -std::max(0, above);
}

void ColourLearner::cut(Range& box, const Range& own, const Range& other) {
  const int room = gap(own, other);
  if (room > 0) box.low = std::max(box.low, (own.low + other.high) / 2 + 1);
  if (room < 0) box.high = std::min(box.high, (own.high + other.low) / 2);
}

bool ColourLearner::overlap(const Ranges& a, const Ranges& b) {
  for (std::size_t c = 0; c < a.size(); ++c) {
    if (a[c].high < b[c].low || b[c].high < a[c].low) return false;
  }
  return true;
}

/// Where two boxes overlap, draws the border between them where there is most room between what was seen of
/// their colours; where there is none they stay as they are.
void ColourLearner::separate(Ranges& a, const Ranges& seen_a, Ranges& b, const Ranges& seen_b) {
  if (!overlap(a, b)) return;
  const auto room = [&](std::size_t c) {
    return (c == 0 ? kTrust : 1.0) * std::abs(gap(seen_a[c], seen_b[c]));
  };
  std::size_t best = 0;
  for (std::size_t c = 1; c < a.size(); ++c) {
    if (room(c) > room(best)) best = c;
  }
  cut(a[best], seen_a[best], seen_b[best]);
  cut(b[best], seen_b[best], seen_a[best]);
}

std::vector<ColourBox> ColourLearner::named_boxes() const {
  struct Learned {
    std::uint32_t colour;
    Ranges seen, box;
  };
  std::vector<Learned> learned;
  for (std::size_t k = 0; k < classes_.size(); ++k) {
    if (classes_[k].count > 0)
      learned.push_back(
          {static_cast<std::uint32_t>(k), classes_[k].ranges(kOutliers), generous(classes_[k])});
  }
  if (background_.count > 0) {
    // There is so much of the floor that every border that can be drawn is.
    const Ranges floor = background_.ranges(kFloorOutliers);
    for (Learned& one : learned) {
      for (std::size_t c = 0; c < floor.size(); ++c) cut(one.box[c], one.seen[c], floor[c]);
    }
  }
  for (std::size_t i = 0; i < learned.size(); ++i) {
    for (std::size_t j = i + 1; j < learned.size(); ++j)
      separate(learned[i].box, learned[i].seen, learned[j].box, learned[j].seen);
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
  const Ranges floor = background_.ranges(kFloorOutliers), ground = background_.ranges(kGroundOutliers);
  for (std::size_t band = 0; band < kBands; ++band) {
    const auto darkest = static_cast<std::uint8_t>(kBandEdges[band]);
    const auto brightest = static_cast<std::uint8_t>(kBandEdges[band + 1] - 1);
    const int grey = static_cast<int>(kTint * brightest) + kNoise;
    // The floor shines through at the edges of what is brighter or darker.
    Ranges none = floor;
    if (by_brightness_[band].count > 0) {
      const Ranges seen = by_brightness_[band].ranges(kGroundOutliers);
      for (std::size_t c = 1; c < 3; ++c)
        none[c] = {std::min(none[c].low, seen[c].low), std::max(none[c].high, seen[c].high)};
    }
    for (std::size_t c = 1; c < 3; ++c) {
      none[c] = {std::min(none[c].low - kClear, kGrey - grey), std::max(none[c].high + kClear, kGrey + grey)};
      // Nothing in the floor's sixteenth of the range is another colour, or segmentation would lose its
      // speed.
      none[c].low = std::min(none[c].low, ground[c].low / kCoarse * kCoarse);
      none[c].high = std::max(none[c].high, floor[c].high / kCoarse * kCoarse + kCoarse - 1);
      const auto add = [&](int low, int high) {
        ColourBox box{{darkest, 0, 0}, {brightest, 255, 255}, kOtherColour};
        (c == 1 ? box.low.u : box.low.v) = static_cast<std::uint8_t>(low);
        (c == 1 ? box.high.u : box.high.v) = static_cast<std::uint8_t>(high);
        boxes.push_back(box);
      };
      if (none[c].low > 0) add(0, none[c].low - 1);
      if (none[c].high < 255) add(none[c].high + 1, 255);
    }
  }
  return boxes;
}

std::vector<ColourBox> ColourLearner::boxes() const {
  std::vector<ColourBox> all = named_boxes();
  const std::vector<ColourBox> others = other_boxes();
  const std::size_t room = kMaxColours - all.size();
  all.insert(all.end(), others.begin(),
             others.begin() + static_cast<std::ptrdiff_t>(std::min(room, others.size())));
  return all;
}

}  // namespace sidestep
