#include "tribofit/ingest/input_error.hpp"

#include <utility>

#include "tribofit/output/text.hpp"

namespace tribofit {
namespace {

std::string (*setting_name)(std::string_view key) = nullptr;

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

std::string setting(std::string_view key, std::string_view value) {
  std::string text = setting_name != nullptr ? setting_name(key) : std::string(key);
  if (!value.empty()) text.append(" ").append(value);
  return text;
}

void name_settings(std::string (*name)(std::string_view key)) {
  setting_name = name;
}

}  // namespace tribofit
