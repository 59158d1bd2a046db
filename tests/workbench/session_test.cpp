#include "tribofit/workbench/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>
#include <variant>
#include <vector>

#include "lagging.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "workbench/session_json.hpp"

namespace tribofit {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;
using workbench_test::lagging;
using workbench_test::Lagging;

WorkbenchChoice with(std::vector<std::string> effects) {
  WorkbenchChoice choice;
  choice.effects = std::move(effects);
  return choice;
}

WorkbenchDiagnosis waited_for(const WorkbenchSession& session) {
  for (int k = 0; k < 1200; ++k) {
    if (session.diagnosis().state != WorkbenchDiagnosis::State::running) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return session.diagnosis();
}

TEST(Session, finds_the_hidden_lag) {
  WorkbenchSession session(lagging().options());
  const WorkbenchRung bare = session.show({}, FitDetail::quick).rung;
  const WorkbenchRung lag = session.show(with({"frictional-lag"}), FitDetail::quick).rung;
  EXPECT_LT(lag.fit.error.held_out_rmse, 0.7 * bare.fit.error.held_out_rmse);
  const FitParameter& tau = lag.fit.parameters.back();
  EXPECT_NEAR(tau.value, 4e-3, 4 * tau.std_error);
}

TEST(Session, gives_the_numbers_of_the_command_it_shows) {
  WorkbenchSession session(lagging().options());
  WorkbenchChoice choice = with({"frictional-lag"});
  choice.formulas = {"rise = a*v; a=0.0001"};
  choice.given = {{"alpha", 61.7, GivenParameter::Bounds{1.0 / 3, 1e4}}, {"frictional-lag.tau", 1.7e-3, {}}};
  choice.selection = {Selection::Cycles{1, 30}, {{2.05, 2.35}}};
  const WorkbenchRung quick = session.show(choice, FitDetail::quick).rung;
  const WorkbenchRung full = session.show(choice, FitDetail::full).rung;
  EXPECT_EQ(session.rungs().size(), 1u);
  const Outcome out = lagging().workshop.shell(full.command + " --json - --protocol joint");
  ASSERT_EQ(out.status, 0) << full.command << "\n" << out.err;
  const Json fit = Json::parse(out.out)["fits"][0];
  EXPECT_EQ(fit["error"]["rmse"].get<double>(), full.fit.error.rmse);
  EXPECT_EQ(fit["error"]["held_out_rmse"].get<double>(), full.fit.error.held_out_rmse);
  EXPECT_NEAR(quick.fit.error.held_out_rmse, full.fit.error.held_out_rmse, 0.1 * full.fit.error.held_out_rmse);
  for (std::size_t k = 0; k < full.fit.parameters.size(); ++k) {
    const FitParameter& p = full.fit.parameters[k];
    EXPECT_EQ(fit["parameters"][k]["value"].get<double>(), p.value / p.parameter.si) << p.parameter.name;
    EXPECT_NEAR(quick.fit.parameters[k].value, p.value, 2 * p.std_error) << p.parameter.name;
  }
}

/// Whatever is accepted as JSON, the printed command is no wrong usage.
TEST(Session, prints_commands_that_are_accepted) {
  const WorkbenchSession session(lagging().options());
  for (const char* text :
       {R"({"law":"coulomb","effects":["viscous"]})", R"({"law":"exponential","start":{"mu_s":-1e-9,"alpha":1e20}})",
        R"({"law":"exponential","bounds":{"mu_s":[-1,2]},"start":{"mu_s":2,"beta":9}})",
        R"({"law":"fractional","bounds":{"mu_s":[0.4,0.4]},"cycles":[0,12]})",
        R"({"law":"exponential","excluded":[[-1,0.1],[7.5,1e9]]})",
        R"({"law":"exponential","formulas":["it's = a*exp(-v); a=0.001"]})",
        R"({"law":"exponential","formulas":["hump = a*exp(-v/w); a=0.02, w=6mm/s"]})"}) {
    std::string command;
    try {
      command = session.command_of(workbench::choice_from(workbench::parsed(text, "the request")));
    } catch (const InputError&) {
      continue;  // refused here as there
    }
    const Outcome out = lagging().workshop.shell(command + " --starts 1 --quiet");
    EXPECT_NE(out.status, 2) << command << "\n" << out.err;
  }
}

TEST(Session, says_what_part_of_the_record_it_shows) {
  WorkbenchSession session(lagging().options());
  WorkbenchChoice choice;
  choice.selection.cycles = {2, 9};
  const auto said = [](const WorkbenchPicture& picture) {
    for (const ReportSection& section : picture.report.sections) {
      for (const ReportItem& item : section.items) {
        const auto* text = std::get_if<ReportText>(&item);
        if (text != nullptr && text->text.find("are used in the fit") != std::string::npos) return text->text;
      }
    }
    return std::string();
  };
  EXPECT_THAT(said(session.show(choice, FitDetail::quick)), HasSubstr("8 of "));
  EXPECT_EQ(said(session.show({}, FitDetail::quick)), "");
}

TEST(Session, does_not_need_its_file_once_it_has_read_it) {
  const Lagging record("4s");
  WorkbenchSession session(record.options());
  std::filesystem::remove(record.path);
  EXPECT_GT(session.show(with({"frictional-lag"}), FitDetail::quick).rung.fit.error.held_out_rmse, 0);
  EXPECT_GT(session.show(with({"radius-offset"}), FitDetail::full).rung.fit.error.held_out_rmse, 0);
  ASSERT_TRUE(session.begin_diagnosis({}));
  const WorkbenchDiagnosis found = waited_for(session);
  EXPECT_EQ(found.state, WorkbenchDiagnosis::State::done) << found.sentence;
}

TEST(Session, comes_back_to_a_rung_with_the_same_numbers) {
  WorkbenchSession session(lagging().options());
  const WorkbenchRung first = session.show({}, FitDetail::quick).rung;
  session.show(with({"viscous"}), FitDetail::quick);
  const WorkbenchRung again = session.show({}, FitDetail::quick).rung;
  EXPECT_EQ(again.number, first.number);
  EXPECT_EQ(again.fit.values(), first.fit.values());
  EXPECT_EQ(again.fit.error.held_out_rmse, first.fit.error.held_out_rmse);
  EXPECT_EQ(session.rungs().size(), 2u);

  // Not what was kept but what is found: another session that came another way.
  WorkbenchSession other(lagging().options());
  other.show(with({"viscous", "frictional-lag"}), FitDetail::quick);
  EXPECT_EQ(other.show({}, FitDetail::quick).rung.fit.values(), first.fit.values());
}

TEST(Session, keeps_no_rung_of_what_is_passed_by) {
  WorkbenchSession session(lagging().options());
  WorkbenchChoice choice;
  choice.given = {{"mu_s", 0.45, {}}};
  EXPECT_EQ(session.show(choice, FitDetail::quick, {}, false).rung.number, WorkbenchRung::passed_by);
  EXPECT_TRUE(session.rungs().empty());
  EXPECT_EQ(session.show(choice, FitDetail::full).rung.number, 0u);
}

TEST(Session, lives_on_after_what_it_cannot_do) {
  WorkbenchSession session(lagging().options());
  WorkbenchChoice bad;
  const auto problem = [&] {
    try {
      session.show(bad, FitDetail::quick);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  bad.formulas = {"hump = a*log(0*v - 1); a=0.02"};
  EXPECT_NE(problem(), "none");
  bad.formulas = {"hump = b*exp(-v); a=0.02"};
  EXPECT_THAT(problem(), HasSubstr("'b'"));
  bad = with({"temperature-dependence"});
  EXPECT_THAT(problem(), HasSubstr("temperature"));
  bad = {};
  bad.selection.cycles = {1000, 2000};
  EXPECT_THAT(problem(), HasSubstr("fewer than three cycles"));
  EXPECT_TRUE(session.rungs().empty());
  EXPECT_GT(session.show({}, FitDetail::quick).rung.fit.error.held_out_rmse, 0);
}

TEST(Session, saved_and_loaded_has_the_same_rungs) {
  WorkbenchSession session(lagging().options());
  session.show({}, FitDetail::quick);
  WorkbenchChoice choice = with({"frictional-lag"});
  choice.given = {{"mu_s", 0.5, {}}};
  choice.selection.excluded = {{1, 1.5}};
  session.show(choice, FitDetail::quick);
  const std::string saved = session.save();

  WorkbenchSession other(lagging().options());
  other.load(saved, "saved.json");
  const auto a = session.rungs(), b = other.rungs();
  ASSERT_EQ(b.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(a[k].fit.values(), b[k].fit.values());
    EXPECT_EQ(a[k].command, b[k].command);
  }
  EXPECT_TRUE(workbench::same(other.begin(), choice));
  EXPECT_EQ(saved_workbench(saved, "saved.json").trace, lagging().path);
  EXPECT_THROW(other.load("{}", "saved.json"), InputError);
  std::string changed = saved;
  const std::size_t at = changed.find("\"checksum\": \"") + 13;
  changed[at] = changed[at] == '0' ? '1' : '0';
  EXPECT_THROW(other.load(changed, "saved.json"), InputError);
}

TEST(Session, diagnoses_as_the_command_does) {
  WorkbenchSession session(lagging().options());
  ASSERT_TRUE(session.begin_diagnosis({}));
  EXPECT_FALSE(session.begin_diagnosis({}));
  const WorkbenchDiagnosis found = waited_for(session);
  ASSERT_EQ(found.state, WorkbenchDiagnosis::State::done) << found.sentence;
  const Outcome out = lagging().workshop.shell(found.command + " --json -");
  ASSERT_EQ(out.status, 0) << found.command << out.err;
  const Json ladder = Json::parse(out.out)["diagnosis"]["ladder"];
  ASSERT_EQ(ladder.size(), found.ladder.size());
  EXPECT_EQ(ladder.back()["held_out_rmse"].get<double>(), found.ladder.back().held_out_rmse);
  EXPECT_GT(session.show(found.found, FitDetail::quick).rung.fit.error.held_out_rmse, 0);
}

TEST(Session, plans_the_run_that_settles_what_a_diagnosis_leaves_open) {
  if (std::string_view(TRIBOFIT_IDENTIFY).empty()) GTEST_SKIP() << "no command simulates the record";
  const Lagging record("8s", workbench_test::kDoubtfulLag);
  WorkbenchSession session(record.options());
  EXPECT_FALSE(session.begin_plan()) << "nothing was diagnosed";
  ASSERT_TRUE(session.begin_diagnosis({}));
  const WorkbenchDiagnosis open = waited_for(session);
  ASSERT_TRUE(open.leaves_open) << open.sentence;
  ASSERT_TRUE(session.begin_plan());
  EXPECT_FALSE(session.begin_plan()) << "one runs";
  session.cancel_diagnosis();
  WorkbenchDiagnosis planned = waited_for(session);
  EXPECT_EQ(planned.state, WorkbenchDiagnosis::State::done) << "the diagnosis stands";
  EXPECT_EQ(planned.plan, nullptr);
  ASSERT_TRUE(session.begin_plan());
  planned = waited_for(session);
  ASSERT_NE(planned.plan, nullptr) << planned.sentence;
  EXPECT_EQ(planned.sentence, open.sentence);
  std::vector<std::string> captions;
  for (const ReportItem& item : planned.plan->items) {
    if (const auto* table = std::get_if<ReportTable>(&item)) captions.push_back(table->caption);
  }
  EXPECT_THAT(captions, testing::Contains(HasSubstr("Experiments")));
}

TEST(Session, lets_nobody_wait_behind_a_slow_fit) {
  WorkbenchSession session(lagging().options());
  WorkbenchChoice slow;
  std::string sum = "k*(v/w)^.5";
  for (int i = 101; i < 300; ++i) sum += "+k*(v/w)^." + std::to_string(i);
  slow.formulas = {"long = " + sum + "; k=0.001, w=6mm/s"};
  std::atomic<bool> wanted{true}, was_stopped{false};
  std::thread other([&] {
    try {
      session.show(slow, FitDetail::full, [&] { return wanted.load(); });
    } catch (const Stopped&) {
      was_stopped = true;
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const WorkbenchRung full = session.show(with({"frictional-lag"}), FitDetail::full).rung;
  wanted = false;
  other.join();
  EXPECT_TRUE(was_stopped);  // it was under way all the time
  WorkbenchSession alone(lagging().options());
  EXPECT_EQ(alone.show(with({"frictional-lag"}), FitDetail::full).rung.fit.values(), full.fit.values());
}

TEST(Session, keeps_the_parts_of_pages_apart) {
  WorkbenchSession session(lagging().options());
  WorkbenchChoice part;
  part.selection.cycles = {2, 12};
  const WorkbenchPicture whole = session.show({}, FitDetail::quick);
  std::vector<std::thread> pages;
  std::array<WorkbenchPicture, 4> shown;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    pages.emplace_back([&, k] { shown[k] = session.show(k % 2 == 0 ? WorkbenchChoice{} : part, FitDetail::full); });
  }
  for (std::thread& page : pages) page.join();
  EXPECT_EQ(shown[0].rung.fit.values(), shown[2].rung.fit.values());
  EXPECT_EQ(shown[1].rung.fit.values(), shown[3].rung.fit.values());
  EXPECT_EQ(shown[1].rung.fit.cycles, 11u);
  const auto points = [](const WorkbenchPicture& picture) {  // of the record, where what is left out is shaded
    for (const ReportSection& section : picture.report.sections) {
      for (const ReportItem& item : section.items) {
        if (const auto* chart = std::get_if<Chart>(&item); chart != nullptr && chart->id == "t1-record")
          return chart->stretches.size();
      }
    }
    return std::size_t{999};
  };
  EXPECT_EQ(points(whole), 0u);
  EXPECT_EQ(points(shown[0]), 0u);
  EXPECT_EQ(points(shown[1]), points(shown[3]));
  EXPECT_GT(points(shown[1]), 0u);
  EXPECT_LT(points(shown[1]), 999u);
}

TEST(Session, gives_up_a_diagnosis_at_once) {
  WorkbenchSession session(lagging().options());
  ASSERT_TRUE(session.begin_diagnosis({}));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto begin = std::chrono::steady_clock::now();
  session.cancel_diagnosis();
  EXPECT_EQ(waited_for(session).state, WorkbenchDiagnosis::State::cancelled);
  // Where the program has no command it is instrumented (tests/sanitized) and far slower, as the diagnosis is.
  const auto at_once = std::chrono::seconds(std::string_view(TRIBOFIT_IDENTIFY).empty() ? 60 : 2);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, at_once);
  ASSERT_TRUE(session.begin_diagnosis({}));  // and another can begin
}

}  // namespace
}  // namespace tribofit
