#include "engine/lanes/lane_run.h"
#include <dlfcn.h>
#include <fmt/format.h>
#include <stdexcept>
#include "engine/lanes/lane_run_of.h"
#include "engine/lanes/module.h"
#include "engine/record/installation.h"
#include "engine/run/fault_text.h"

namespace loopwright {
namespace {

bool machine_has(InstructionSet set) {
  switch (set) {
    case InstructionSet::scalar:
      return true;
    case InstructionSet::avx2:
      return __builtin_cpu_supports("avx2");
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
  }
  return false;
}

struct LoadedModule {
  const LaneModule* module = nullptr;
  std::string problem;
};

LoadedModule load(InstructionSet set) {
  static const LaneModule in_program{
      lane_layout, [](const Plan& plan, int) -> LaneRun* { return new LaneRunOf<double>(plan, 1); }};
  if (set == InstructionSet::scalar) return {&in_program, ""};
  if (!machine_has(set)) return {nullptr, fmt::format("this processor does not have {}", to_name(set))};
  const std::string file = library_file(fmt::format("loopwright_lanes_{}.so", to_name(set)));
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) return {nullptr, dlerror()};
  const auto entry = reinterpret_cast<LaneModuleEntry*>(dlsym(library, lane_module_entry));
  const LaneModule* const module = entry ? entry() : nullptr;
  if (!module || module->layout != lane_layout)
    return {nullptr, file + " is not of the same build as this program"};
  return {module, ""};
}
const LoadedModule& loaded(InstructionSet set) {
  static const std::array<LoadedModule, all_instruction_sets.size()> modules{
      load(InstructionSet::scalar), load(InstructionSet::avx2), load(InstructionSet::avx512)};
  return modules[size_t(set)];
}

}  // namespace

std::string lanes_forbidden_by(const Plan& plan) {
  for (const Plan::Block& block : plan.blocks)
    if (block.type->info.has_side_effects)
      return fmt::format("\"{}\" acts on the world outside, one run at a time", block.path);
  if (!is_fixed_step(plan.method) && plan.steps_between_samples)
    return fmt::format("\"{}\" chooses its steps for each run; lanes need a fixed step: euler, heun or rk4",
                       to_name(plan.method));
  return "";
}

std::string lanes_unavailable(InstructionSet set) { return loaded(set).problem; }

InstructionSet widest_instruction_set() {
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2})
    if (lanes_unavailable(set).empty()) return set;
  return InstructionSet::scalar;
}

std::unique_ptr<LaneRun> make_lane_run(const Plan& plan, InstructionSet set, int arenas) {
  if (const std::string reason = lanes_forbidden_by(plan); !reason.empty()) throw std::runtime_error(reason);
  if (const std::string reason = lanes_unavailable(set); !reason.empty()) throw std::runtime_error(reason);
  const int most = set == InstructionSet::scalar ? 1 : most_lanes / lanes_in_arena(set);
  if (arenas < 1 || arenas > most)
    throw std::runtime_error(
        fmt::format("{} arenas of {}: from 1 to {} can run at once", arenas, to_name(set), most));
  return std::unique_ptr<LaneRun>(loaded(set).module->make(plan, arenas));
}

std::string to_text(const LaneFailure& failure, const Plan& plan) {
  const std::string block = failure.block < 0 ? "?" : plan.blocks[size_t(failure.block)].path;
  if (failure.reason) return fault_text(plan, {failure.block, failure.reason}, failure.time);
  return fmt::format("the run diverged: \"{}\" became non-finite at t = {:g} s",
                     failure.number < 0 ? block : plan.name_of(failure.number), failure.time);
}

}  // namespace loopwright
