#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "../folder.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/read_trace.hpp"

namespace tribofit {

/// A folder of its own for each test, removed afterwards.
class TempFiles : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  std::string write(std::string_view text, const std::string& name = "trace.csv") const {
    return folder_.write(name, text);
  }

  /// Expects an InputError whose parts hold the given ones.
  static void expect_error(const std::string& file, const ReadOptions& options, std::string_view problem,
                           std::string_view advice, std::size_t line = 0, std::string_view column = {}) {
    try {
      read_trace(file, options);
      FAIL() << "no InputError; expected: " << problem;
    } catch (const InputError& error) {
      EXPECT_THAT(error.problem(), ::testing::HasSubstr(std::string(problem)));
      EXPECT_THAT(error.advice(), ::testing::HasSubstr(std::string(advice)));
      EXPECT_EQ(error.where().file, file);
      EXPECT_EQ(error.where().line, line) << error.what();
      EXPECT_EQ(error.where().column, column) << error.what();
      EXPECT_FALSE(error.advice().empty());
    }
  }

  Folder folder_;
};

}  // namespace tribofit
