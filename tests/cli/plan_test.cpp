#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command.hpp"

namespace {

using testing::HasSubstr;

const std::string kExampleTrace = TRIBOFIT_SOURCE_DIR "/data/example.csv";

TEST(PlanCommand, SaysWhatIsWrongWithTheMeans) {
  const Workshop shop;
  const auto refuses = [&](const std::string& means, const std::string& why, const std::string& advice) {
    const Outcome o = shop.identify("plan --radius 15mm " + means + " '" + kExampleTrace + "'");
    EXPECT_EQ(o.status, 3) << means << o.err;
    EXPECT_THAT(o.err, HasSubstr(why)) << means;
    EXPECT_THAT(o.err, HasSubstr(advice)) << means;
  };
  refuses("--speeds 8rpm..1rpm", "'8rpm..1rpm' does not rise", "lower value first");
  refuses("--speeds 1rpm..", "--speeds: '' is not a number", "rpm");
  refuses("--speeds 1rpm..2rpm..8rpm", "is not a range", "1rpm..8rpm");
  refuses("--radii 9mm,-12mm", "is not greater than zero", "15mm");
  refuses("--loads 20mm", "--loads", "force");
  refuses("--minutes 0", "'0min' is not greater than zero", "a time such as");
}

TEST(PlanCommand, NeedsATraceThatCanBeRead) {
  const Workshop shop;
  EXPECT_EQ(shop.identify("plan --speeds 1rpm..8rpm").status, 2);
  const Outcome o = shop.identify("plan --radius 15mm missing.csv");
  EXPECT_EQ(o.status, 3);
  EXPECT_THAT(o.err, HasSubstr("missing.csv"));
}

TEST(PlanCommand, WhereNothingIsOpenItSaysSoAndHowToConfirm) {
  const Workshop shop;
  const Outcome o = shop.identify("plan --radius 15mm --load 50N --json plan.json '" + kExampleTrace + "'");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("none is possible"));
  EXPECT_THAT(o.out, HasSubstr("identify diagnose --radius 15mm --load 50N"));
  const auto plan = json_in(shop / "plan.json");
  EXPECT_EQ(plan.at("plan").at("question"), "nothing");
  EXPECT_TRUE(plan.at("plan").at("experiments").empty());
  EXPECT_EQ(plan.at("diagnosis").at("verdict"), "sufficient");
}

TEST(PlanCommand, NamesTheExperimentAndTheCommandThatComesAfterIt) {
  const Workshop shop;
  ASSERT_EQ(
      shop.identify("simulate --radius 15mm --duration 6s --rate 4kHz --effect frictional-lag:tau=0.5ms --noise-mu "
                    "0.006 --noise-v 0.02mm/s --scatter 0.008 --quiet --out lag.csv")
          .status,
      0);
  const Outcome o = shop.identify(
      "plan --radius 15mm --load 50N --tap --rates 50kHz --minutes 0.1 --json plan.json --report plan.html lag.csv");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("Open: frictional-lag"));
  EXPECT_THAT(o.out, HasSubstr("Best: tap the block"));
  EXPECT_THAT(o.out, HasSubstr("identify diagnose --instruments lab.json --radius 15mm --load 50N lag.csv"));
  const auto plan = json_in(shop / "plan.json").at("plan");
  EXPECT_EQ(plan.at("question"), "group");
  EXPECT_FALSE(plan.at("usual_means"));
  EXPECT_EQ(plan.at("experiments").at(0).at("tap_hz"), 50000);
  EXPECT_GT(plan.at("experiments").at(0).at("probability"), 0.9);
  EXPECT_THAT(contents(shop / "plan.html"), HasSubstr("What to run next"));
}

TEST(PlanCommand, AZeroIsReadWithTheBlockLiftedAndDeclared) {
  const Workshop shop;
  ASSERT_EQ(
      shop.identify("simulate --radius 15mm --duration 12s --rate 4kHz --speed-steps 0s:4rpm,6s:-4rpm --effect "
                    "sensor-offset:b=0.02 --noise-mu 0.006 --noise-v 0.02mm/s --scatter 0.008 --quiet --out z.csv")
          .status,
      0);
  const Outcome o = shop.identify("plan --radius 15mm --load 50N --lift --minutes 0.1 --json plan.json z.csv");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("Best: lift the block off the disc"));
  EXPECT_THAT(o.out, HasSubstr("force_sensor.zero"));
  const auto plan = json_in(shop / "plan.json").at("plan");
  EXPECT_TRUE(plan.at("experiments").at(0).at("lift"));
  // Declared as it would be read, it is corrected, and nothing is left to name.
  std::ofstream(shop / "lab.json") << R"({"force_sensor": {"zero": ["0.02", "0.0005"]}})";
  const Outcome after =
      shop.identify("diagnose --instruments lab.json --radius 15mm --load 50N --json after.json z.csv");
  ASSERT_EQ(after.status, 0) << after.err;
  const auto ladder = json_in(shop / "after.json").at("diagnosis").at("ladder");
  EXPECT_EQ(ladder.size(), 1U);
}

}  // namespace
