// Invalid command lines: a suggestion, the form of all other messages, and exit code 2.
#include <gtest/gtest.h>
#include "tests/tools/command/program.h"

namespace loopwright::command_line_test {
namespace {

struct Slip {
  std::vector<std::string> arguments;
  std::vector<std::string> told;  // parts of the message
};

TEST(CommandLine, SlipsAreExplained) {
  if (access(program().c_str(), X_OK) != 0) GTEST_SKIP() << program() << " is not built";
  for (const Slip& slip : std::vector<Slip>{
           {{"chek", "a.json"}, {"error: loopwright has no command \"chek\"", "did you mean \"check\"?"}},
           {{"simulate"}, {"no command \"simulate\"", "one of check, run,"}},
           {{}, {"no command is given", "loopwright --help"}},
           {{"run", "a.json", "--reprot", "a.html"},
            {"loopwright run has no option \"--reprot\"", "did you mean \"--report\"?"}},
           {{"run", "--sett=a=1", "--varint", "b=c", "a.json"},
            {"\"--sett\"", "did you mean \"--set\"?", "\"--varint\"", "did you mean \"--variant\"?",
             "2 errors"}},
           {{"run", "a.json", "--zzz"}, {"no option \"--zzz\"", "`loopwright run --help`"}},
           {{"run"}, {"loopwright run: diagram is missing", "Diagram file (JSON)"}},
           {{"compare", "a.json"}, {"loopwright compare: experiments is missing"}},
           {{"run", "a.json", "c.json"}, {"\"c.json\" is one argument too many"}},
           {{"run", "a.json", "--report"}, {"--report has no value"}},
           {{"run", "a.json", "--run", "-1"}, {"--run does not take this value", "0 or more", "found: -1"}},
           {{"run", "a.json", "--run", "two"},
            {"--run does not take this value", "a whole number", "found: two"}},
           {{"deploy", "a.json", "--priority", "100"}, {"--priority does not take", "from 0 to 99"}},
           {{"run", "a.json", "--replay", "a.csv", "--report", "a.html"},
            {"do not go together", "--replay", "--report"}},
           {{"run", "a.json", "--replay", ""}, {"--replay has an empty value"}},
           {{"compare", "a.json", "b.json", "--json", ""}, {"--json has an empty value"}},
           {{"run", "a.json", "-o", "x.csv", "--report", "./x.csv"}, {"name the same file", "./x.csv"}},
           {{"fit", "a.json", "b.json", "--parameters", "m", "-o", "./a.json"},
            {"diagram and --output name"}},
           {{"run", "a.json", "--resume", "c", "--run", "3"}, {"--resume", "--run", "do not go together"}},
           {{"gp"}, {"loopwright gp: no command is given", "one of train, show"}},
           {{"gp", "trian", "a.json"}, {"loopwright gp has no command \"trian\"", "did you mean \"train\"?"}},
           {{"gp", "train", "a.json"}, {"loopwright gp train: --model is missing"}},
           {{"sweep", "reprot", "folder"},
            {"loopwright sweep has no command \"reprot\"", "did you mean \"report\"?"}},
           {{"sweep"}, {"loopwright sweep: sweep is missing"}}}) {
    const Outcome outcome = loopwright_program(slip.arguments);
    const std::string what = ::testing::PrintToString(slip.arguments) + "\n" + outcome.err;
    EXPECT_EQ(outcome.code, 2) << what;
    EXPECT_EQ(outcome.out, "") << what;
    for (const std::string& part : slip.told) EXPECT_TRUE(contains(outcome.err, part)) << part << what;
    for (const char* foreign : {"RequiredError", "ExtrasError", "Could not convert", "Usage:"})
      EXPECT_FALSE(contains(outcome.err, foreign)) << what;
  }
}

TEST(CommandLine, ANumberIsFiniteAndIsTheNumberThatIsWritten) {
  using Options = std::vector<std::pair<std::vector<std::string>, std::string>>;
  const auto expect_refused = [](const Options& options, const std::vector<std::string>& values) {
    for (const auto& [words, option] : options)
      for (const std::string& value : values) {
        std::vector<std::string> arguments = words;
        arguments.insert(arguments.end(), {option, value});
        const Outcome outcome = loopwright_program(arguments);
        EXPECT_EQ(outcome.code, 2) << option << value << outcome.err;
        EXPECT_TRUE(contains(outcome.err, option + " does not take this value")) << value << outcome.err;
        EXPECT_TRUE(contains(outcome.err, "found: " + value)) << option << outcome.err;
      }
  };
  expect_refused({{{"run", "a.json"}, "--run"},
                  {{"fit", "a.json", "e.json", "--parameters", "m"}, "--iterations"},
                  {{"sweep", "s.json"}, "--threads"},
                  {{"sweep", "s.json"}, "--evaluations"},
                  {{"deploy", "a.json"}, "--priority"},
                  {{"deploy", "a.json"}, "--processor"}},
                 {"9223372036854775808", "99999999999999999999", "010", "nan"});
  expect_refused({{{"run", "a.json", "--checkpoint", "c"}, "--checkpoint-every"},
                  {{"linearize", "a.json"}, "--at"},
                  {{"linearize", "a.json"}, "--sample-time"},
                  {{"linearize", "a.json"}, "--measure"},
                  {{"linearize", "a.json"}, "--settle"},
                  {{"stability", "a.json"}, "--kick"},
                  {{"stability", "a.json"}, "--kick-duration"}},
                 {"nan", "inf", "1e999"});
  for (const char* shard : {"0/99999999999999999999", "3/2", "1/", "/2", "1", "-1/2", "1/2x"})
    EXPECT_TRUE(contains(loopwright_program({"sweep", "s.json", "-o", "d", "--shard", shard}).err, "--shard"))
        << shard;
}

TEST(CommandLine, TheGreatestNumberOfARunIsOne) {
  const Outcome outcome = loopwright_program({"run", "none.json", "--run", "9223372036854775807"});
  EXPECT_EQ(outcome.code, 2) << "there is no such diagram";
  EXPECT_FALSE(contains(outcome.err, "--run")) << outcome.err;
}

TEST(CommandLine, HelpSaysTheExitCodes) {
  if (access(program().c_str(), X_OK) != 0) GTEST_SKIP() << program() << " is not built";
  const Outcome outcome = loopwright_program({"--help"});
  EXPECT_EQ(outcome.code, 0);
  for (const char* part : {"0 done", "1 a run failed", "2 wrong input", "130 interrupted"})
    EXPECT_TRUE(contains(outcome.out, part)) << part << outcome.out;
}

}  // namespace
}  // namespace loopwright::command_line_test
