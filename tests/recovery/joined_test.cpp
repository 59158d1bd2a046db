#include "joined_pairs.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

// Two files of one run, as two instruments write them: the offset of their clocks is found, or they are refused.

namespace tribofit::joined {
namespace {

struct Wanted {
  const char* name;
  Outcome outcome = Outcome::right;
};

void expect_all(const std::vector<Pair>& pairs, const std::vector<Wanted>& list) {
  for (const Wanted& wanted : list) {
    const auto pair = std::find_if(pairs.begin(), pairs.end(), [&](const Pair& p) { return p.name == wanted.name; });
    ASSERT_NE(pair, pairs.end()) << wanted.name;
    const Judged judged = judge(*pair);
    EXPECT_EQ(judged.outcome, wanted.outcome) << wanted.name << ": " << judged.text;
    if (judged.outcome != Outcome::right) continue;
    EXPECT_LT(std::abs(judged.error), 4 * judged.std_error) << wanted.name << ": " << judged.text;
  }
}

TEST(Joined, PairsOfTheLongList) {
  expect_all(pairs(), {{"2 rpm, 8.23 s late, clock -2.62 s, 187 ppm"},
                       {"2 rpm, 1.09 s late, clock 0 s, -126 ppm"},
                       {"4 rpm, 0.244 s late, clock 0 s, 122 ppm"},
                       {"8 rpm, 28.7 s late, clock 0 s, 0 ppm"},
                       {"8 rpm, -27.5 s late, clock 0 s, 0 ppm"},
                       {"4 rpm, 29.4 s late, clock 0 s, -115 ppm"},
                       {"6 rpm, -1.43 s late, clock 39.6 s, 0 ppm"},
                       {"10 rpm, 2.05 s late, clock 0 s, 199 ppm"},
                       {"6 rpm, 0.272 s late, clock -28.4 s, 162 ppm"},
                       {"8 rpm, -41 s late, clock -46.8 s, 194 ppm", Outcome::refused},
                       {"10 rpm, -1.53 s late, clock 39.3 s, 0 ppm, of other runs", Outcome::refused},
                       {"10 rpm, -20.2 s late, clock 0 s, 0 ppm, of other runs", Outcome::refused}});
}

/// Of every kind one, and none of regular stick-slip is a period off.
TEST(Joined, OtherPairs) {
  const std::vector<Pair> all = other_pairs();
  for (std::size_t k = 2; k < all.size(); k += 8) {
    if (all[k].name.starts_with("ten minutes")) continue;
    const Judged judged = judge(all[k]);
    EXPECT_NE(judged.outcome, Outcome::wrong) << all[k].name << ": " << judged.text;
  }
}

}  // namespace
}  // namespace tribofit::joined
