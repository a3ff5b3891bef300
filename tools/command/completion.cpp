/// Shell completion and the manual page, from the descriptions of the subcommands themselves.
#include <fmt/format.h>
#include "tools/command/command.h"

namespace loopwright {
namespace {

/// Names and options as text; hidden groups have neither.
std::vector<const CLI::App*> inner_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}
std::string long_options(const CLI::App& command) {
  std::string names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names += (names.empty() ? "--" : " --") + name;
  return names;
}
std::string names_of(const std::vector<const CLI::App*>& commands) {
  std::string names;
  for (const CLI::App* command : commands) names += (names.empty() ? "" : " ") + command->get_name();
  return names;
}

/// Options after a dash, files otherwise.
std::string bash(const CLI::App& app) {
  std::string cases;
  for (const CLI::App* command : inner_commands(app)) {
    std::string words = long_options(*command);
    const std::string inner = names_of(inner_commands(*command));
    cases += fmt::format("    {}) options=\"{}\" inner=\"{}\" ;;\n", command->get_name(), words, inner);
  }
  return fmt::format(R"(_loopwright() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} options= inner=
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "{} --help --version" -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "$options" -- "$word")) ;;
    *) COMPREPLY=($([ "$COMP_CWORD" -eq 2 ] && compgen -W "$inner" -- "$word"; compgen -f -- "$word")) ;;
  esac
}}
complete -o filenames -F _loopwright loopwright
)",
                     names_of(inner_commands(app)), cases);
}

std::string zsh(const CLI::App& app) {
  return "#compdef loopwright\nautoload -U +X bashcompinit && bashcompinit\n" + bash(app);
}

std::string quoted(std::string text) {
  for (size_t at = 0; (at = text.find('\'', at)) != text.npos; at += 4) text.replace(at, 1, "'\\''");
  return '\'' + text + '\'';
}

std::string fish(const CLI::App& app) {
  std::string text;
  for (const CLI::App* command : inner_commands(app)) {
    text += fmt::format("complete -c loopwright -n __fish_use_subcommand -a {} -d {}\n", command->get_name(),
                        quoted(command->get_description()));
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : option->get_lnames())
        text += fmt::format("complete -c loopwright -n '__fish_seen_subcommand_from {}' -l {} -d {}\n",
                            command->get_name(), name, quoted(option->get_description()));
  }
  return text;
}

/// Text in the language of man pages: a hyphen is a minus, and a line may not begin with a dot.
std::string roff(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '-' || c == '\\') safe += '\\';
    if ((c == '.' || c == '\'') && (safe.empty() || safe.back() == '\n')) safe += "\\&";
    safe += c;
  }
  return safe;
}

std::string manual(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH LOOPWRIGHT 1\n.SH NAME\nloopwright \\- block diagrams of motion control, simulated, deployed and "
      "held "
      "against measurements\n.SH SYNOPSIS\n.B loopwright\n.I COMMAND\n[OPTIONS]\n.SH DESCRIPTION\n{}\n",
      roff(app.get_description()));
  text += ".SH COMMANDS\n";
  for (const CLI::App* command : inner_commands(app)) {
    text +=
        fmt::format(".SS loopwright {}\n{}\n", roff(command->get_name()), roff(command->get_description()));
    for (const CLI::Option* option : command->get_options())
      text += fmt::format(".TP\n.B {}\n{}\n", roff(option->get_name(true, true)), roff(option->get_description()));
  }
  return text + fmt::format(".SH EXIT STATUS\n{}\n", roff(app.get_footer()));
}

}  // namespace

void add_completion(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("completion", "Completion for a shell, or the manual page");
  auto kind = std::make_shared<std::string>();
  command->add_option("kind", *kind, "bash, zsh, fish or man")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish", "man"}));
  command->callback([&app, kind, choose] {
    choose([&app, kind] {
      answer_data(*kind == "bash"   ? bash(app)
                  : *kind == "zsh"  ? zsh(app)
                  : *kind == "fish" ? fish(app)
                                    : manual(app));
      return done;
    });
  });
}

}  // namespace loopwright
