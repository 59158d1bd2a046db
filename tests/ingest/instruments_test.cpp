#include "tribofit/ingest/instruments.hpp"

#include "temp_files.hpp"

namespace tribofit {
namespace {

class InstrumentsFile : public TempFiles {
 protected:
  void expect_refused(const std::string& json, const std::string& problem, const std::string& advice,
                      std::size_t line = 0) const {
    const std::string file = write(json, "lab.json");
    try {
      read_instruments(file);
      FAIL() << "accepted: " << json;
    } catch (const InputError& error) {
      EXPECT_THAT(error.problem(), ::testing::HasSubstr(problem));
      EXPECT_THAT(error.advice(), ::testing::HasSubstr(advice));
      EXPECT_EQ(error.where().file, file);
      EXPECT_EQ(error.where().line, line);
    }
  }
};

TEST_F(InstrumentsFile, IsReadInAllItsForms) {
  const Instruments lab = read_instruments(write(R"({
    // what the data sheets say
    "vibrometer": {"range": "100 mm/s", "high_pass": ["0.5 Hz", "0.05 Hz"], "gain": [0.98, 0.01], "delay": "-20 us", "sign": -1},
    "force_sensor": {"bandwidth": {"value": "1 kHz", "uncertainty": "100 Hz"}, "zero": 0.002, "mass_below": "50 g", "load_measured": true},
    "rig": {"stiffness": ["12 N/mm", "0.3 N/mm"], "radius": "15 mm", "speed": "4 rpm", "load": "50 N", "pad_radius": "5mm", "ping_frequency": "8 Hz"}})"));
  EXPECT_DOUBLE_EQ(lab.vibrometer.range->value, 0.1);
  EXPECT_EQ(lab.vibrometer.range->uncertainty, 0);
  EXPECT_DOUBLE_EQ(lab.vibrometer.high_pass->value, 0.5);
  EXPECT_DOUBLE_EQ(lab.vibrometer.high_pass->uncertainty, 0.05);
  EXPECT_DOUBLE_EQ(lab.vibrometer.gain->value, 0.98);
  EXPECT_DOUBLE_EQ(lab.vibrometer.delay->value, -20e-6);
  EXPECT_EQ(lab.vibrometer.sign, -1);
  EXPECT_FALSE(lab.vibrometer.low_pass);
  EXPECT_DOUBLE_EQ(lab.force_sensor.bandwidth->value, 1000);
  EXPECT_DOUBLE_EQ(lab.force_sensor.bandwidth->uncertainty, 100);
  EXPECT_DOUBLE_EQ(lab.force_sensor.zero->value, 0.002);
  EXPECT_DOUBLE_EQ(lab.force_sensor.mass_below->value, 0.05);
  EXPECT_TRUE(lab.force_sensor.load_measured);
  EXPECT_DOUBLE_EQ(lab.rig.stiffness->value, 12000);
  EXPECT_DOUBLE_EQ(lab.rig.radius->value, 0.015);
}

TEST_F(InstrumentsFile, TheZeroMayBeAForce) {
  EXPECT_DOUBLE_EQ(
      read_instruments(write(R"({"force_sensor": {"zero": ["0.2 N", "0.01 N"]}})")).force_sensor.zero->value, 0.2);
}

TEST_F(InstrumentsFile, NestingThatNoStackHoldsIsRefused) {
  for (const std::size_t levels : {40U, 60000U}) {
    std::string json = "// an odd \" in a comment\n";
    for (std::size_t k = 0; k < levels; ++k) json += "{\"a\": [";
    for (std::size_t k = 0; k < levels; ++k) json += "], \"b\": 1}";
    expect_refused(json, "is nested too deeply", "sections");
  }
}

TEST_F(InstrumentsFile, MistakesAreNamed) {
  expect_refused("{\n\"rig\": {\n\"radius\": \"15 mm\",,\n}}", "is not valid JSON", "commas", 3);
  expect_refused(R"({"rigg": {}})", "rigg: unknown key (did you mean rig?)", "known keys are vibrometer");
  expect_refused(R"({"rig": {"radios": "15 mm"}})", "rig.radios: unknown key (did you mean radius?)",
                 "known keys are stiffness");
  expect_refused(R"({"rig": {"radius": "15 N"}})", "rig.radius: '15 N' is a force, not a length", "15mm");
  expect_refused(R"({"rig": {"radius": 15}})", "rig.radius: has no unit", "with a unit");
  expect_refused(R"({"rig": {"radius": "-15 mm"}})", "rig.radius: must be above zero", "15mm");
  expect_refused(R"({"rig": {"radius": ["15 mm", "-1 mm"]}})", "the uncertainty is negative", "zero or above");
  expect_refused(R"({"rig": {"radius": ["15 mm"]}})", "must be [value, uncertainty]", "two");
  expect_refused(R"({"rig": {"radius": {"uncertainty": "1 mm"}}})", "has no value", "value");
  expect_refused(R"({"rig": {"radius": true}})", "must be a value with a unit", "15mm");
  expect_refused(R"({"vibrometer": {"sign": 2}})", "must be 1 or -1", "-1");
  expect_refused(R"({"force_sensor": {"load_measured": "yes"}})", "must be true or false", "Ft/Fn");
  expect_refused(R"({"force_sensor": {"bandwidth": "1 kHz", "bandwidth_at_least": "5 kHz"}})",
                 "bandwidth_at_least: is given together with force_sensor.bandwidth", "keep one");
  expect_refused("[1, 2]", "must be an object", "instruments");
  EXPECT_THROW(read_instruments(path("absent.json")), InputError);
}

TEST_F(InstrumentsFile, AZeroInNewtonsIsOneOfTheForce) {
  const auto sensor = read_instruments(write(R"({"force_sensor": {"zero": ["0.5 N", "0.1 N"]}})")).force_sensor;
  EXPECT_TRUE(sensor.zero_is_force);
  const auto of_mu = zero_of_friction(sensor, FrictionKind::coefficient, {50, "command line"});
  EXPECT_DOUBLE_EQ(of_mu->value, 0.01);
  EXPECT_DOUBLE_EQ(of_mu->uncertainty, 0.002);
  EXPECT_DOUBLE_EQ(zero_of_friction(sensor, FrictionKind::force, {})->value, 0.5);
  EXPECT_THROW(zero_of_friction(sensor, FrictionKind::coefficient, {}), InputError);
  const auto bare = read_instruments(write(R"({"force_sensor": {"zero": 0.02}})")).force_sensor;
  EXPECT_FALSE(bare.zero_is_force);
  EXPECT_DOUBLE_EQ(zero_of_friction(bare, FrictionKind::coefficient, {})->value, 0.02);
}

TEST_F(InstrumentsFile, NumbersBeyondRangeAndRepeatedKeysAreNamed) {
  expect_refused(R"({"rig": {"load": "50 N"}, "vibrometer": {"gain": 1e999}})",
                 "vibrometer.gain: a number is outside the range", "correct");
  expect_refused(R"({"rig": {"radius": ["15 mm", 1e999]}})", "rig.radius: a number is outside the range", "correct");
  expect_refused(R"({"rig": {"load": "50 N", "radius": "15 mm", "load": "60 N"}})", "rig.load: is there twice", "one");
  expect_refused(R"({"rig": {"load": "50 N"}, "rig": {"radius": "15 mm"}})", "rig: is there twice", "one");
  EXPECT_NO_THROW(
      read_instruments(write(R"({"rig": {"load": {"value": "50 N"}, "radius": {"value": "15 mm"}}})", "lab.json")));
}

TEST_F(InstrumentsFile, TheArticleFitsTheQuantity) {
  expect_refused(R"({"rig": {"speed": "4 mm"}})", "is a length, not an angular velocity", "give an angular velocity");
}

}  // namespace
}  // namespace tribofit
