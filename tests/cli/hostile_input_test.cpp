// What is typed or named to make the command hang, crash or obey.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "command.hpp"

namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// `identify` that is ended after ten seconds, with status 124.
std::string within_ten_seconds(const std::string& arguments) {
  return "timeout 10 '" TRIBOFIT_IDENTIFY "' " + arguments;
}

TEST(HostileInput, PipesAndDevicesAreRefusedAndNotWaitedFor) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  shop.shell("mkfifo pipe; mkdir results runs; mkfifo results/campaign.json runs/samples.csv");
  for (const char* arguments :
       {"--formula @pipe --radius 15mm trace.csv", "explore --session pipe", "explore --session /dev/zero",
        "--formula @/dev/zero --radius 15mm trace.csv", "merge results", "merge pipe", "columns pipe",
        "--instruments pipe --radius 15mm trace.csv", "--with pipe --radius 15mm trace.csv", "--radius 15mm runs"}) {
    const Outcome outcome = shop.shell(within_ten_seconds(arguments));
    EXPECT_TRUE(outcome.status == 2 || outcome.status == 3) << arguments << ": " << outcome.status << outcome.err;
    EXPECT_THAT(outcome.err, Not(IsEmpty())) << arguments;
  }
}

TEST(HostileInput, APipeThatNobodyReadsIsNotWrittenTo) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  shop.shell("mkfifo pipe; mkdir csv; mkfifo csv/samples.csv");
  for (const char* arguments : {"--radius 15mm --json pipe trace.csv", "--radius 15mm --csv csv trace.csv"}) {
    const Outcome outcome = shop.shell(within_ten_seconds(arguments));
    EXPECT_TRUE(outcome.status == 1 || outcome.status == 3) << arguments << ": " << outcome.status << outcome.err;
  }
  const Outcome read = shop.shell("identify --radius 15mm --quiet --json pipe trace.csv & cat pipe");
  EXPECT_THAT(read.out, HasSubstr("\"fits\"")) << read.err;
}

TEST(HostileInput, ASessionIsNoGigabyte) {
  const Workshop shop;
  shop.shell("truncate -s 1G big.json");
  for (const char* arguments : {"explore --session big.json", "--formula @big.json trace.csv"}) {
    const Outcome outcome = shop.shell(within_ten_seconds(arguments));
    EXPECT_EQ(outcome.status, 3) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr("has 1073741824 bytes, where up to"));
  }
}

TEST(HostileInput, NamesAreShownAndNotObeyed) {
  const Workshop shop;
  const std::string name = "a\x1b[31m\nb.csv";
  shop.write(name, good_trace());
  Outcome outcome = shop.shell("identify --radius 15mm \"$(printf 'a\\033[31m\\nb.csv')\"");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(Not(HasSubstr("\x1b")), HasSubstr("a\\x1b[31m\\nb.csv"), HasSubstr("$'a\\x1b[31m\\nb.csv'")));
  outcome = shop.shell("identify --radius 15mm \"$(printf 'missing\\033[31m\\nb.csv')\"");
  EXPECT_THAT(outcome.err, AllOf(Not(HasSubstr("\x1b")), HasSubstr("missing\\x1b[31m\\nb.csv: cannot be opened")));
  shop.write("a\xe2\x80\xaevsc.b\xe2\x80\x8b.csv", good_trace());  // reads a.b.csv backwards, and as shorter than it is
  outcome = shop.shell("identify --radius 15mm *vsc*.csv");
  EXPECT_THAT(outcome.out, AllOf(Not(HasSubstr("\xe2\x80\xae")), Not(HasSubstr("\xe2\x80\x8b")),
                                 HasSubstr("a\\u202evsc.b\\u200b.csv")));
  shop.write("c.csv", "time_s,mu,v\x1b[2J_mm_s" + good_trace().substr(good_trace().find('\n')));
  outcome = shop.identify("columns c.csv");
  EXPECT_THAT(outcome.out, Not(HasSubstr("\x1b")));
}

struct Absurd {
  std::string name, arguments;
  std::vector<std::string> says;
};

class AbsurdMachine : public ::testing::TestWithParam<Absurd> {};

TEST_P(AbsurdMachine, IsRefusedAtTheDoor) {
  const Workshop shop;
  const Outcome outcome = shop.shell(within_ten_seconds("simulate --out t.csv --quiet " + GetParam().arguments));
  EXPECT_TRUE(outcome.status == 2 || outcome.status == 3) << outcome.status << outcome.err;
  for (const std::string& part : GetParam().says) EXPECT_THAT(outcome.err, HasSubstr(part));
  EXPECT_THAT(shop.names(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Values, AbsurdMachine,
    ::testing::Values(Absurd{"NoiseOnMu", "--noise-mu 1e15", {"--noise-mu", "'1e15'", "more than any machine has"}},
                      Absurd{"NoiseOnVelocity", "--noise-v 1e300mm/s", {"--noise-v", "'1e300mm/s'"}},
                      Absurd{"Gain", "--velocity-gain 1e20", {"--velocity-gain", "'1e20'"}},
                      Absurd{"Duration", "--duration 1e300s", {"--duration", "'1e300s'"}},
                      Absurd{"TooManySamples", "--duration 1e8s", {"--duration and --rate are 2e+12 samples"}},
                      Absurd{"BelowASample", "--duration 1us", {"--duration and --rate are less than two samples"}},
                      Absurd{"Amplitude", "--effect runout:A=1e300,phase=1", {"runout:A", "'1e300'"}},
                      Absurd{"Temperature", "--temperature 20degC..1e300degC", {"--temperature", "1e300degC"}},
                      Absurd{"Standstill", "--speed 0rpm", {"--speed", "'0rpm' is zero"}},
                      Absurd{"Tiny", "--radius 1e-300mm", {"--radius", "'1e-300mm'", "less than any machine has"}},
                      Absurd{"TooManySteps", "--stiffness 1e-12N/mm", {"too many steps", "1e-09 N/m", "0.85 kg"}},
                      Absurd{"TooManyPeriods", "--duration 1e8s --rate 1Hz", {"--duration is 2.2e+09 natural"}},
                      Absurd{"NegativeNoise", "--noise-mu -0.25", {"the noise on mu is negative: -0.25"}},
                      Absurd{"NegativeMass", "--mass -2kg", {"the mass of the block is not positive: -2 kg"}},
                      Absurd{"NegativeDecay", "--alpha -3s/mm", {"alpha = -3 s/mm"}},
                      Absurd{"NegativeSeed", "--seed -1", {"--seed", "'-1'"}},
                      Absurd{"SeedTooLarge", "--seed 99999999999999999999", {"--seed", "99999999999999999999"}},
                      Absurd{"EmptySpeed", "--speed ''", {"--speed is given an empty value"}},
                      Absurd{"EmptyDuration", "--duration ''", {"--duration is given an empty value"}},
                      Absurd{"DividesByZero", "--duration 1s --formula 'x = v/0'", {"finite"}}),
    [](const auto& param_info) { return param_info.param.name; });

TEST(AbsurdMachine, IsNotStudied) {
  const Workshop shop;
  for (const auto& [arguments, says] : std::vector<std::pair<std::string, std::string>>{
           {"speed --points 2 --formula 'x = sqrt(-1)'", "friction at 6.28319 mm/s is not a finite number"},
           {"phase --range 1mm/s..20mm/s --points 1000 --cycles 10000", "10000 cycles at each of 1000 speeds"},
           {"phase --at 1e-300mm/s", "--at: '1e-300mm/s' is less"},
           {"speed --range 1mm/s..1e300mm/s", "--range: '1e300mm/s' is more"},
           {"map --x mass=1kg..1e300kg:3 --y stiffness", "--x: '1e300kg' is more"},
           {"map --x mu_s=-5..5:3 --y stiffness", "mu_s = -5:"},
           {"speed --damping-ratio 1e3", "motions are studied up to 100"},
           {"sensitivity --mu-k 9 --stiffness 1N/mm", "motions are studied up to 100"},
           {"map --x mass --y ratio=1..1e3:3 --damping 1e5Ns/m", "motions are studied up to 100"},
           {"speed --sharpness 1e-300s/mm", "--sharpness: '1e-300s/mm' is less"}}) {
    const Outcome outcome = shop.shell(within_ten_seconds("study " + arguments));
    EXPECT_EQ(outcome.status, 3) << arguments << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(says)) << arguments;
  }
}

TEST(AbsurdMachine, LargeValuesAreWrittenAsTheyAre) {
  const Workshop shop;
  const Outcome outcome = shop.identify(
      "simulate --duration 1s --rate 1kHz --velocity-gain 1e6 --noise-mu 1e6 --noise-v 1e4mm/s --out t.csv --quiet");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  double largest = 0;
  for (const std::string& line : lines_of(contents(shop / "t.csv"))) {
    const std::size_t comma = line.find(',');
    if (line[0] == '0') largest = std::max(largest, std::abs(std::stod(line.substr(comma + 1))));
  }
  EXPECT_GT(largest, 2e6);
  EXPECT_LT(largest, 6e6) << "a thousand normal numbers of 1e6";
}

/// A stack of a thread that is larger than the memory of the process: none can be started.
TEST(HostileInput, AThreadThatCannotBeStartedIsOneLess) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  const std::string arguments = "identify --radius 15mm --quiet --threads 4 --json ";
  ASSERT_EQ(shop.shell(arguments + "all.json trace.csv").status, 0);
  const Outcome outcome = shop.shell("ulimit -s 4000000; ulimit -v 3000000; " + arguments + "one.json trace.csv");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(contents(shop / "one.json"), contents(shop / "all.json"));
}

/// Whichever of them ends first: where results of its own are gone, its status says so.
TEST(HostileInput, TwoBatchesIntoOneFolderDoNotEndAsIfDone) {
  const Workshop shop;
  std::filesystem::create_directory(shop / "runs");
  for (const char* name : {"a", "b", "c", "d"}) shop.write(std::string("runs/") + name + ".csv", good_trace());
  shop.shell(
      "identify --radius 15mm --law coulomb --out r runs > one.txt 2> one.err & first=$!\n"
      "identify --radius 15mm --law fractional --out r runs > two.txt 2> two.err; echo $? > two.status\n"
      "wait $first; echo $? > one.status");
  for (const char* batch : {"one", "two"}) {
    const std::string status = contents(shop / (std::string(batch) + ".status"));
    const std::string table = contents(shop / (std::string(batch) + ".txt"));
    ASSERT_THAT(status, ::testing::AnyOf("0\n", "1\n"));
    const bool done = status == "0\n";
    EXPECT_EQ(done, table.find("missing") == std::string::npos) << batch << ": " << table;
    EXPECT_EQ(done, contents(shop / (std::string(batch) + ".err")).find("replaced meanwhile") == std::string::npos);
  }
}

}  // namespace
