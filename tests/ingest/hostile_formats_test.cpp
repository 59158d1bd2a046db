#include <cmath>
#include <ctime>
#include <functional>

#include "record_files.hpp"
#include "temp_files.hpp"
#include "tribofit/ingest/list_columns.hpp"

// Files made to exhaust time or memory, or written by a program that crashed.

namespace tribofit {
namespace {

namespace files = record_files;
namespace mat5 = files::mat5;
namespace tdms = files::tdms;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Of processor time, so that other processes do not count.
double seconds_of(const std::function<void()>& work) {
  const auto begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

std::string count_of(std::uint32_t objects) {
  return files::bytes_of(objects);
}

/// A segment as LabVIEW leaves its last one after a crash: where the next one begins was not written, nor perhaps where
/// the values do.
std::string unfinished(std::string segment, bool without_values = false) {
  segment.replace(12, 8, std::string(8, '\xff'));
  if (without_values) segment.replace(20, 8, std::string(8, '\xff'));
  return segment;
}

using HostileTdms = TempFiles;
constexpr std::uint32_t first = tdms::metadata | tdms::new_list | tdms::raw_data;

std::string values_of(double from, std::size_t count) {
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) bytes += files::bytes_of(from + static_cast<double>(i));
  return bytes;
}

TEST_F(HostileTdms, AnUnfinishedSegmentIsReadAsFarAsItsChunksAreWhole) {
  const std::vector<std::string> sampled = {tdms::property("wf_increment", 1e-3)};
  const std::string described =
      count_of(2) + tdms::channel("mu", 10, 2, sampled) + tdms::channel("v_b [mm/s]", 10, 2, sampled);
  const std::string chunk = values_of(0, 2) + values_of(10, 2), next = values_of(2, 2) + values_of(12, 2);
  for (const std::string& rest : {std::string(), chunk.substr(0, 9), chunk.substr(0, 31)}) {
    const Trace trace = read_trace(
        write(tdms::segment(first, described, chunk) + unfinished(tdms::segment(tdms::raw_data, "", next + rest))));
    EXPECT_EQ(trace.friction, (std::vector<double>{0, 1, 2, 3})) << rest.size();
    EXPECT_THAT(trace.velocity, ::testing::Pointwise(::testing::DoubleNear(1e-15), {0.010, 0.011, 0.012, 0.013}));
    EXPECT_THAT(trace.notes, Contains(HasSubstr("was not finished")));
  }
  const std::string head_only = unfinished(tdms::segment(first, described.substr(0, 30), ""), true);
  EXPECT_EQ(read_trace(write(tdms::segment(first, described, chunk) + head_only)).size(), 2U);
  const Trace interleaved = read_trace(write(
      tdms::segment(first, described, chunk) +
      unfinished(tdms::segment(tdms::raw_data | tdms::interleaved, "",
                               values_of(2, 1) + values_of(12, 1) + values_of(3, 1) + values_of(13, 1).substr(0, 3)))));
  EXPECT_EQ(interleaved.friction, (std::vector<double>{0, 1, 2}));
}

TEST_F(HostileTdms, ChunksAndSegmentsOfOneValueAreRead) {
  constexpr std::size_t chunks = 50000;
  std::string raw;
  for (std::size_t i = 0; i < chunks; ++i) {
    raw += files::bytes_of(static_cast<double>(i)) + files::bytes_of(-static_cast<double>(i));
  }
  const std::string described = count_of(2) + tdms::channel("mu", 10, 1, {tdms::property("wf_increment", 1e-3)}) +
                                tdms::channel("v_b [m/s]", 10, 1);
  std::string file = tdms::segment(first, described, raw);
  for (int i = 0; i < 1000; ++i) file += tdms::segment(tdms::raw_data, "", values_of(i, 1) + values_of(-i, 1));
  const std::string name = write(file);
  const ColumnListing listing = list_columns(name);
  EXPECT_EQ(listing.columns[0].count, chunks + 1000);
  EXPECT_EQ(listing.columns[0].highest, chunks - 1.0);
  EXPECT_EQ(listing.columns[1].lowest, 1.0 - chunks);
}

TEST_F(HostileTdms, ManyObjectsInManySegmentsCostTheirSum) {
  std::string described = count_of(50001) + tdms::channel("mu", 10, 1, {tdms::property("wf_increment", 1e-3)});
  for (int i = 0; i < 50000; ++i)
    described +=
        tdms::text(fmt::format("/'r'/'{}'", i)) + files::bytes_of(std::uint32_t{0}) + files::bytes_of(std::uint32_t{0});
  std::string file = tdms::segment(first, described, values_of(0, 1));
  for (int i = 1; i < 50000; ++i) file += tdms::segment(tdms::raw_data, "", values_of(i, 1));
  const std::string name = write(file);
  EXPECT_LT(seconds_of([&] { EXPECT_EQ(list_columns(name).columns.front().count, 50000U); }), 5);
}

TEST_F(HostileTdms, MoreObjectsThanAFileHasAreRefused) {
  std::string described = count_of(70000);
  for (int i = 0; i < 70000; ++i) {
    described += tdms::text(fmt::format("/'r'/'{}'", i)) + files::bytes_of(std::uint32_t{0xFFFFFFFF}) +
                 files::bytes_of(std::uint32_t{0});
  }
  expect_error(write(tdms::segment(first, described, "")), {}, "more than 65536 groups and channels", "fewer channels");
}

using HostileMatlab = TempFiles;

/// A vector of single bytes, which takes eight times its room in memory.
std::string bytes_vector(const std::string& name, std::int32_t count) {
  return mat5::array(name, 6, count, 1, mat5::element(1, std::string(static_cast<std::size_t>(count), '\0')));
}

TEST_F(HostileMatlab, MoreArraysThanAFileHasAreRefused) {
  std::string file = mat5::header();
  const std::string one = mat5::vector("a", {});
  for (int i = 0; i < 70000; ++i) file += one;
  expect_error(write(file), {}, "more than 65536 variables", "damaged");
  std::string names, fields;
  for (int i = 0; i < 70000; ++i) {
    names += std::string("f\0", 2);
    fields += mat5::element(14, "");
  }
  const std::string structure = mat5::array("s", 2, 1, 1,
                                            files::bytes_of(std::uint32_t{(4U << 16) | 5U}) +
                                                files::bytes_of(std::int32_t{2}) + mat5::element(1, names) + fields);
  expect_error(write(mat5::header() + structure), {}, "more than 65536 arrays", "damaged");
  expect_error(write(mat5::header() + mat5::compressed(structure)), {}, "", "damaged");
}

TEST_F(HostileMatlab, VariablesThatAreNotReadAreCountedBeyondTwenty) {
  std::string file = mat5::header() + mat5::vector("t", {0, 1, 2}) + mat5::vector("mu", {1, 2, 3});
  for (int i = 0; i < 100; ++i) file += mat5::array(fmt::format("c{}", i), 1, 0, 0, "");
  const ColumnListing listing = list_columns(write(file));
  EXPECT_THAT(listing.notes, Contains(AllOf(HasSubstr("not read: c0 (a cell array)"), HasSubstr("c19"),
                                            Not(HasSubstr("c20")), HasSubstr("and 80 more"))));
}

TEST_F(HostileMatlab, OfTwoArraysOfOneNameTheFirstIsRead) {
  const std::string file = write(mat5::header() + mat5::vector("t", {0, 1, 2}) + mat5::vector("mu", {1, 2, 3}) +
                                 mat5::vector("mu", {7, 8, 9, 10}));
  ReadOptions options;
  options.columns = {{"v_b", "none"}};
  options.conditions = {{0.01, "command line"}, {1, "command line"}, {}};
  const Trace trace = read_trace(file, options);
  EXPECT_EQ(trace.friction, (std::vector<double>{1, 2, 3}));
  EXPECT_THAT(trace.notes, Contains(HasSubstr("mu (another array has its name)")));
}

TEST_F(HostileMatlab, ValuesBeyondWhatAFileOfItsSizeHoldsAreRefused) {
  const std::string one = mat5::compressed(bytes_vector("mu", 20 << 20));
  expect_error(write(mat5::header() + one), {}, "holds 20971520 values, more than the file", "save it again", 0, "mu");
  std::string many = mat5::header();
  for (int i = 0; i < 40; ++i) many += mat5::compressed(bytes_vector(fmt::format("a{}", i), 1 << 20));
  expect_error(write(many), {}, "holds 1048576 values, more than the file", "save it again", 0, "a16");
  std::vector<double> zeros(2000000, 0.0);  // a constant channel of a long record is none
  zeros.back() = 1;
  const std::string constant = mat5::compressed(mat5::vector("mu", zeros));
  EXPECT_EQ(list_columns(write(mat5::header() + constant)).columns[0].count, 2000000U);
}

TEST_F(HostileMatlab, OneBadColumnIsNamedAndTheOthersAreReadOnce) {
  constexpr std::int32_t many_rows = 1000, many_columns = 900;
  std::vector<double> values;
  for (int i = 0; i < many_rows * many_columns; ++i) values.push_back(std::sin(0.1 * i));
  const std::string name =
      write(mat5::header() + mat5::vector("empty", {}) +
            mat5::compressed(mat5::array("daq", 6, many_rows, many_columns, mat5::numbers(values))));
  const double spent = seconds_of([&] {
    const ColumnListing listing = list_columns(name);
    ASSERT_EQ(listing.columns.size(), 901U);
    EXPECT_EQ(listing.columns[900].count, 1000U);
    EXPECT_THAT(listing.notes, Contains("column empty: the vector is empty"));
  });
  EXPECT_LT(spent, 5);
}

TEST_F(HostileMatlab, BoundsOfVersion73AreChecked) {
  const std::string file = path("v73.mat");
  files::write_mat73(file, {{"t", "s", {0, 1, 2}}, {"mu", "1", {1, 2, 3}}});
  std::ifstream in(file, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  const auto with = [&](std::size_t at, std::uint64_t value) {
    std::string bytes = whole;
    return write(bytes.replace(at, 8, files::bytes_of(value)), "v73.mat");
  };
  const std::size_t superblock = whole.find("\x89HDF"), base = superblock + (whole[superblock + 8] < 2 ? 24 : 12);
  ASSERT_EQ(superblock, 512U);
  expect_error(with(base, ~std::uint64_t{0} - 10), {}, "1 of 1 variables cannot be read", "damaged");
  expect_error(with(base + 16, ~std::uint64_t{0} - 10), {}, "1 of 1 variables cannot be read", "damaged");
  std::string version = whole;
  version[superblock + 8] = 77;
  expect_error(write(version, "v73.mat"), {}, "1 of 1 variables cannot be read", "damaged");
}

using HostileUff = TempFiles;

std::string with_abscissa(const std::string& type, const std::string& unit, double interval) {
  const std::vector<double> mu = {1, 2, 3, 4};
  std::string file = files::uff_of({{"time", "s", {0, 1, 2, 3}}, {"mu", "1", mu}}, interval);
  const std::string axis = "        17    0    0    0 Time                 s   ";
  return file.replace(file.find(axis), axis.size(),
                      fmt::format("{:>10}    0    0    0 Axis                 {:4}", type, unit));
}

TEST_F(HostileUff, AFunctionOfAnythingButTimeIsNoTrace) {
  expect_error(write(with_abscissa("19", "rpm", 1e-3)), {}, "'mu' (a function of rpm, not of time)", "time histories");
  expect_error(write(with_abscissa("8", "mm", 1e-3)), {}, "a function of displacement, not of time", "time histories");
  expect_error(write(with_abscissa("1", "mm", 1e-3)), {}, "a function of length, not of time", "time histories");
  expect_error(write(with_abscissa("99", "s", 1e-3)), {}, "an abscissa of type 99", "time histories");
  expect_error(write(with_abscissa("0", "Hz", 1e-3)), {}, "(a spectrum)", "time histories");
}

TEST_F(HostileUff, AnUnknownUnitOfTheAbscissaIsNotTakenForSeconds) {
  ReadOptions options;
  options.columns = {{"v_b", "none"}};
  options.conditions = {{0.01, "command line"}, {1, "command line"}, {}};
  EXPECT_NEAR(read_trace(write(with_abscissa("17", "ms", 2)), options).rate(), 500, 1e-9);
  EXPECT_NEAR(read_trace(write(with_abscissa("1", "ms", 2)), options).rate(), 500, 1e-9);
  for (const auto& [type, unit] : {std::pair{"17", "tick"}, std::pair{"1", "NONE"}, std::pair{"0", "tick"}}) {
    const std::string file = write(with_abscissa(type, unit, 2));
    ReadOptions rate = options;
    expect_error(file, options, "no time column", "rate");
    EXPECT_THAT(list_columns(file).notes, Contains(HasSubstr("state the sampling rate with rate")));
    rate.rate = 100;
    EXPECT_NEAR(read_trace(file, rate).rate(), 100, 1e-9);
  }
}

TEST_F(HostileUff, MoreFunctionsThanChannelsAreCounted) {
  std::string file;
  const std::string one = files::uff_of({{"time", "s", {0, 1}}, {"mu", "1", {1, 2}}}, 1e-3);
  for (int i = 0; i < 5000; ++i) file += one;
  const ColumnListing listing = list_columns(write(file));
  EXPECT_EQ(listing.columns.size(), 4096U);
  EXPECT_THAT(listing.notes,
              Contains(AllOf(HasSubstr("more columns than can be channels"), HasSubstr("and 884 more"))));
}

}  // namespace
}  // namespace tribofit
