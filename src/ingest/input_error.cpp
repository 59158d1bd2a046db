#include "tribofit/ingest/input_error.hpp"

#include <utility>

#include "tribofit/output/text.hpp"

namespace tribofit {
namespace {

std::string sentence(const std::string& problem, const std::string& advice, const InputLocation& where) {
  std::string text = where.file;
  if (where.line > 0) text += (text.empty() ? "line " : ":") + std::to_string(where.line);
  if (!text.empty()) text += ": ";
  if (!where.column.empty()) text += "column " + where.column;
  if (where.value > 0) text += (where.column.empty() ? "value " : ", value ") + std::to_string(where.value);
  if (!where.column.empty() || where.value > 0) text += ": ";
  text += problem;
  if (!advice.empty()) text += "; " + advice;
  return printable(text);
}

}  // namespace

InputError::InputError(std::string problem, std::string advice, InputLocation where)
    : std::runtime_error(sentence(problem, advice, where)),
      problem_(std::move(problem)),
      advice_(std::move(advice)),
      where_(std::move(where)) {}

}  // namespace tribofit
