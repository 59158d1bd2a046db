#include <gtest/gtest.h>

#include <fstream>

#include "command.hpp"
#include "ingest/content_hash.hpp"
#include "tribofit/campaign/batch.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

TEST(ContentHash, IsXxh64) {  // values of the reference implementation
  EXPECT_EQ(xxh64(""), 0xEF46DB3751D8E999ULL);
  EXPECT_EQ(xxh64("a"), 0xD24EC4F1A98C6E5BULL);
  EXPECT_EQ(xxh64("abc"), 0x44BC2CF5AD770999ULL);
  EXPECT_EQ(xxh64("Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1ULL);
}

TEST(ContentHash, SeesEveryFileAndWhereItEnds) {
  const Workshop shop;
  shop.write("a", "12");
  shop.write("b", "3");
  shop.write("c", "1");
  shop.write("d", "23");
  const auto hash = [&](const char* first, const char* second) {
    return content_hash(std::vector{(shop / first).string(), (shop / second).string()});
  };
  EXPECT_NE(hash("a", "b"), hash("c", "d"));
  EXPECT_NE(hash("a", "b"), hash("b", "a"));
  EXPECT_THROW(hash("a", "missing"), InputError);
}

TEST(ContentHash, SeesTheLastByteOfALongFile) {
  const Workshop shop;
  std::string text(std::size_t{3} << 20, 'x');
  shop.write("a", text);
  const std::uint64_t before = content_hash(std::vector{(shop / "a").string()});
  text.back() = 'y';
  shop.write("a", text);
  EXPECT_NE(content_hash(std::vector{(shop / "a").string()}), before);
}

TEST(SettingsHash, ChangesWithAllThatIsStated) {
  const Workshop shop;
  shop.write("lab.json", "{}");
  BatchOptions options;
  options.arguments = {"--law", "exponential"};
  options.companions = {(shop / "lab.json").string()};
  tribofit::Run run = run_of("runs/a.csv", {});
  run.name = "a";
  const std::string of_options = options_hash(options), settings = settings_hash(run, of_options);
  EXPECT_EQ(settings.size(), 16u);
  EXPECT_EQ(settings_hash(run, options_hash(options)), settings);

  BatchOptions other = options;
  other.arguments = {"--lawexponential"};
  EXPECT_NE(options_hash(other), of_options);
  shop.write("lab.json", "{ }");
  EXPECT_NE(options_hash(options), of_options);

  const auto changed = [&](auto&& change) {
    tribofit::Run copy = run;
    change(copy);
    return settings_hash(copy, of_options) != settings;
  };
  EXPECT_TRUE(changed([](tribofit::Run& r) { r.name = "b"; }));
  EXPECT_TRUE(changed([](tribofit::Run& r) { r.file = "b.csv"; }));
  EXPECT_TRUE(changed([](tribofit::Run& r) { r.trace.read.conditions.radius = {0.015, "manifest"}; }));
  EXPECT_TRUE(changed([](tribofit::Run& r) { r.trace.read.conditions.load = {50, "manifest"}; }));
  EXPECT_TRUE(changed([](tribofit::Run& r) { r.known.repeat = 1; }));
  EXPECT_TRUE(changed([](tribofit::Run& r) { r.known.others = {{"lot", "A"}}; }));
  EXPECT_TRUE(changed([](tribofit::Run& r) { r.problem = "missing"; }));
}

}  // namespace
}  // namespace tribofit
