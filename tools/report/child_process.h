/// Runs another program, passes it text and returns its output.
#pragma once
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace loopwright::report {

struct ChildResult {
  bool succeeded = false;  ///< started, ended in time, with exit code 0
  std::string output;      ///< its standard output
  std::string failure;     ///< why it did not succeed, in one line
};

/// Starts arguments[0] (looked up in PATH, without a shell), passes it `input` and waits for its end. A
/// program that takes longer than `time_limit` is killed. Never throws because of the program's behavior or
/// absence.
ChildResult run_program(const std::vector<std::string>& arguments, std::string_view input,
                        std::chrono::milliseconds time_limit);

}  // namespace loopwright::report
