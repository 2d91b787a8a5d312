// SPDX-License-Identifier: Apache-2.0
#include "marker1d/blink_code.h"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "marker1d/blink_tracker.h"
#include "marker1d/marker_identity.h"

namespace alidade {
namespace {

TEST(CyclicDistance, IsThatOfTheNearestShift) {
  EXPECT_EQ(cyclic_distance("1100", "0110"), 0);
  EXPECT_EQ(cyclic_distance("1100", "1010"), 2);
  EXPECT_EQ(cyclic_distance("1111", "0000"), 4);
  EXPECT_EQ(cyclic_distance("1100"), 2);
  EXPECT_EQ(cyclic_distance("1010"), 0);
  EXPECT_THROW(cyclic_distance("110", "1100"), std::invalid_argument);
  EXPECT_THROW(cyclic_distance(""), std::invalid_argument);
}

std::size_t longest_dark(std::string code) {
  code += code;
  std::size_t longest = 0, run = 0;
  for (const char sign : code) {
    run = sign == '0' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

TEST(BlinkCodes, RemainApartUnderAllShifts) {
  for (const int count : {1, 2, 4, 8, 16}) {
    const auto codes = blink_codes(count);
    ASSERT_EQ(codes.size(), static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < codes.size(); ++i) {
      EXPECT_EQ(codes[i].size(), codes.front().size());
      EXPECT_GE(cyclic_distance(codes[i]), 4) << codes[i];
      EXPECT_LE(longest_dark(codes[i]), 2u) << codes[i];
      for (std::size_t k = 0; k < i; ++k) EXPECT_GE(cyclic_distance(codes[i], codes[k]), 4) << codes[i] << codes[k];
    }
  }
}

TEST(BlinkCodes, AreThoseOfTheDocumentation) {
  const std::vector<std::string> expected{"1111101011110", "1111111100110", "1110010110110", "1110110011100"};
  EXPECT_EQ(blink_codes(4), expected);
}

TEST(BlinkCodes, WithImpossibleWishesThrow) {
  EXPECT_THROW(blink_codes(0), std::invalid_argument);
  EXPECT_THROW(blink_codes(4, {0, 2}), std::invalid_argument);
  EXPECT_THROW(blink_codes(4, {12, 2}), std::invalid_argument);
}

MarkerSign sign(int id, const char* code) {
  MarkerSign s;
  s.id = id;
  s.code = code;
  return s;
}

TEST(FindFaultOfSigns, SaysWhatIsImpossible) {
  const auto fault_of = [](std::vector<MarkerSign> signs) { return find_fault(signs).value_or("none"); };
  EXPECT_EQ(fault_of({sign(1, "110"), sign(2, "11010")}), "none");
  EXPECT_EQ(fault_of({}), "there is no marker");
  EXPECT_EQ(fault_of({sign(3, "10x")}), "marker 3: the code must consist of 1 to 1024 signs 0 and 1, got '10x'");
  EXPECT_EQ(fault_of({sign(3, "")}), "marker 3: the code must consist of 1 to 1024 signs 0 and 1, got ''");
  EXPECT_EQ(fault_of({sign(3, "000")}), "marker 3: the code is never lit");
  EXPECT_EQ(fault_of({sign(3, "110"), sign(3, "11010")}), "marker 3 is listed twice");
  EXPECT_EQ(fault_of({sign(1, "1100"), sign(2, "0110")}),
            "markers 1 and 2 cannot be told apart: codes '1100' and '0110'");
  EXPECT_EQ(fault_of({sign(1, "10"), sign(2, "1010")}), "markers 1 and 2 cannot be told apart: codes '10' and '1010'");
  MarkerSign late = sign(2, "1100");
  late.phase = 4;
  EXPECT_EQ(fault_of({late}), "marker 2: the phase must be 0 to 3, got 4");
}

TEST(FindFaultOfSigns, TellsEqualCodesApartByPhaseOrColour) {
  MarkerSign a = sign(1, "1100"), b = sign(2, "1100");
  a.phase = 0;
  b.phase = 1;
  EXPECT_FALSE(find_fault(std::vector{a, b}));
  b.phase = 0;
  EXPECT_TRUE(find_fault(std::vector{a, b}));
  a.colour = {1.0, 0.0, 0.0};
  b.colour = {0.0, 0.0, 2.0};
  EXPECT_FALSE(find_fault(std::vector{a, b}));
  b.colour = {3.0, 0.0, 0.0};
  EXPECT_TRUE(find_fault(std::vector{a, b}));
  b.colour = {0.0, 0.0, 0.0};
  EXPECT_TRUE(find_fault(std::vector{a, b}));
}

TEST(MarkerHypotheses, KnowACodeAfterOnePeriod) {
  const auto codes = blink_codes(4);
  std::vector<MarkerSign> signs;
  for (std::size_t i = 0; i < codes.size(); ++i) signs.push_back(sign(static_cast<int>(i), codes[i].c_str()));
  const MarkerHypotheses hypotheses(signs);
  for (std::size_t m = 0; m < codes.size(); ++m) {
    for (std::size_t phase = 0; phase < codes[m].size(); ++phase) {
      IdentityBelief belief = hypotheses.unknown();
      for (std::size_t row = 0; row < codes[m].size(); ++row) {
        const bool lit = codes[m][(phase + row) % codes[m].size()] == '1';
        const auto r = static_cast<std::int64_t>(row);
        belief = lit ? hypotheses.after_seen(belief, r, {}) : hypotheses.after_dark(belief, r);
      }
      EXPECT_EQ(hypotheses.most_likely(belief).marker, static_cast<int>(m));
      EXPECT_GT(hypotheses.most_likely(belief).probability, 0.99);
      EXPECT_NEAR(belief.sum(), 1.0, 1e-12);
    }
  }
}

// Peaks of markers that move along a line and blink, without an image.
struct MovingMarker {
  double start_px, speed_px;
  std::size_t sign;
  int phase;
};

struct Score {
  int lit = 0, right = 0, wrong = 0;
};

Score follow(const std::vector<MovingMarker>& markers, const std::vector<MarkerSign>& signs, int rows) {
  BlinkTracker tracker(signs);
  Score score;
  const auto position = [](const MovingMarker& m, std::int64_t row) {
    return m.start_px + m.speed_px * static_cast<double>(row);
  };
  for (int row = 0; row < rows; ++row) {
    std::vector<LinePeak> peaks;
    for (const MovingMarker& m : markers) {
      const std::string& code = signs[m.sign].code;
      if (code[static_cast<std::size_t>(row + m.phase) % code.size()] != '1') continue;
      ++score.lit;
      LinePeak peak;
      peak.position_px = position(m, row);
      peak.sigma_px = 0.1;
      const bool is_merged = !peaks.empty() && std::abs(peaks.back().position_px - peak.position_px) < 2.0;
      if (is_merged) {
        peaks.back().position_px = 0.5 * (peaks.back().position_px + peak.position_px);
      } else {
        peaks.push_back(peak);
      }
    }
    for (const IdentifiedPeak& found : tracker.advance(row, peaks)) {
      const auto truth = std::find_if(markers.begin(), markers.end(),
                                      [&](const MovingMarker& m) { return signs[m.sign].id == found.marker; });
      const bool is_right = std::abs(position(*truth, found.row) - found.peak.position_px) < 0.5;
      ++(is_right ? score.right : score.wrong);
    }
  }
  return score;
}

std::vector<MarkerSign> four_signs() {
  std::vector<MarkerSign> signs;
  for (const std::string& code : blink_codes(4))
    signs.push_back(sign(static_cast<int>(signs.size()) + 10, code.c_str()));
  return signs;
}

TEST(BlinkTracker, NamesTheSpotsOfMarkersThatKeepApart) {
  const Score score =
      follow({{100, 4.0, 0, 3}, {400, -1.5, 1, 0}, {700, 0.0, 2, 7}, {1000, -6.0, 3, 11}}, four_signs(), 100);
  EXPECT_EQ(score.wrong, 0);
  EXPECT_GE(score.right, 0.97 * score.lit);
}

TEST(BlinkTracker, KeepsTheNamesOfMarkersThatCross) {
  for (const double speed : {0.2, 0.5, 1.0, 3.0}) {
    for (int phase = 0; phase < 13; ++phase) {
      const Score score = follow({{1000 - 100 * speed, speed, 0, phase}, {1000, 0.0, 1, 5}}, four_signs(), 200);
      EXPECT_EQ(score.wrong, 0) << "speed " << speed << ", phase " << phase;
      EXPECT_GE(score.right, 0.8 * score.lit) << "speed " << speed << ", phase " << phase;
    }
  }
}

TEST(BlinkTracker, KeepsTheNamesOfMarkersThatMeetAndPart) {
  // They touch and go back: by position alone the same as crossing.
  auto signs = four_signs();
  BlinkTracker tracker(signs);
  int wrong = 0, right = 0;
  for (int row = 0; row < 200; ++row) {
    const double apart = 2.5 + std::abs(row - 100) * 0.3;
    const double position[2] = {500.0 - apart, 500.0 + apart};
    std::vector<LinePeak> peaks;
    for (std::size_t m = 0; m < 2; ++m) {
      if (signs[m].code[static_cast<std::size_t>(row) % signs[m].code.size()] != '1') continue;
      LinePeak peak;
      peak.position_px = position[m];
      peak.sigma_px = 0.1;
      peaks.push_back(peak);
    }
    for (const IdentifiedPeak& found : tracker.advance(row, peaks)) {
      ++((found.marker == signs[0].id) == (found.peak.position_px < 500.0) ? right : wrong);
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(right, 230);
}

TEST(BlinkTracker, SaysNothingOfALightThatBlinksLikeNoMarker) {
  BlinkTracker tracker({sign(1, "1111111011"), sign(2, "1110010110")});  // the first is nearly a lamp
  LinePeak lamp;
  lamp.position_px = 300.0;
  lamp.sigma_px = 0.1;
  std::size_t named = 0;
  for (int row = 0; row < 300; ++row) named += tracker.advance(row, {&lamp, 1}).size();
  EXPECT_EQ(named, 0u);
  EXPECT_EQ(tracker.seen(), 300);
  EXPECT_EQ(tracker.identified(), 0);
}

TEST(BlinkTracker, SaysNothingOfAMarkerAndItsReflection) {
  const auto signs = four_signs();
  const Score score = follow({{100, 1.0, 0, 3}, {900, -1.0, 0, 3}}, signs, 100);
  EXPECT_EQ(score.right + score.wrong, 0);
}

TEST(BlinkTracker, RefusesRowsThatGoBackAndImpossibleOptions) {
  BlinkTracker tracker(four_signs());
  tracker.advance(5, {});
  EXPECT_THROW(tracker.advance(5, {}), std::invalid_argument);
  EXPECT_NO_THROW(tracker.advance(1000000, {}));
  BlinkTrackerOptions options;
  options.certainty = 1.0;
  EXPECT_THROW(BlinkTracker(four_signs(), options), std::invalid_argument);
  EXPECT_THROW(BlinkTracker({}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
