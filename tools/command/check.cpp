#include <fmt/format.h>
#include <algorithm>
#include "blocks/learning/model_file.h"
#include "engine/json/file_kind.h"
#include "engine/json/json.h"
#include "engine/json/take_unit.h"
#include "hw/drivers.h"
#include "hw/realtime/axes.h"
#include "tools/command/command.h"
#include "tools/experiment/experiment.h"
#include "tools/effects/check_blocks.h"
#include "tools/effects/effect.h"
#include "tools/effects/site_effect.h"
#include "tools/gp/train.h"
#include "tools/run/checked_diagram.h"
#include "tools/sweep/sweep_plan.h"

namespace loopwright {
namespace {

/// The summary of a file without errors; empty after an error.
using FileSummary = std::optional<std::string>;

/// A line about code that deploy and probe would load and run; here nothing is loaded.
std::string foreign_code(const hw::DeviceDescription* device) {
  const std::string code = device ? hw::foreign_code_of(*device) : "";
  return code.empty() ? code : fmt::format("\n{}; check does not load it", code);
}

struct CheckOptions {
  LoadOptions load;
  bool strict_units = false;
};

/// Wires without a unit, counted or rejected.
std::string look_at_units(const WiresWithoutUnit& wires, const CheckOptions& options, Problems& problems) {
  if (options.strict_units) refuse(wires, problems);
  return wires.count ? "; " + to_string(wires) : "";
}

FileSummary check_diagram(const std::string& path, const CheckOptions& options, Problems& problems) {
  const CheckedDiagram checked = check_diagram(load_diagram(path, options.load, problems), problems);
  if (checked.summary().empty()) return {};
  std::string verdict = checked.summary() + look_at_units(checked.without_unit, options, problems);
  if (!checked.plan) return verdict;
  Problems of_deploy;  // reported by deploy
  return verdict + foreign_code(hw::find_hardware(*checked.plan, of_deploy).device.get());
}

FileSummary check_experiment(const std::string& path, Problems& problems) {
  const auto experiment = load_experiment(path, problems);
  if (!experiment) return {};
  return fmt::format("an experiment of {} rows, {} driven and {} compared", experiment->data.rows(),
                     experiment->drives.size(), experiment->compared.size());
}

FileSummary check_sweep(const std::string& path, Problems& problems) {
  const auto sweep = load_sweep(path, problems);
  if (!sweep) return {};
  const SweepPlan plan(sweep);
  for (const std::string& warning : plan.warnings()) problems.warning({}, "", "", warning);
  return fmt::format("a sweep of {} runs over {} axes", plan.runs(), sweep->axes.size());
}

FileSummary check_training(const std::string& path, const LoadOptions& options, Problems& problems) {
  const auto training = load_training(path, options.set, problems);
  const auto samples = training ? collect_samples(*training, problems) : nullptr;
  if (!samples) return {};
  return fmt::format("a training file of {} samples", samples->samples.labels.size());
}

FileSummary check_effect(const std::string& path, Problems& problems) {
  const std::vector<Effect> forms = load_effect(path, problems);
  if (forms.empty()) {
    const auto at_site = problems.has_errors() ? std::nullopt : load_site_effect(path, problems);
    return at_site ? "an effect at a site of any diagram" : FileSummary{};
  }
  for (const Effect& form : forms) check_blocks(form, problems);
  return fmt::format("an effect in {} form{}", forms.size(), forms.size() == 1 ? "" : "s");
}

FileSummary check_device(const std::string& path, Problems& problems) {
  const auto device = hw::load_device(path, {}, problems);
  if (!device) return {};
  return fmt::format("a device of the driver {}, {} inputs and {} outputs{}", device->driver,
                     device->inputs.size(), device->outputs.size(), foreign_code(device.get()));
}

FileSummary check_model(const std::string& path, Problems& problems) {
  const LearnedModel learned = read_model(path, {}, problems);
  return fmt::format("a learned model of {} samples", learned.sample_count);
}

/// Options that change a diagram have no effect on other files: where no file takes one, this is reported
/// rather than ignored.
Problems unused_options(const std::vector<std::string>& paths, const CheckOptions& options) {
  Problems problems, ignored;
  std::vector<FileKind> kinds;
  for (const std::string& path : paths) kinds.push_back(kind_of_file(path, ignored));
  const auto is_there = [&](auto... wanted) {
    return std::ranges::any_of(
        kinds, [&](FileKind kind) { return kind == FileKind::unknown || ((kind == wanted) || ...); });
  };
  const auto reject = [&](std::string_view option) {
    problems.error({}, "", "", fmt::format("{} changes nothing in {}", option, paths.front())).found =
        with_article(kinds.front());
  };
  if (!options.load.set.empty() && !is_there(FileKind::diagram, FileKind::training)) reject("--set");
  if (!options.load.variants.empty() && !is_there(FileKind::diagram)) reject("--variant");
  if (options.strict_units && !is_there(FileKind::diagram)) reject("--strict-units");
  return problems;
}

FileSummary check_file(const std::string& path, const CheckOptions& options, Problems& problems) {
  const FileKind kind = kind_of_file(path, problems);
  if (problems.has_errors()) return {};
  switch (kind) {
    case FileKind::experiment:
      return check_experiment(path, problems);
    case FileKind::sweep:
      return check_sweep(path, problems);
    case FileKind::training:
      return check_training(path, options.load, problems);
    case FileKind::effect:
      return check_effect(path, problems);
    case FileKind::device:
      return check_device(path, problems);
    case FileKind::model:
      return check_model(path, problems);
    case FileKind::diagram:
    case FileKind::unknown:
      break;
  }
  return check_diagram(path, options, problems);
}

/// Reports every problem of every file at once.
int check(const std::vector<std::string>& paths, const CheckOptions& options) {
  int wrong = 0;
  name_changed_readings(true);
  if (const Problems unused = unused_options(paths, options); unused.has_errors()) {
    tell("{}\n", unused.text());
    ++wrong;
  }
  for (const std::string& path : paths) {
    Problems problems;
    FileSummary summary;
    try {
      summary = check_file(path, options, problems);
    } catch (const InputError& error) {
      problems.add(error.problems);
    }
    if (!problems.list().empty()) tell("{}\n", problems.text());
    if (problems.has_errors() || !summary)
      ++wrong;
    else
      answer("{}: fine, {}\n", path, *summary);
  }
  return wrong ? input_wrong : done;
}

}  // namespace

void add_check(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand(
      "check",
      "Say all that is wrong with files: diagrams, experiments, sweeps, training files, effects, "
      "devices, models");
  struct Arguments {
    std::vector<std::string> paths;
    DiagramArguments diagram;
    bool strict_units = false;
  };
  auto arguments = std::make_shared<Arguments>();
  command->add_option("files", arguments->paths, "Files (JSON); what each is, its keys tell")->required();
  command->add_option("--set", arguments->diagram.set, "Change a parameter or setting")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  command->add_option("--variant", arguments->diagram.variants, "Choose a block's variant")
      ->type_name("BLOCK=NAME")
      ->allow_extra_args(false);
  command->add_option("--blocks", arguments->diagram.libraries, "Shared library with more blocks")
      ->type_name("FILE.so")
      ->allow_extra_args(false);
  command->add_flag("--strict-units", arguments->strict_units, "Refuse wires whose unit nothing decides");
  command->callback([=] {
    choose([=] { return check(arguments->paths, {arguments->diagram.options(), arguments->strict_units}); });
  });
}

}  // namespace loopwright
