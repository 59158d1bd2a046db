#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/json_parts.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/workbench/session.hpp"

namespace tribofit::workbench {

/// What the server says of a session, as JSON.

/// {"problem", "why", "suggestion"}
Json problem_json(const std::string& problem, const std::string& why, const std::string& suggestion);

/// Trace, laws, catalogue and choice to begin with.
Json begin_json(const WorkbenchSession& session);

/// A rung with its errors and parameters; without the parameters where it is only listed.
Json rung_json(const WorkbenchRung& rung, const Motion& motion, bool with_parameters);
Json rungs_json(const WorkbenchSession& session);

std::string text_of_answer(const Json& json);

/// The text of sections that many answers share, kept so that they are seldom written twice.
class WrittenSections {
 public:
  std::optional<std::string> text_of(const std::shared_ptr<const ReportSection>& section);
  void keep(const std::shared_ptr<const ReportSection>& section, const std::string& text);

 private:
  std::mutex mutex_;
  std::vector<std::pair<std::shared_ptr<const ReportSection>, std::string>> kept_;
};

/// {"rung", "rungs", "turn", "report"} as text: the sections of the report, which are long, are put into it as they
/// are.
std::string picture_text(const WorkbenchPicture& picture, double turn, const WorkbenchSession& session,
                         WrittenSections& written);

/// A law over |v_r| [mm/s].
Json curve_json(const Curve& curve);
Json diagnosis_json(const WorkbenchDiagnosis& diagnosis);

}  // namespace tribofit::workbench
