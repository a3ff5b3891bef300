#include "tools/command/command_line.h"
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include "engine/file/output_files.h"
#include "engine/json/reader.h"

namespace loopwright {
namespace {

/// The program, and the nested commands that were recognized.
std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  std::vector<const CLI::App*> commands{&app};
  while (!commands.back()->get_subcommands().empty())
    commands.push_back(commands.back()->get_subcommands().front());
  return commands;
}

std::string name_of(const std::vector<const CLI::App*>& commands) {
  std::string name = "loopwright";
  for (size_t i = 1; i < commands.size(); ++i) name += " " + commands[i]->get_name();
  return name;
}

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::vector<std::string> names_of_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

bool is_option(const std::string& word) { return word.size() > 1 && word[0] == '-' && word != "--"; }

/// "--report", "-o" or "diagram", as the user writes it.
std::string name_of(const CLI::Option& option) {
  return option.get_positional() ? option.get_name(true) : option.get_name();
}

/// "a whole number from 0 to 99" for CLI11's "INT in [0 - 99]".
std::string what_it_takes(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  std::string text = type.starts_with("INT")     ? "a whole number"
                     : type.starts_with("FLOAT") ? "a finite number"
                     : type.starts_with("TEXT")  ? "a text"
                                                 : type.substr(0, type.find(':'));
  if (type.find("NONNEGATIVE") != type.npos)
    text += ", 0 or more";
  else if (type.find("POSITIVE") != type.npos)
    text += " above zero";
  const size_t low = type.find("in ["), middle = type.find(" - "), end = type.find(']');
  if (low != type.npos && middle != type.npos && end != type.npos)
    text += fmt::format(" from {} to {}", type.substr(low + 4, middle - low - 4),
                        type.substr(middle + 3, end - middle - 3));
  return text;
}

void refuse_value(const CLI::Option& option, const std::string& found, Problems& problems) {
  auto& p = problems.error({}, "", "", fmt::format("{} does not take this value", name_of(option)));
  p.expected = fmt::format("{} with {}", name_of(option), what_it_takes(option));
  p.found = found;
  p.hint = option.get_description();
}

/// The option that CLI11's message is about: the message contains its name.
const CLI::Option* option_in(const std::string& message, const CLI::App& command) {
  const CLI::Option* found = nullptr;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = name_of(*option);
    if (message.find(name) != message.npos && (!found || name.size() > name_of(*found).size()))
      found = option;
  }
  return found;
}

class Explanation {
 public:
  Explanation(const CLI::App& app, const CLI::ParseError& error)
      : commands_(commands_of(app)), command_(*commands_.back()), error_(error) {}

  Problems problems() {
    tell_unknown_options();
    if (problems_.has_errors()) return std::move(problems_);
    if (!tell_command() && !tell_missing() && !tell_extra()) tell_value();
    return std::move(problems_);
  }

 private:
  Problem& error(std::string message) { return problems_.error({}, "", "", std::move(message)); }
  std::string help() const { return fmt::format("`{} --help` lists what there is", name_of(commands_)); }

  void tell_unknown_options() {
    for (size_t i = 0; i < commands_.size(); ++i)
      for (const std::string& word : commands_[i]->remaining()) {
        if (!is_option(word)) continue;
        const std::string name = word.substr(0, word.find('='));
        const std::vector<const CLI::App*> path(commands_.begin(), commands_.begin() + ptrdiff_t(i) + 1);
        auto& p = error(fmt::format("{} has no option \"{}\"", name_of(path), name));
        const std::string near = nearest_name(name, names_of_options(*commands_[i]));
        p.hint = near.empty() ? fmt::format("`{} --help` lists what there is", name_of(path))
                              : fmt::format("did you mean \"{}\"?", near);
      }
  }

  /// A command is missing or misspelled.
  bool tell_command() {
    const std::vector<std::string> known = names_of_commands(command_);
    if (known.empty()) return false;
    const std::vector<std::string> words = command_.remaining();
    if (words.empty() && command_.get_require_subcommand_min() == 0) return false;
    if (words.empty()) {
      auto& p = error(fmt::format("{}: no command is given", name_of(commands_)));
      p.expected = fmt::format("one of {}", fmt::join(known, ", "));
      p.hint = help();
      return true;
    }
    // Where a file may take the command's position, a word close to a command was probably meant as the
    // command.
    std::string wrong = words.front();
    for (const CLI::Option* option : command_.get_options())
      if (option->get_positional() && option->count() > 0) wrong = option->results().front();
    const std::string near = nearest_name(wrong, known);
    if (near.empty() && command_.get_require_subcommand_min() == 0) return false;
    auto& p = error(fmt::format("{} has no command \"{}\"", name_of(commands_), wrong));
    if (near.empty())
      p.expected = fmt::format("one of {}", fmt::join(known, ", "));
    else
      p.hint = fmt::format("did you mean \"{}\"?", near);
    return true;
  }

  bool tell_missing() {
    for (const CLI::Option* option : command_.get_options()) {
      const bool is_missing = option->count() == 0 && (option->get_required() || is_named_missing(*option));
      if (!is_missing) continue;
      auto& p = error(fmt::format("{}: {} is missing", name_of(commands_), name_of(*option)));
      p.expected = option->get_description();
    }
    return problems_.has_errors();
  }
  bool is_named_missing(const CLI::Option& option) const {
    return error_.get_name() == "RequiredError" && error_.what() == option.get_name(true) + " is required";
  }

  bool tell_extra() {
    for (const std::string& word : command_.remaining())
      error(fmt::format("{}: \"{}\" is one argument too many", name_of(commands_), word)).hint = help();
    return problems_.has_errors();
  }

  /// A value that is missing, superfluous, or invalid for the option.
  void tell_value() {
    const std::string message = error_.what();
    const CLI::Option* option = option_in(message, command_);
    if (!option) {
      error(fmt::format("{}: {}", name_of(commands_), message)).hint = help();
      return;
    }
    const std::string name = name_of(*option);
    if (error_.get_name() == "ExcludesError") {
      error(fmt::format("{}: {} do not go together", name_of(commands_), both_of(message))).hint = help();
      return;
    }
    const std::vector<std::string> values = option->results();
    const bool takes_none = option->get_items_expected_max() == 0;
    if (!takes_none && !values.empty())
      return refuse_value(*option, fmt::format("{}", fmt::join(values, " ")), problems_);
    auto& p =
        error(takes_none ? fmt::format("{} takes no value", name) : fmt::format("{} has no value", name));
    p.expected = takes_none ? name : fmt::format("{} with {}", name, what_it_takes(*option));
    p.found = fmt::format("{}", fmt::join(values, " "));
    p.hint = option->get_description();
  }
  static std::string both_of(const std::string& message) {
    constexpr std::string_view verb = " excludes ";
    const size_t at = message.find(verb);
    return at == message.npos
               ? message
               : fmt::format("{} and {}", message.substr(0, at), message.substr(at + verb.size()));
  }

  std::vector<const CLI::App*> commands_;
  const CLI::App& command_;
  const CLI::ParseError& error_;
  Problems problems_;
};

// ---- values that CLI11 accepts ----

bool is_whole_number(const CLI::Option& option) { return option.get_type_name().starts_with("INT"); }
bool is_number(const CLI::Option& option) {
  return is_whole_number(option) || option.get_type_name().starts_with("FLOAT");
}

/// CLI11 reads 99999999999999999999 as the greatest number, 010 as eight, and accepts "nan" for any range.
bool is_in_range(const CLI::Option& option, const std::string& value) {
  if (!is_whole_number(option)) return std::isfinite(std::strtod(value.c_str(), nullptr));
  int64_t number = 0;
  const char* const end = value.data() + value.size();
  const auto [rest, code] = std::from_chars(value.data(), end, number);
  return code == std::errc() && rest == end && (value == "0" || value[0] != '0');
}

struct NamedFile {
  std::string option, path;
  bool is_output;
};

bool names_output(const CLI::Option& option) {
  constexpr std::array<std::string_view, 8> names = {"--output", "--report", "--json",  "--csv",
                                                     "--svg",    "--png",    "--model", "--checkpoint"};
  return !option.get_positional() && std::ranges::find(names, name_of(option)) != names.end();
}
bool names_input(const CLI::Option& option) {
  constexpr std::array<std::string_view, 8> names = {"--replay", "--resume", "--on", "--beside", "--hold-out",
                                                     "--blocks", "--effects", "--more-effects"};
  return option.get_positional() || std::ranges::find(names, name_of(option)) != names.end();
}

/// A checkpoint may take the place of the one that the run goes on from: that one has been read by then.
bool is_resumed(const NamedFile& output, const std::vector<NamedFile>& files) {
  return output.option == "--checkpoint" && std::ranges::any_of(files, [&](const NamedFile& file) {
           return file.option == "--resume" && is_same_file(file.path, output.path);
         });
}

void refuse_shared_files(const std::vector<NamedFile>& files, Problems& problems) {
  for (size_t i = 0; i < files.size(); ++i)
    for (size_t k = 0; k < i; ++k) {
      const NamedFile &first = files[k], &second = files[i];
      if (!(first.is_output || second.is_output) || !is_same_file(first.path, second.path)) continue;
      if (is_resumed(first, {second}) || is_resumed(second, {first})) continue;
      auto& p = problems.error({}, "", "",
                               fmt::format("{} and {} name the same file", first.option, second.option));
      p.found = first.path == second.path ? first.path : fmt::format("{} and {}", first.path, second.path);
      p.hint = "an output needs a file of its own";
    }
}

}  // namespace

Problems explain(const CLI::App& app, const CLI::ParseError& error) {
  return Explanation(app, error).problems();
}

void check_values(const CLI::App& app) {
  Problems problems;
  std::vector<NamedFile> files;
  for (const CLI::App* command : commands_of(app))
    for (const CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() == 0) continue;
      for (const std::string& value : option->results()) {
        if (value.empty())
          problems.error({}, "", "", fmt::format("{} has an empty value", name_of(*option))).hint =
              option->get_description();
        else if (is_number(*option) && !is_in_range(*option, value))
          refuse_value(*option, value, problems);
        else if (value != "-" && (names_output(*option) || names_input(*option)))
          files.push_back({name_of(*option), value, names_output(*option)});
      }
    }
  refuse_shared_files(files, problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
  for (const NamedFile& file : files)
    if (file.is_output && !is_resumed(file, files)) reserve_for_output(file.path, file.option);
}

}  // namespace loopwright
