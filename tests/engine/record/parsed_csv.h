/// Tables in memory, read as CSV files are.
#pragma once
#include <gtest/gtest.h>

#include "engine/record/csv.h"

namespace loopwright::csv_test {

inline Recording parse(std::string text, Problems& problems, const ReadOptions& options = {}) {
  return parse_csv(std::make_shared<SourceFile>(SourceFile{"data.csv", std::move(text)}), problems, options);
}

inline Recording parse_right(const std::string& text, const ReadOptions& options = {}) {
  Problems problems;
  Recording recording = parse(text, problems, options);
  EXPECT_TRUE(problems.list().empty()) << problems.text();
  return recording;
}

inline std::string problems_of(const std::string& text, const ReadOptions& options = {}) {
  Problems problems;
  const Recording recording = parse(text, problems, options);
  EXPECT_TRUE(problems.has_errors());
  EXPECT_TRUE(recording.columns.empty()) << "a recording with errors must not be used";
  return problems.text();
}

inline std::vector<std::string> names(const Recording& recording) {
  std::vector<std::string> list;
  for (const Column& column : recording.columns) list.push_back(column.name);
  return list;
}

}  // namespace loopwright::csv_test
