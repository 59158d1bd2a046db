// What `identify columns` says of a file, and the options by which columns, units and speeds are named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "../ingest/record_files.hpp"
#include "command.hpp"

namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
namespace files = tribofit::record_files;

/// The command that is printed, or nothing.
std::string suggested(const std::string& out) {
  const std::vector<std::string> lines = lines_of(out);
  const auto line =
      std::find_if(lines.begin(), lines.end(), [](const auto& l) { return l.starts_with("  identify "); });
  return line == lines.end() ? "" : *line;
}

std::string with_header(const std::string& header) {
  return header + good_trace().substr(good_trace().find('\n'));
}

TEST(Columns, TheSuggestedCommandRunsAsItIsPrinted) {
  for (const char* header :
       {"time_s,mu,v_b_mm_s", "time_s,COF,v_b", "t,Force1_N,v_b [mm/s]", "time_s,pull_on_arm [Nm],v_b [mm/s]",
        "Zeit (s),Reibung = mu,it's v_r [mm/s]", "time_s,mu,laser head [mm/s]"}) {
    const Workshop shop;
    shop.write("my trace.csv", with_header(header));
    const Outcome listed = shop.identify("columns 'my trace.csv'");
    ASSERT_EQ(listed.status, 0) << listed.err;
    EXPECT_THAT(listed.out, Not(HasSubstr("NAME")));
    const std::string command = suggested(listed.out);
    if (std::string(header).find("Reibung") != std::string::npos) {
      EXPECT_EQ(command, "") << "no column of friction is recognised";
      continue;
    }
    ASSERT_NE(command, "") << listed.out;
    const Outcome outcome = shop.shell(command);
    EXPECT_EQ(outcome.status, 0) << command << "\n" << outcome.err;
  }
}

TEST(Columns, WithoutUsableColumnsNothingIsSuggested) {
  const Workshop shop;
  shop.write("film.csv", "X,Y,Film\n1,2,3\n2,3,4\n3,4,5\n");
  Outcome outcome = shop.identify("columns film.csv");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(suggested(outcome.out), "");
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("Not recognised here: time"), HasSubstr("friction (mu, force or torque)"),
                                 HasSubstr("velocity (v_b, v_r, x_b or speed)"), Not(HasSubstr("NAME"))));
  shop.write("pull.mat", files::mat5_of({{"t", "", {0, 1, 2}}, {"Fnorm", "", {0.1, 0.2, 0.4}}}));
  outcome = shop.identify("columns pull.mat");
  EXPECT_THAT(outcome.out, HasSubstr("If 'Fnorm' is that, say so: --columns mu=Fnorm"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("Next")));
}

TEST(Columns, NamesAndUnitsSuggestChannels) {
  const Workshop shop;
  shop.write("a.csv",
             "t [s],Force1_N,arm [Nm],motor [rpm],Pot RTD Temp (degC),slide [mm/s],height\n"
             "0,1,2,3,4,5,6\n1,2,3,4,5,6,7\n2,3,4,5,6,7,8\n");
  const Outcome outcome = shop.identify("columns a.csv");
  EXPECT_THAT(outcome.out, AllOf(ContainsRegex("Force1_N +N .*force\\?"), ContainsRegex("arm .*torque\\?"),
                                 ContainsRegex("motor .*speed\\?"), ContainsRegex("Pot RTD .*temperature\\?"),
                                 ContainsRegex("slide .*v_r\\?")));
  EXPECT_THAT(outcome.out, HasSubstr("?: what the name or the unit suggests"));
}

json identified(const Workshop& shop, const std::string& arguments) {
  const Outcome outcome = shop.identify("--quiet --json r.json " + arguments + " trace.csv");
  EXPECT_EQ(outcome.status, 0) << arguments << "\n" << outcome.err;
  json result = json_in(shop / "r.json");
  result["tool"].erase("arguments");
  return result;
}

TEST(Options, ALinearSpeedIsThatAtTheRadius) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  const double rpm = 6.3e-3 / 15e-3 * 60 / (2 * std::numbers::pi);
  const json j = identified(shop, "--radius 15mm --speed 6.3mm/s");
  EXPECT_NEAR(j["conditions"]["speed_rpm"].get<double>(), rpm, 1e-4);
  for (const char* arguments : {"--speed 6.3mm/s", "--radius 6mm,9mm --speed 6.3mm/s"}) {
    const Outcome refused = shop.identify(std::string(arguments) + " trace.csv");
    EXPECT_EQ(refused.status, 3) << arguments;
    EXPECT_THAT(refused.err, AllOf(HasSubstr("--speed: '6.3mm/s' is a linear speed"), HasSubstr("--radius")));
  }
}

TEST(Options, UnitsAreOfAChannelOrOfAColumn) {
  const Workshop shop;
  shop.write("trace.csv", with_header("time_s,mu,Velocity"));
  const json channel = identified(shop, "--radius 15mm --units v_b=mm/s");
  EXPECT_EQ(identified(shop, "--radius 15mm --units Velocity=mm/s"), channel);
  Outcome refused = shop.identify("--radius 15mm --units trace.csv");
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("--units: 'trace.csv' is not NAME=UNIT"), HasSubstr("v_b=mm/s")));
  refused = shop.identify("--radius 15mm --units velocty=mm/s trace.csv");
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("no channel or column 'velocty'"), HasSubstr("did you mean Velocity?")));
}

TEST(Options, AColumnHoldsOneChannel) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  const Outcome refused = shop.identify("--radius 15mm --columns mu=mu,v_b=mu:mm/s trace.csv");
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err, HasSubstr("column mu: is named for mu and for v_b"));
}

}  // namespace
