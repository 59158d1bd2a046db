#include "workbench/session_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tribofit/ingest/input_error.hpp"

namespace tribofit::workbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string problem_of(const std::string& text) {
  try {
    choice_from(parsed(text, "the request"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(Choice, is_read_in_the_units_people_see) {
  const WorkbenchChoice choice = choice_from(parsed(
      R"({"law":"exponential","effects":["frictional-lag"],"start":{"alpha":0.05,"frictional-lag.tau":2,"beta":9},
          "bounds":{"mu_s":[0.4,0.6]},"cycles":[3,40],"excluded":[[2.5,3.1]]})",
      "the request"));
  EXPECT_THAT(arguments_of(choice), ElementsAre("--law", "exponential", "--effect", "frictional-lag", "--start",
                                                "alpha=0.05s/mm", "--start", "frictional-lag.tau=2ms", "--bounds",
                                                "mu_s=0.4..0.6", "--cycles", "3..40", "--exclude", "2.5s..3.1s"));
  EXPECT_DOUBLE_EQ(*choice.given[0].start, 50);    // s/m
  EXPECT_DOUBLE_EQ(*choice.given[1].start, 2e-3);  // s
  EXPECT_TRUE(same(choice, choice_from(choice_json(choice))));
}

TEST(Choice, is_the_same_whatever_the_order_of_the_clicks) {
  const auto read = [](const char* text) { return choice_from(parsed(text, "the request")); };
  const WorkbenchChoice a = read(R"({"law":"exponential","effects":["viscous","frictional-lag"],
      "start":{"alpha":0.05,"mu_s":0.4},"excluded":[[1,2],[3,4]]})");
  const WorkbenchChoice b = read(R"({"law":"exponential","effects":["frictional-lag","viscous"],
      "start":{"mu_s":0.4,"alpha":0.05},"excluded":[[3,4],[1,2]]})");
  EXPECT_TRUE(same(a, b));
  EXPECT_FALSE(same(a, read(R"({"law":"exponential","effects":["frictional-lag"]})")));
}

TEST(Choice, keeps_to_itself_what_is_given_for_another_law) {
  WorkbenchChoice choice;
  choice.given = {{"no-such.parameter", 0.5, {}}, {"mu_s", 0.5, {}}};
  EXPECT_THAT(arguments_of(choice), ElementsAre("--law", "exponential", "--start", "mu_s=0.5"));
}

TEST(Choice, that_cannot_be_says_why) {
  EXPECT_THAT(problem_of("[1,2"), HasSubstr("is not JSON"));
  EXPECT_THAT(problem_of("[[[[[[[[[[[[1]]]]]]]]]]]]"), HasSubstr("nested too deeply"));
  EXPECT_THAT(problem_of("{}"), HasSubstr("there is no law"));
  EXPECT_THAT(problem_of(R"({"law":"exponental"})"), HasSubstr("exponential"));
  EXPECT_THAT(problem_of(R"({"law":"exponential","effects":["frictional-leg"]})"), HasSubstr("frictional-lag"));
  EXPECT_THAT(problem_of(R"({"law":"exponential","effects":["viscous","viscous"]})"), HasSubstr("viscous"));
  EXPECT_THAT(problem_of(R"({"law":"exponential","formulas":["hump = a*exp(-v"]})"), HasSubstr("formula"));
  EXPECT_THAT(problem_of(R"({"law":"exponential","start":{"mu_s":"high"}})"), HasSubstr("mu_s is not a number"));
  EXPECT_THAT(problem_of(R"({"law":"exponential","bounds":{"mu_s":[2,1]}})"), HasSubstr("from high to low"));
  EXPECT_THAT(problem_of(R"({"law":"exponential","cycles":[1.5,3]})"), HasSubstr("whole numbers"));
  EXPECT_THAT(problem_of(R"({"law":"exponential","excluded":[[1]]})"), HasSubstr("pair of numbers"));
  EXPECT_THAT(problem_of(R"({"law":"exponential","excluded":[[1,1]]})"), HasSubstr("no length"));
  EXPECT_THAT(problem_of(R"({"law":"exponential","start":{"mu_s":0.9},"bounds":{"mu_s":[0.1,0.2]}})"),
              HasSubstr("mu_s starts beyond"));
  EXPECT_THAT(problem_of(R"({"law":"exponential","start":{"alpha":1e307}})"), HasSubstr("a value that is too large"));
  EXPECT_THAT(problem_of(R"({"law":7,"effects":7})"), HasSubstr("there is no law"));
}

}  // namespace
}  // namespace tribofit::workbench
