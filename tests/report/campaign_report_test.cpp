// Tables of a campaign: parameters of any law stand under their own names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/campaign_parts.hpp"
#include "tribofit/report/terminal.hpp"

namespace {

using namespace tribofit;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string cell_of(const ReportTable& table, const std::vector<std::string>& row, const std::string& column) {
  EXPECT_EQ(row.size(), table.columns.size());
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (table.columns[k].name == column) return row.at(k);
  }
  ADD_FAILURE() << "no column " << column;
  return "";
}

/// mu_s, mu_k and the other parameters of a row.
std::vector<std::string> law_cells(const ReportTable& table, const std::vector<std::string>& row) {
  return {cell_of(table, row, "mu_s"), cell_of(table, row, "mu_k"), cell_of(table, row, "other parameters of the law")};
}

PooledValue pooled(const std::string& name, const std::string& unit, double value, double std_error) {
  PooledValue v;
  v.name = name, v.unit = unit, v.value = value, v.std_error = std_error, v.runs = 2;
  return v;
}

ResultParameter fitted(const std::string& name, const std::string& unit, double value, double std_error) {
  ResultParameter p;
  p.name = name, p.unit = unit, p.value = value, p.std_error = std_error;
  return p;
}

TEST(CampaignTables, RepeatsNameTheParametersOfEachLaw) {
  PooledGroup group;
  group.runs = {0, 1};
  PooledValue added = pooled("tau", "ms", 2, 0.1);
  added.effect = "an effect";
  group.fits = {
      {"logarithmic", "joint", {pooled("mu_0", "1", 0.412, 0.001), pooled("A", "1", -0.0213, 0.0004), added}, 0},
      {"gaussian",
       "joint",
       {pooled("mu_s", "1", 0.509, 0.001), pooled("mu_k", "1", 0.318, 0.002), pooled("v_s", "mm/s", 17.2, 0.3)},
       2}};
  for (PooledGroup::OfFit& fit : group.fits) {
    for (PooledValue& v : fit.parameters) {  // one degree of freedom
      v.lower95 = v.value - 12.706 * v.std_error, v.upper95 = v.value + 12.706 * v.std_error;
    }
  }
  const ReportTable table = repeats_table(std::vector{group}, true);
  ASSERT_EQ(table.rows.size(), 6u);
  EXPECT_EQ(cell_of(table, table.rows[1], "value"), "A");
  EXPECT_EQ(cell_of(table, table.rows[1], "law"), "");  // said in the row above
  EXPECT_EQ(cell_of(table, table.rows[1], "mean"), "-0.02130 +/- 0.00040");
  EXPECT_EQ(cell_of(table, table.rows[1], "95 % interval"), "[-0.02638, -0.01622]");
  EXPECT_EQ(cell_of(table, table.rows[1], "runs"), "2");
  EXPECT_EQ(cell_of(table, table.rows[2], "value"), "an effect.tau");
  EXPECT_EQ(cell_of(table, table.rows[3], "law"), "gaussian");
  EXPECT_EQ(cell_of(table, table.rows[5], "unit"), "mm/s");
  TerminalOptions narrow;
  narrow.width = 80;
  Report report;
  report.add({{"repeats", "", {table}}});
  EXPECT_THAT(render_terminal(report, narrow), HasSubstr("[-0.02638, -0.01622]"));
}

TEST(CampaignTables, RunsNameTheParametersOfTheirBestLaw) {
  RunResult run;
  ResultFit fit;
  fit.law = "logarithmic", fit.protocol = "joint";
  fit.parameters = {fitted("mu_0", "1", 0.412, 0.001), fitted("A", "1", -0.0213, 0.0004)};
  run.fits = {fit};
  const ReportTable table = runs_table("1");
  EXPECT_THAT(law_cells(table, run_row(run)), ElementsAre("", "", "mu_0 0.4120 +/- 0.0010, A -0.02130 +/- 0.00040"));
  EXPECT_EQ(cell_of(table, run_row(run), "best law"), "logarithmic");
  run.fits[0].law = "gaussian";
  run.fits[0].parameters = {fitted("mu_s", "1", 0.509, 0.001), fitted("mu_k", "1", 0.318, 0.002),
                            fitted("v_s", "mm/s", 17.2, 0.3)};
  EXPECT_THAT(law_cells(table, run_row(run)),
              ElementsAre("0.5090 +/- 0.0010", "0.3180 +/- 0.0020", "v_s 17.20 +/- 0.30 mm/s"));
  run.run.status = RunStatus::unreadable;
  EXPECT_THAT(law_cells(table, run_row(run)), ElementsAre("", "", ""));
}

}  // namespace
