#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "command.hpp"

// What a shell offers while a command is typed.

namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

/// What bash offers for the last of these words.
std::vector<std::string> offered(const Workshop& shop, const std::string& words) {
  const Outcome outcome = shop.shell(
      "identify completion bash > completion\n"
      "bash -euc 'source ./completion; COMP_WORDS=(\"" TRIBOFIT_IDENTIFY "\" " +
      words + "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _tribofit; printf \"%s\\n\" \"${COMPREPLY[@]}\"'");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return lines_of(outcome.out);
}

TEST(Completion, VerbsOptionsAndWordsAreOffered) {
  const Workshop shop;
  shop.write("trace of today.csv", "");
  EXPECT_THAT(offered(shop, "\"\""), IsSupersetOf({"diagnose", "study", "help", "trace of today.csv"}));
  EXPECT_THAT(offered(shop, "diag"), ElementsAre("diagnose"));
  EXPECT_THAT(offered(shop, "--rad"), ElementsAre("--radius"));
  EXPECT_THAT(offered(shop, "diagnose --conf"), ElementsAre("--confirm"));
  EXPECT_THAT(offered(shop, "simulate --conf"), ElementsAre("")) << "a diagnosis only has it";
  EXPECT_THAT(offered(shop, "study \"\""), IsSupersetOf({"speed", "phase", "response", "sensitivity", "map"}));
  EXPECT_THAT(offered(shop, "study map --"), IsSupersetOf({"--x", "--y"}));
  EXPECT_THAT(offered(shop, "study speed --"), Not(Contains("--y")));
  EXPECT_THAT(offered(shop, "--format \"\""), ElementsAre("pdf", "png", "svg"));
  EXPECT_THAT(offered(shop, "--effect visc"), ElementsAre("viscous"));
  EXPECT_THAT(offered(shop, "help sta"), ElementsAre("statistics"));
}

/// Of the other shells the scripts are read where the shell is there, and ask the command as that for bash does.
TEST(Completion, ScriptsForZshAndFishAreRead) {
  const Workshop shop;
  for (const std::string shell : {"zsh", "fish"}) {
    const Outcome script = shop.identify("completion " + shell);
    ASSERT_EQ(script.status, 0);
    EXPECT_THAT(script.out, HasSubstr("completion next"));
    shop.write("completion." + shell, script.out);
    const Outcome read =
        shop.shell("command -v " + shell + " >/dev/null || exit 0; " + shell + " -n completion." + shell);
    EXPECT_EQ(read.status, 0) << read.err;
  }
}

TEST(Completion, EveryVerbHasItsOptionsInTheHelp) {
  const Workshop shop;
  for (const std::string& verb : lines_of(shop.identify("completion verbs").out)) {
    const std::string help = shop.identify(verb + " --help").out;
    for (const std::string& option : offered(shop, verb + " --")) {
      EXPECT_NE(help.find(option), std::string::npos) << verb << " " << option;
    }
  }
}

}  // namespace
