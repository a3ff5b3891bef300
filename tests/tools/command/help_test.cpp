// Every command says in its --help how it is used, in lines that it understands. Messages are coloured on a
// terminal only.
#include <gmock/gmock.h>
#include <pty.h>
#include <regex>
#include "tests/tools/command/program.h"

namespace loopwright::help_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The names below "Subcommands:" in a --help.
std::vector<std::string> commands_in(const std::string& help) {
  std::vector<std::string> names;
  std::istringstream lines(help.substr(std::min(help.find("Subcommands:"), help.size())));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.starts_with("  "))
    if (line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
  return names;
}

/// All commands, also those inside others: {"gp", "train"}.
std::vector<std::vector<std::string>> all_commands(const std::vector<std::string>& outer = {}) {
  std::vector<std::string> arguments = outer;
  arguments.push_back("--help");
  std::vector<std::vector<std::string>> all;
  for (const std::string& name : commands_in(loopwright_program(arguments).out)) {
    all.push_back(outer);
    all.back().push_back(name);
    for (auto& inner : all_commands(all.back())) all.push_back(std::move(inner));
  }
  return all;
}

/// The options of a command whose --help says that they write a file, and its required arguments.
struct Writers {
  std::vector<std::string> options, required;
  int arguments = 0;
};
Writers writers_in(const std::string& help) {
  Writers writers;
  std::istringstream lines(help);
  const std::regex option("  (?:-., ?)?(--[a-z0-9-]+) [^ ].*  +(Write|Draw) .*"),
      argument("  [a-z]+ .*REQUIRED.*"), required("  (?:-., ?)?(--[a-z0-9-]+) .*REQUIRED.*");
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, option)) writers.options.push_back(match[1]);
    if (std::regex_match(line, match, required)) writers.required.push_back(match[1]);
    writers.arguments += std::regex_match(line, argument);
  }
  return writers;
}

TEST(Help, EveryOptionThatWritesAFileRefusesTheFileThatIsRead) {
  DiagramFolder folder;
  folder.with("same.json", "{}");
  size_t options = 0;
  for (const std::vector<std::string>& command : all_commands()) {
    std::vector<std::string> asks = command;
    asks.push_back("--help");
    const Writers writers = writers_in(loopwright_program(asks).out);
    if (writers.arguments == 0) continue;
    for (const std::string& option : writers.options) {
      std::vector<std::string> arguments = command;
      for (int i = 0; i < writers.arguments; ++i) arguments.push_back("same.json");
      arguments.insert(arguments.end(), {option, "./same.json"});
      for (const std::string& other : writers.required)
        if (other != option) arguments.insert(arguments.end(), {other, "other"});
      const Outcome outcome = loopwright_program(arguments, folder.path(""));
      EXPECT_EQ(outcome.code, 2) << testing::PrintToString(arguments);
      EXPECT_THAT(outcome.err, HasSubstr("name the same file")) << testing::PrintToString(arguments);
      EXPECT_EQ(text_of(folder.path("same.json")), "{}") << testing::PrintToString(arguments);
      ++options;
    }
  }
  EXPECT_GE(options, 25u);
}

TEST(Help, OfEveryCommandHasExamplesThatItUnderstands) {
  DiagramFolder empty;
  setenv("HOME", empty.path("").c_str(), 1);
  const std::regex not_understood(
      "has no option|has no command| is missing|does not take|is not expected|excludes");
  const auto commands = all_commands();
  EXPECT_GE(commands.size(), 25u);
  for (std::vector<std::string> command : commands) {
    command.push_back("--help");
    const std::string help = loopwright_program(command).out;
    const size_t begin = help.find("\nExample");
    ASSERT_NE(begin, help.npos) << testing::PrintToString(command);
    std::istringstream lines(help.substr(begin + 1));
    std::string line;
    std::getline(lines, line);
    int examples = 0;
    while (std::getline(lines, line) && line.starts_with("  loopwright ")) {
      ++examples;
      const std::string arguments = line.substr(13, line.find(" > ") - 13);
      const std::string run =
          "cd " + empty.path("") + " && " + program() + " " + arguments + " >out 2>err </dev/null";
      const int code = WEXITSTATUS(std::system(run.c_str()));
      const std::string err = text_of(empty.path("err"));
      EXPECT_TRUE(code == 0 || code == 2) << line << "\n" << err;
      EXPECT_FALSE(std::regex_search(err, not_understood)) << line << "\n" << err;
    }
    EXPECT_GT(examples, 0) << help;
  }
}

/// What the program writes to a terminal.
std::string on_terminal(const std::vector<std::string>& arguments, const std::string& folder) {
  int terminal = -1;
  const pid_t process = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (process == 0) {
    std::vector<char*> raw;
    std::string name = program();
    raw.push_back(name.data());
    for (const std::string& argument : arguments) raw.push_back(const_cast<char*>(argument.c_str()));
    raw.push_back(nullptr);
    if (chdir(folder.c_str()) == 0) execv(raw[0], raw.data());
    _exit(98);
  }
  std::string text;
  char part[4096];
  for (ssize_t n; (n = read(terminal, part, sizeof part)) > 0;) text.append(part, size_t(n));
  waitpid(process, nullptr, 0);
  close(terminal);
  return text;
}

class Colours : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("TERM", "xterm", 1);
    unsetenv("NO_COLOR");
    folder.with("wrong.json",
                R"({"loopwright": 1, "solver": {"stop": 1}, "blocks": {"a": {"type": "Gian"}}})");
  }
  DiagramFolder folder;
};

TEST_F(Colours, AreOnATerminalOnly) {
  const std::string shown = on_terminal({"check", "wrong.json"}, folder.path(""));
  EXPECT_THAT(shown, HasSubstr("\033[1;31merror:\033[0m there is no block type \"Gian\""));
  EXPECT_THAT(shown, HasSubstr("\033[36m  hint:\033[0m did you mean \"Gain\"?"));
  const Outcome outcome = loopwright_program({"check", "wrong.json"}, folder.path(""));
  EXPECT_THAT(outcome.err, HasSubstr("error: there is no block type \"Gian\""));
  EXPECT_THAT(outcome.err, Not(HasSubstr("\033")));
}

TEST_F(Colours, CanBeRefused) {
  setenv("NO_COLOR", "1", 1);
  EXPECT_THAT(on_terminal({"check", "wrong.json"}, folder.path("")), Not(HasSubstr("\033")));
  unsetenv("NO_COLOR");
  setenv("TERM", "dumb", 1);
  EXPECT_THAT(on_terminal({"check", "wrong.json"}, folder.path("")), Not(HasSubstr("\033")));
}

TEST_F(Colours, NeverPassOnThoseOfAFile) {
  folder.with("wrong.json", "{\"loopwright\": 1, \"blocks\": {\"a\": {\"type\": \"\\u001b[2J\"}}}");
  EXPECT_THAT(on_terminal({"check", "wrong.json"}, folder.path("")), Not(HasSubstr("\033[2J")));
}

}  // namespace
}  // namespace loopwright::help_test
