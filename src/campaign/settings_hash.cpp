#include <fmt/format.h>

#include <string>
#include <string_view>

#include "ingest/content_hash.hpp"
#include "tribofit/campaign/batch.hpp"
#include "tribofit/version.hpp"

namespace tribofit {
namespace {

/// Form of the result files; a new one makes old results be done again.
constexpr int kForm = 4;  // 1, 2: the checksum of a trace was another one; 3: samples were kept in the result

/// Texts with their lengths, so that no two lists of texts become the same one.
class Text {
 public:
  void add(std::string_view text) { text_ += fmt::format("{}:{}\n", text.size(), text); }
  void add(const Condition& condition) {
    add(condition.known() ? fmt::format("{}", condition.value) : "");
    add(condition.source);
  }
  template <class List>
  void add_all(const List& texts) {
    add(std::to_string(texts.size()));
    for (const std::string& text : texts) add(text);
  }
  std::string hash() const { return hexadecimal(xxh64(text_)); }

 private:
  std::string text_;
};

}  // namespace

std::string options_hash(const BatchOptions& options) {
  Text text;
  text.add(fmt::format("tribofit {} {}", version, kForm));
  text.add_all(options.arguments);
  text.add(hexadecimal(content_hash(options.companions)));
  return text.hash();
}

std::string settings_hash(const Run& run, const std::string& hash_of_options) {
  Text text;
  text.add(hash_of_options);
  text.add(run.name);
  text.add(run.file);
  text.add(run.problem);
  text.add(run.trace.read.conditions.radius);
  text.add(run.trace.read.conditions.speed);
  text.add(run.trace.read.conditions.load);
  text.add(run.known.repeat ? std::to_string(*run.known.repeat) : "");
  for (const OtherCondition& other : run.known.others) {
    text.add(other.name);
    text.add(other.value);
  }
  text.add_all(run.warnings);
  return text.hash();
}

}  // namespace tribofit
