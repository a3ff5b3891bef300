#include <fmt/format.h>
#include "tools/command/command.h"
#include "tools/reference/reference.h"

namespace loopwright {

static int show(const std::string& type) {
  if (type.empty()) {
    answer("{}", block_list());
    return done;
  }
  if (const BlockType* found = find_block(type)) {
    answer("{}", block_text(found->info));
    return done;
  }
  Problems problems;
  problems.error({}, "", "", fmt::format("there is no block type \"{}\"", type)).hint = block_type_hint(type);
  throw InputError(std::move(problems));
}

static int find(const std::string& words) {
  const std::string found = found_blocks(words);
  if (!found.empty()) {
    answer("{}", found);
    return done;
  }
  Problems problems;
  problems.error({}, "", "", fmt::format("no block and no name elsewhere contains \"{}\"", words)).hint =
      block_type_hint(words);
  throw InputError(std::move(problems));
}

void add_blocks(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("blocks", "List the blocks, or describe one");
  struct Arguments {
    std::string type, words, pictures;
    bool markdown = false;
    DiagramArguments libraries;
  };
  auto a = std::make_shared<Arguments>();
  CLI::Option* const type = command->add_option("type", a->type, "Block type");
  command->add_option("--find", a->words, "Blocks by words, also by their names in Simulink: \"mux\"")
      ->type_name("WORDS")
      ->excludes(type);
  CLI::Option* const markdown = command->add_flag("--markdown", a->markdown, "The whole reference as a page");
  command->add_option("--pictures", a->pictures, "Links to the pictures of blocks in this folder")
      ->type_name("FOLDER")
      ->needs(markdown);
  command->add_option("--blocks", a->libraries.libraries, "Shared library with more blocks")
      ->type_name("FILE.so")
      ->allow_extra_args(false);
  command->callback([=] {
    choose([=]() -> int {
      a->libraries.options();
      if (!a->words.empty()) return find(a->words);
      if (!a->markdown) return show(a->type);
      answer_data(block_reference(a->pictures));
      return done;
    });
  });
}

}  // namespace loopwright
