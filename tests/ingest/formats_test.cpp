#include <cmath>
#include <ctime>
#include <functional>

#include "record_files.hpp"
#include "temp_files.hpp"
#include "tribofit/ingest/list_columns.hpp"

namespace tribofit {
namespace {

namespace files = record_files;
using ::testing::Contains;
using ::testing::HasSubstr;

/// A record of numbers of few digits, which every format holds without loss.
files::Columns record(std::size_t rows = 200) {
  files::Columns columns = {{"time", "s", {}}, {"mu", "1", {}}, {"v_b", "mm/s", {}}, {"Fn", "N", {}}};
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = static_cast<double>(i);
    columns[0].values.push_back(std::round(t * 50) / 1e6);
    columns[1].values.push_back(std::round(1e5 * (0.3 + 0.1 * std::sin(0.3 * t))) / 1e5);
    columns[2].values.push_back(std::round(1e4 * (6 + std::cos(0.2 * t))) / 1e4);
    columns[3].values.push_back(std::round(1e3 * (50 + std::sin(t))) / 1e3);
  }
  return columns;
}

/// The way of one format to write the record.
struct Format {
  const char* name;
  std::function<void(const std::string& path, const files::Columns&)> write;
  bool has_units = true;
};

void put(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

class Formats : public TempFiles, public ::testing::WithParamInterface<Format> {};

TEST_P(Formats, HoldTheSameRecord) {
  const files::Columns columns = record();
  const std::string file = path("record");
  GetParam().write(file, columns);
  ReadOptions options;
  if (!GetParam().has_units) options.units = {{"v_b", "mm/s"}};
  const Trace trace = read_trace(file, options);
  ASSERT_EQ(trace.size(), 200U);
  for (std::size_t i = 0; i < trace.size(); ++i) {
    ASSERT_NEAR(trace.time[i], columns[0].values[i], 1e-15);
    ASSERT_EQ(trace.friction[i], columns[1].values[i]);
    ASSERT_EQ(trace.velocity[i], 1e-3 * columns[2].values[i]);
    ASSERT_EQ(trace.load[i], columns[3].values[i]);
  }
  EXPECT_TRUE(trace.warnings.empty()) << trace.warnings.front();
  const ColumnListing listing = list_columns(file, options);
  EXPECT_THAT(listing.selection, ::testing::AllOf(HasSubstr("mu=mu"), HasSubstr("v_b=v_b")));
}

INSTANTIATE_TEST_SUITE_P(
    Files, Formats,
    ::testing::Values(
        Format{"Csv", [](const auto& path, const auto& columns) { put(path, files::text_of(columns, ',')); }},
        Format{"Blanks", [](const auto& path, const auto& columns) { put(path, files::text_of(columns, ' ')); }},
        Format{"Mat5", [](const auto& path, const auto& columns) { put(path, files::mat5_of(columns)); }, false},
        Format{"Mat5BigEndian", [](const auto& path, const auto& c) { put(path, files::mat5_of(c, true)); }, false},
        Format{"Mat5Packed", [](const auto& path, const auto& c) { put(path, files::mat5_of(c, false, true)); }, false},
        Format{"Mat73", files::write_mat73, false},
        Format{"Uff", [](const auto& path, const auto& columns) { put(path, files::uff_of(columns)); }},
        Format{"UffEven", [](const auto& path, const auto& columns) { put(path, files::uff_of(columns, 5e-5)); }},
        Format{"UffBinary", [](const auto& path, const auto& columns) { put(path, files::uff_binary_of(columns)); }},
        Format{"UffBinaryEven", [](const auto& path, const auto& c) { put(path, files::uff_binary_of(c, 5e-5)); }},
        Format{"UffBigEndian", [](const auto& path, const auto& c) { put(path, files::uff_binary_of(c, 0, true)); }},
        Format{"Tdms", [](const auto& path, const auto& columns) { put(path, files::tdms_of(columns)); }},
        Format{"TdmsBigEndian", [](const auto& path, const auto& c) { put(path, files::tdms_of(c, true)); }},
        Format{"TdmsInterleaved", [](const auto& path, const auto& c) { put(path, files::tdms_of(c, false, true)); }}),
    [](const auto& param) { return std::string(param.param.name); });

/// Every file that begins like this one ends, or is changed in a byte, is read or refused with a place; soon.
class Damage : public Formats {};

TEST_P(Damage, IsRefusedOrRead) {
  const std::string file = path("record");
  GetParam().write(file, record(20));
  std::ifstream in(file, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  const auto try_bytes = [&](const std::string& bytes) {
    put(file, bytes);
    try {
      const Trace trace = read_trace(file);
      for (const double value : trace.friction) EXPECT_TRUE(std::isfinite(value));
    } catch (const InputError& error) {
      EXPECT_FALSE(error.problem().empty());
      EXPECT_FALSE(error.advice().empty());
    }
  };
  const auto begin = std::clock();
  for (std::size_t size = 0; size < whole.size(); size += 1 + size / 16) try_bytes(whole.substr(0, size));
  const bool is_slow = whole.starts_with("MATLAB");  // a process or two for each
  for (std::size_t at = 0; at < whole.size(); at += is_slow ? 31 : at < 400 ? 1 : 37) {
    std::string bytes = whole;
    bytes[at] = std::string("\0\x7f\xff", 3)[at % 3];
    try_bytes(bytes);
  }
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 20) << "of processor time";
}

INSTANTIATE_TEST_SUITE_P(
    Files, Damage,
    ::testing::Values(
        Format{"Mat5", [](const auto& path, const auto& columns) { put(path, files::mat5_of(columns)); }},
        Format{"Mat5Packed", [](const auto& path, const auto& c) { put(path, files::mat5_of(c, false, true)); }},
        Format{"Mat73", files::write_mat73},
        Format{"Uff", [](const auto& path, const auto& columns) { put(path, files::uff_of(columns)); }},
        Format{"UffEven", [](const auto& path, const auto& columns) { put(path, files::uff_of(columns, 5e-5)); }},
        Format{"UffBinary", [](const auto& path, const auto& columns) { put(path, files::uff_binary_of(columns)); }},
        Format{"UffBigEndian", [](const auto& path, const auto& c) { put(path, files::uff_binary_of(c, 0, true)); }},
        Format{"Tdms", [](const auto& path, const auto& columns) { put(path, files::tdms_of(columns)); }},
        Format{"TdmsBigEndian", [](const auto& path, const auto& c) { put(path, files::tdms_of(c, true)); }},
        Format{"TdmsInterleaved", [](const auto& path, const auto& c) { put(path, files::tdms_of(c, false, true)); }}),
    [](const auto& param) { return std::string(param.param.name); });

using MatlabFiles = TempFiles;
namespace mat5 = files::mat5;

TEST_F(MatlabFiles, StructuresMatricesScalarsAndText) {
  const auto columns = record();
  const std::string names = std::string("v_b\0\0\0\0\0fs\0\0\0\0\0\0", 16);
  const std::string laser = mat5::array(
      "laser", 2, 1, 1,
      files::bytes_of(std::uint32_t{(4U << 16) | 5U}) + files::bytes_of(std::int32_t{8}) + mat5::element(1, names) +
          mat5::vector("", columns[2].values, false, true) + mat5::vector("", {20000}));
  std::vector<double> both = columns[1].values;
  both.insert(both.end(), columns[3].values.begin(), columns[3].values.end());
  const std::string matrix = mat5::array("daq", 6, 200, 2, mat5::numbers(both));
  const std::string text = mat5::array("operator", 4, 1, 4, mat5::element(16, "none"));
  const std::string cells = mat5::array("labels", 1, 1, 1, mat5::vector("", {1, 2, 3}));
  const std::string file = write(mat5::header() + laser + matrix + text + cells + mat5::vector("empty", {}), "run.mat");
  ReadOptions options;
  options.columns = {{"mu", "daq(:,1)"}, {"load", "daq(:,2)"}, {"v_b", "laser.v_b:mm/s"}};
  const Trace trace = read_trace(file, options);
  ASSERT_EQ(trace.size(), 200U);
  EXPECT_NEAR(trace.rate(), 20000, 1e-6) << "from laser.fs";
  EXPECT_EQ(trace.friction[7], columns[1].values[7]);
  EXPECT_EQ(trace.load[7], columns[3].values[7]);
  EXPECT_EQ(trace.velocity[7], 1e-3 * columns[2].values[7]);
  EXPECT_THAT(trace.notes, Contains(HasSubstr("not read: labels (a cell array)")));
  options.columns["mu"] = "empty";
  expect_error(file, options, "the vector is empty", "columns", 0, "empty");
}

TEST_F(MatlabFiles, WholeNumbersOfFewBytes) {
  std::string counts;
  for (int i = 0; i < 50; ++i) counts += files::bytes_of(static_cast<std::int16_t>(i - 20));
  std::vector<double> time, mu(50, 0.3);
  for (int i = 0; i < 50; ++i) time.push_back(1e-3 * i);
  const std::string file = write(mat5::header() + mat5::vector("t", time) + mat5::vector("mu", mu) +
                                     mat5::array("v_b_mm_s", 6, 50, 1, mat5::element(3, counts)),
                                 "run.mat");
  EXPECT_NEAR(read_trace(file).velocity[5], -0.015, 1e-15);
}

TEST_F(MatlabFiles, DefectsAreNamedByOffsetOrVariable) {
  const std::string good = files::mat5_of(record());
  expect_error(write(good.substr(0, 100)), {}, "cut off at byte 100", "again");
  expect_error(write(good.substr(0, 1000)), {}, "byte 128: a variable of 1", "cut off");
  expect_error(write(mat5::header(false, 0x0300)), {}, "byte 124: is of version 0x0300", "-v7");
  std::string other = good;
  other[128] = 99;
  expect_error(write(other), {}, "byte 128: an element of type 99", "damaged");
  const auto huge = mat5::array("mu", 6, 2000000000, 1, mat5::numbers({1, 2}));
  expect_error(write(mat5::header() + huge), {}, "holds 2000000000 values, more than the file", "damaged", 0, "mu");
  const auto cells = mat5::array("runs", 1, 1, 1, mat5::array("", 1, 1, 1, mat5::vector("", {1, 2})));
  expect_error(write(mat5::header() + cells), {}, "holds no vector of numbers: runs (a cell array)",
               "vector of its own");
  expect_error(write(mat5::header() + mat5::array("t", 4, 1, 3, mat5::element(16, "abc"))), {}, "no vector of numbers",
               "vector");
  std::string packed = files::mat5_of(record(), false, true);
  packed[200] = static_cast<char>(packed[200] ^ 0x55);
  EXPECT_THROW(read_trace(write(packed)), InputError);
}

TEST_F(MatlabFiles, VectorsOfUnequalLengthAreNamed) {
  auto columns = record();
  columns[1].values.resize(150);
  ReadOptions options;
  options.units = {{"v_b", "mm/s"}};
  expect_error(write(files::mat5_of(columns), "run.mat"), options, "holds 150 values, and no time of as many",
               "columns", 0, "mu");
}

using UffFiles = TempFiles;

TEST_F(UffFiles, SpectraAndOtherDatasetsAreNamedAndSkipped) {
  auto columns = record(40);
  std::string file = "    -1\n   151\nrig\nNONE\n    -1\n" + files::uff_of(columns, 5e-5);
  std::string spectrum = files::uff_of({columns[0], {"spectrum", "mm/s", columns[2].values}}, 1);
  spectrum.replace(spectrum.find("        17"), 10, "        18");
  const Trace trace = read_trace(write(file + spectrum, "run.uff"));
  EXPECT_EQ(trace.size(), 40U);
  EXPECT_THAT(trace.notes, Contains(HasSubstr("not read: 'spectrum' (a spectrum), 1 dataset of another number")));
}

TEST_F(UffFiles, DefectsAreNamedByOffset) {
  const std::string good = files::uff_of(record(40), 5e-5), binary = files::uff_binary_of(record(40), 5e-5);
  expect_error(write(good.substr(0, good.size() / 2)), {}, "values are there", "cut off");
  std::string words = good;
  words.replace(words.find("E-01"), 4, "what");
  expect_error(write(words), {}, "is not a number", "damaged");
  expect_error(write(binary.substr(0, 800)), {}, "bytes of values, of which", "cut off");
  std::string count = good;
  count.replace(count.find("        40"), 10, "4000000000");
  expect_error(write(count), {}, "4000000000 values in a file of", "damaged");
  std::string vax = binary;
  vax.replace(vax.find("     2          11"), 6, "     1");
  expect_error(write(vax), {}, "numbers of format 1, not IEEE 754", "");
}

using TdmsFiles = TempFiles;
namespace tdms = files::tdms;

TEST_F(TdmsFiles, SegmentsGoOnAndTheSamplingIsStated) {
  const auto columns = record(30);
  const auto raw = [&](std::size_t from, std::size_t to) {
    std::string bytes;
    for (const std::size_t k : {1U, 2U}) {
      for (std::size_t i = from; i < to; ++i) bytes += files::bytes_of(static_cast<float>(columns[k].values[i]));
    }
    return bytes;
  };
  const std::vector<std::string> sampled = {tdms::property("wf_increment", 1e-3),
                                            tdms::property("wf_start_offset", 0.0)};
  auto with_unit = sampled;
  with_unit.push_back(tdms::property("unit_string", "mm/s"));
  const std::string file_properties = tdms::text("/") + files::bytes_of(std::uint32_t{0xFFFFFFFF}) +
                                      files::bytes_of(std::uint32_t{1}) + tdms::property("Radius", "15 mm");
  const std::string described = files::bytes_of(std::uint32_t{3}) + file_properties +
                                tdms::channel("mu", 9, 5, sampled) + tdms::channel("v_b", 9, 5, with_unit);
  const std::string file =
      tdms::segment(tdms::metadata | tdms::new_list | tdms::raw_data, described, raw(0, 5) + raw(5, 10)) +
      tdms::segment(tdms::raw_data, "", raw(10, 15) + raw(15, 20) + raw(20, 25) + raw(25, 30));
  const Trace trace = read_trace(write(file, "run.tdms"));
  ASSERT_EQ(trace.size(), 30U);
  EXPECT_NEAR(trace.rate(), 1000, 1e-6);
  EXPECT_NEAR(trace.conditions.radius.value, 0.015, 1e-15);
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_NEAR(trace.friction[i], columns[1].values[i], 1e-7);
    EXPECT_NEAR(trace.velocity[i], 1e-3 * columns[2].values[i], 1e-9);
  }
}

TEST_F(TdmsFiles, TimesOfTheClockAreSeconds) {
  std::string described = files::bytes_of(std::uint32_t{3}) + tdms::channel("time", 0x44, 20) +
                          tdms::channel("mu", 10, 20) + tdms::channel("v_b_mm_s", 10, 20);
  std::string raw;
  for (std::uint64_t i = 0; i < 20; ++i) {
    raw += files::bytes_of(i << 58) + files::bytes_of(std::int64_t{3700000000});  // 1/64 s
  }
  for (int k = 0; k < 40; ++k) raw += files::bytes_of(0.5);
  const Trace trace =
      read_trace(write(tdms::segment(tdms::metadata | tdms::new_list | tdms::raw_data, described, raw)));
  EXPECT_EQ(trace.time[3], 3.0 / 64);
}

TEST_F(TdmsFiles, DefectsAreNamedByOffset) {
  const std::string good = files::tdms_of(record());
  expect_error(write(good.substr(0, 20)), {}, "byte 0: the head of a segment is cut off", "again");
  expect_error(write(good.substr(0, 2000)), {}, "byte 0: a segment of", "cut off");
  expect_error(write(good + "what"), {}, fmt::format("byte {}: the head of a segment", good.size()), "damaged");
  std::string version = good;
  version[8] = 1;
  expect_error(write(version), {}, "byte 8: version", "damaged");
  const std::string raw_channel = tdms::text("/'rig'/'mu'") + files::bytes_of(std::uint32_t{0x1269});
  expect_error(
      write(tdms::segment(tdms::metadata | tdms::new_list, files::bytes_of(std::uint32_t{1}) + raw_channel, "")), {},
      "raw ones of DAQmx", "export the channel scaled");
  const std::string huge = files::bytes_of(std::uint32_t{1}) + tdms::channel("mu", 10, std::uint64_t{1} << 60);
  expect_error(write(tdms::segment(tdms::metadata | tdms::new_list | tdms::raw_data, huge, std::string(80, '\0'))), {},
               "1152921504606846976 values", "damaged");
}

}  // namespace
}  // namespace tribofit
