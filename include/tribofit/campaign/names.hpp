#pragma once

#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/ingest/manifest.hpp"

namespace tribofit {

/// What a file's name, or its header, says of its run, as written with its unit ("15mm"); empty: nothing.
struct StatedFields {
  std::string radius, speed, load, repeat;
  std::vector<OtherCondition> others;

  /// The one of that name; a further condition is added.
  std::string& of(std::string_view name);
};
/// Those of conditions, in the order of condition_infos.
inline constexpr std::array stated_conditions = {&StatedFields::radius, &StatedFields::speed, &StatedFields::load};

/// Whether `a` stands before `b` as people count: 9mm before 12mm. Digits compare by the number they make.
bool in_natural_order(std::string_view a, std::string_view b);

/// How the files of a campaign are named: 'r{radius}mm_{repeat}.csv'.
///
/// {radius}, {speed} and {load} are numbers, with the unit behind them in the pattern ({speed}rpm) or in the name;
/// {repeat} is a whole number; any other {name} is a further condition of that name; * is anything. A pattern without
/// .csv or .tsv at its end does not name the extension.
class NamePattern {
 public:
  /// Throws InputError for braces that do not match, a field given twice and a pattern without fields.
  explicit NamePattern(const std::string& pattern);

  /// What the pattern reads in the name of a file (without folders); nothing where the name does not fit.
  std::optional<StatedFields> read(const std::string& file_name) const;
  const std::string& text() const { return text_; }

 private:
  struct Field {
    std::string name, unit;  ///< unit: that behind the field in the pattern
  };

  void add_field(const std::string& name, std::string_view behind, std::string& expression);

  std::string text_;
  bool with_extension_ = false;
  std::vector<Field> fields_;
  std::regex expression_;
};

/// What the usual ways of naming say: r15mm or 15mm, 4rpm, 50N, 60degC, run03 or rep2 or a number at the end (_1).
/// What a name says twice and differently it does not say.
StatedFields usual_fields(const std::string& file_name);

/// What the lines above the table of a trace say ("Radius: 15 mm", "Normal load [N];50"). Never throws; a file that
/// cannot be read says nothing.
StatedFields header_fields(const std::string& path);

/// The row of a manifest that says the same, with `source` as the source of its conditions. Throws InputError where a
/// value has no unit or cannot be.
ManifestRow row_from(const StatedFields& fields, const std::string& path, const std::string& source);

/// A first manifest.csv for a folder of traces.
struct ManifestDraft {
  std::string text;
  std::size_t runs = 0;
  std::size_t complete = 0;  ///< runs of which at least the radius is known
};

/// Every CSV file of the folder with what its name (by the pattern, else by the usual ways) and its header say; cells
/// of what is not known are left empty for the user, and comment lines say what he should look at. Throws InputError
/// for a folder without traces.
ManifestDraft draft_manifest(const std::string& folder, const std::optional<NamePattern>& pattern = {});

}  // namespace tribofit
