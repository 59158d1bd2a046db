#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "find_runs.hpp"
#include "limits.hpp"
#include "output/csv_table.hpp"
#include "tribofit/campaign/names.hpp"
#include "tribofit/campaign/run.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

const std::string* value_of(const StatedFields& fields, const std::string& name) {
  for (const OtherCondition& other : fields.others) {
    if (other.name == name) return &other.value;
  }
  return nullptr;
}

class Draft {
 public:
  Draft(const std::string& folder, const std::optional<NamePattern>& pattern) {
    const FolderTraces traces = traces_in(folder);
    for (const std::string& path : traces.paths) add(path, pattern);
  }

  ManifestDraft text() const {
    ManifestDraft draft;
    draft.runs = rows_.size();
    CsvLine line;
    line.add("file");
    for (const ConditionInfo& condition : condition_infos) line.add(condition.name);
    line.add("repeat");
    for (const std::string& name : others_) line.add(name);
    std::string table = line.take();
    for (const auto& [file, fields] : rows_) {
      line.add(file);
      for (const auto field : stated_conditions) line.add(fields.*field);
      line.add(fields.repeat);
      for (const std::string& name : others_) {
        const std::string* value = value_of(fields, name);
        line.add(value ? *value : std::string());
      }
      table += line.take();
      if (!fields.radius.empty()) ++draft.complete;
    }
    for (const std::string& remark : remarks_) draft.text += "# " + remark + "\n";
    if (draft.complete < draft.runs) {
      draft.text += fmt::format("# {} of {} runs: no radius found; fill it in, as in 15mm\n",
                                draft.runs - draft.complete, draft.runs);
    }
    draft.text += table;
    return draft;
  }

 private:
  void add(const std::string& path, const std::optional<NamePattern>& pattern) {
    const std::string file = std::filesystem::path(path).filename().string();
    StatedFields fields;
    if (!pattern) {
      fields = usual_fields(file);
    } else if (auto read = pattern->read(file)) {
      fields = std::move(*read);
    } else {
      remarks_.push_back(fmt::format("{} does not fit the pattern {}", file, pattern->text()));
    }
    take_header(header_fields(path), file, fields);
    for (const OtherCondition& other : fields.others) {
      if (std::find(others_.begin(), others_.end(), other.name) == others_.end()) others_.push_back(other.name);
    }
    rows_.emplace_back(file, std::move(fields));
  }

  /// What the header says where the name says nothing; where both speak and differ, a remark.
  void take_header(const StatedFields& header, const std::string& file, StatedFields& fields) {
    const ManifestRow in_header = row_from(header, file, "file");
    const auto take = [&](std::string StatedFields::*field, const ConditionInfo& condition) {
      const std::string& said = header.*field;
      if (said.empty()) return;
      if ((fields.*field).empty()) {
        fields.*field = said;
        return;
      }
      StatedFields one;
      one.*field = fields.*field;
      ManifestRow in_name;
      try {
        in_name = row_from(one, file, "file name");
      } catch (const InputError&) {  // the reader of the manifest will say what is wrong with it
        return;
      }
      const double a = (in_name.conditions.*condition.member).value, b = (in_header.conditions.*condition.member).value;
      if (std::abs(a - b) > kSameStatement * std::abs(b)) {
        remarks_.push_back(fmt::format("{}: the {} of its header is {}, that of its name {}; check which is right",
                                       file, condition.name, said, fields.*field));
      }
    };
    for (std::size_t k = 0; k < condition_infos.size(); ++k) take(stated_conditions[k], condition_infos[k]);
  }

  std::vector<std::pair<std::string, StatedFields>> rows_;
  std::vector<std::string> others_, remarks_;
};

}  // namespace

ManifestDraft draft_manifest(const std::string& folder, const std::optional<NamePattern>& pattern) {
  return Draft(folder, pattern).text();
}

}  // namespace tribofit
