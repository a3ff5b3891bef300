/// A SiteModel from the user's diagram and records.
#include <fmt/format.h>
#include <algorithm>
#include "engine/block.h"
#include "engine/json/reader.h"
#include "engine/run/run.h"
#include "tools/compare/machine.h"
#include "tools/diagnose/predict/axis_model.h"
#include "tools/diagnose/predict/site_model.h"
#include "tools/experiment/balances.h"
#include "tools/experiment/experiment_ports.h"

namespace loopwright::diagnosis {
namespace {

/// Takes the place of the ExternalSignal at a site. It has no inputs: it reads the numbers of the run, in the
/// order of evaluation behind those on which its terms may depend.
struct SiteBlock {
  const SiteSignal* signal = nullptr;
  struct Out {
    double y;
  };
  static constexpr auto describe() {
    return block("The terms at a site.", output(&Out::y, "y", "$y", "Their sum"));
  }
  void outputs(const Instant& now, Out& out) const { out.y = signal ? signal->value(now.time) : 0; }
};

const BlockType& site_block_type() {
  static const BlockType type{info_of<SiteBlock>("SiteBlock"), kernels_of<SiteBlock, double>(), nullptr};
  return type;
}

/// The recorded inputs as signals that this program sets, and a solver that plays no part.
LoadOptions driven_by(const Experiment& experiment, LoadOptions options) {
  options = with_own_values(experiment, std::move(options));
  for (const RecordedSignal& signal : experiment.drives) {
    Drive drive;
    drive.port = signal.port, drive.type = "ExternalSignal", drive.output = "y";
    drive.settings.kind = Value::Kind::object, drive.settings.place = signal.place;
    options.drives.push_back(std::move(drive));
  }
  const std::pair<const char*, const char*> solver[] = {
      {"solver.method", "rk4"}, {"solver.step", "1 ms"}, {"solver.start", "0 s"}, {"solver.stop", "1 s"}};
  for (const auto& [key, value] : solver) options.set.emplace_back(key, value);
  return options;
}

/// One for all records, or one for each where they have values of their own.
std::vector<LoadOptions> options_of_runs(const std::vector<std::shared_ptr<const Experiment>>& experiments,
                                         const LoadOptions& options) {
  std::vector<LoadOptions> list;
  const bool have_own =
      std::ranges::any_of(experiments, [](const auto& experiment) { return !experiment->set.empty(); });
  for (const auto& experiment : experiments)
    if (have_own || list.empty()) list.push_back(driven_by(*experiment, options));
  return list;
}

/// Numbers, states and blocks must be those of the first record.
void reject_other_structure(const std::vector<std::shared_ptr<const Plan>>& plans,
                            const std::vector<std::shared_ptr<const Experiment>>& experiments,
                            Problems& problems) {
  const Plan& first = *plans.front();
  for (size_t r = 1; r < plans.size(); ++r) {
    const Plan& plan = *plans[r];
    const bool is_alike =
        plan.signals == first.signals && plan.states == first.states &&
        std::ranges::equal(plan.blocks, first.blocks, {}, &Plan::Block::path, &Plan::Block::path);
    if (is_alike) continue;
    auto& p = problems.error(experiments[r]->place, "/set", "",
                             "with the values of this record the diagram has other states or blocks");
    p.expected = "values that leave the blocks and their states as they are in " + experiments.front()->path;
  }
}

/// Name of the block that load_diagram adds for a drive.
std::string driver_of(std::string port) {
  std::ranges::replace_if(
      port, [](char c) { return c == '.' || c == '[' || c == ']'; }, '_');
  return "recorded_" + port;
}

int block_at(const Plan& plan, const std::string& path) {
  const auto found = std::ranges::find(plan.blocks, path, &Plan::Block::path);
  return found == plan.blocks.end() ? -1 : int(found - plan.blocks.begin());
}

bool reads(const Plan::Block& block, Number number) {
  return std::ranges::any_of(block.inputs,
                             [&](const auto& port) { return std::ranges::find(port, number) != port.end(); });
}

/// A term is computed as late as its reader allows, so that it may depend on everything computed before.
void evaluate_late(Plan& plan, int block) {
  const auto entry = std::ranges::find_if(plan.order, [&](const Plan::Entry& e) {
    return e.kind == Plan::Entry::Kind::outputs && e.block == block;
  });
  const Number output = plan.blocks[size_t(block)].outputs[0];
  const auto reader = std::find_if(entry, plan.order.end(), [&](const Plan::Entry& e) {
    return e.kind == Plan::Entry::Kind::algebraic_loop || reads(plan.blocks[size_t(e.block)], output);
  });
  if (entry != plan.order.end() && reader != entry) std::rotate(entry, entry + 1, reader);
}

/// Sites by the names that an experiment gives.
void limit_search(std::vector<Site>& sites, const std::vector<Wire>& wanted_sites, Problems& problems) {
  if (wanted_sites.empty()) return;
  KnownNames names;
  for (Site& site : sites) site.is_searched = false, names.add(site.name);
  for (const Wire& wanted : wanted_sites) {
    bool is_known = false;  // a port that is driven directly has two: of its input, and of what is added
    for (Site& site : sites)
      if (site.name == wanted.source) site.is_searched = is_known = true;
    if (!is_known)
      names.explain(problems.error(wanted.place, "/sites", "", "nothing can be missing there"),
                    wanted.source);
  }
}

void reject_what_remembers(const Plan& plan, const std::vector<bool>& needed, Problems& problems) {
  for (size_t b = 0; b < plan.blocks.size(); ++b) {
    const Plan::Block& block = plan.blocks[b];
    if (!needed[b]) continue;
    const Kernels<double>& kernels = block.type->kernels;
    if (!block.period && !kernels.accept && !kernels.update) continue;
    auto& p = problems.error(block.place, "", block.path,
                             fmt::format("{} remembers more than states: a diagnosis without roles cannot "
                                         "estimate it",
                                         block.type->info.type));
    p.expected = "between the driven ports and the compared ones, blocks without samples and memory";
    p.hint = "drive the port behind it by a recorded column, or name the roles of an axis";
  }
  if (plan.algebraic_loops.empty()) return;
  problems.error({}, "", "", "a diagnosis without roles cannot use a diagram with algebraic loops").found =
      plan.algebraic_loops.front().text;
}

}  // namespace

SiteModel::SiteModel(const std::string& diagram, const std::vector<std::string>& paths,
                     const LoadOptions& options) {
  Problems problems;
  Experiments experiments;
  std::vector<SignalRecord> records;
  for (const std::string& path : paths) {
    experiments.push_back(load_experiment(path, problems));
    if (!experiments.back()) throw InputError(std::move(problems));
    reject_map(*experiments.back(), problems);
    records.push_back(read_signal_record(*experiments.back(), problems));
  }
  if (!problems.has_errors()) record_ = joined(records, problems);
  if (!problems.has_errors()) build(diagram, options, experiments, problems);
  if (problems.has_errors()) explain_failure(diagram, paths, options, std::move(problems));
  find_variables();
  for (const RecordedInput& input : record_.inputs)  // the user's name for it
    for (SiteVariable& variable : variables_)
      if (variable.name == driver_of(input.port) + ".y") variable.name = input.port;
  Problems ignored;  // a diagram whose inputs only the record provides
  const auto stated = load_diagram(diagram, with_own_values(*experiments.front(), options), ignored);
  if (const auto plan = stated ? compile(*stated, ignored) : nullptr) complete_units(*plan);
  find_differences();
  find_nearness();
}

SiteModel::OwnRun::OwnRun(std::shared_ptr<const Plan> of) : plan(std::move(of)) {}
SiteModel::OwnRun::OwnRun(const OwnRun& other) : plan(other.plan), parameters(other.parameters) {}
SiteModel::OwnRun::OwnRun(OwnRun&&) noexcept = default;
SiteModel::OwnRun::~OwnRun() = default;

SiteModel::SiteModel(const SiteModel&) = default;

std::unique_ptr<SiteModel> SiteModel::another() const {
  std::unique_ptr<SiteModel> copy(new SiteModel(*this));
  copy->is_read_ = nullptr, copy->work_ = {};
  for (OwnRun& own : copy->runs_) {
    own.plan = copy->with_site_blocks(*own.plan);  // that read its own signals
    copy->start(own);
    own.parameters.act_on(*own.run);
  }
  copy->plan_ = copy->runs_.front().plan;
  copy->use(std::vector(parameters_.size(), 1.0), {});
  return copy;
}

/// The sources that the record replaces may be those that state a unit.
void SiteModel::complete_units(const Plan& stated) {
  const auto complete = [&](const std::string& port, std::optional<Unit>& unit, Quantity& quantity) {
    const std::vector<Number> numbers = stated.find(port);
    if (unit || numbers.size() != 1) return;
    unit = stated.unit_of(numbers[0]);
    if (quantity == Quantity::other) quantity = quantity_of(unit);
  };
  for (Site& site : sites_) complete(site.name, site.unit, site.quantity);
  for (SiteVariable& variable : variables_) complete(variable.name, variable.unit, variable.quantity);
}

void SiteModel::add_sensors(const Plan& plan) {
  for (const RecordedOutput& output : record_.outputs) {
    Site site;
    site.kind = Site::Kind::sensor, site.is_searched = false;  // unless the experiment names it
    site.name = output.port + " (sensor)", site.own_signal = output.port;
    site.unit = plan.unit_of(plan.find(output.port).front()), site.quantity = quantity_of(site.unit);
    sensor_sites_.push_back(sites_.size());
    sites_.push_back(std::move(site));
  }
}

/// In the units of the diagram's ports.
void SiteModel::read_records(const std::vector<std::shared_ptr<const Plan>>& plans,
                             const Experiments& experiments, Problems& problems) {
  std::vector<SignalRecord> records;
  for (size_t r = 0; r < experiments.size(); ++r) {
    const Plan& plan = *plans[plans.size() > 1 ? r : 0];
    logging(plan, *experiments[r], problems);
    records.push_back(read_signal_record(in_units_of_ports(plan, *experiments[r]), problems));
  }
  if (!problems.has_errors()) record_ = joined(records, problems);
}

std::shared_ptr<const Plan> SiteModel::with_site_blocks(const Plan& compiled) const {
  auto plan = std::make_shared<Plan>(compiled);
  for (size_t s = 0; s < sites_.size(); ++s) {
    const int block = site_blocks_[s];
    if (block < 0) continue;
    plan->blocks[size_t(block)].type = &site_block_type();
    plan->blocks[size_t(block)].value = std::make_shared<SiteBlock>(SiteBlock{&signals_[s]});
    evaluate_late(*plan, block);
  }
  return plan;
}

void SiteModel::build(const std::string& path, const LoadOptions& options, const Experiments& experiments,
                      Problems& problems) {
  const std::vector<LoadOptions> driven = options_of_runs(experiments, options);
  std::vector<std::shared_ptr<const Diagram>> diagrams;
  std::vector<std::shared_ptr<const Plan>> plain, compiled;
  for (const LoadOptions& own : driven) {
    diagrams.push_back(load_diagram(path, own, problems));
    plain.push_back(diagrams.back() ? compile(*diagrams.back(), problems) : nullptr);
    if (!plain.back() || problems.has_errors()) return;
  }
  read_records(plain, experiments, problems);
  if (problems.has_errors()) return;
  for (size_t r = 0; r < driven.size(); ++r) {
    sites_.clear();  // alike for all records
    compiled.push_back(compile(*with_sites(*diagrams[r], *plain[r], sites_), problems));
    if (!compiled.back() || problems.has_errors()) return;
  }
  reject_other_structure(compiled, experiments, problems);
  add_sensors(*plain.front());
  signals_.resize(sites_.size());
  for (const Site& site : sites_)
    site_blocks_.push_back(site.kind == Site::Kind::sensor ? -1
                                                           : block_at(*compiled.front(), site.term_block));
  for (const auto& plan : compiled) runs_.emplace_back(with_site_blocks(*plan));
  for (const RecordedInput& input : record_.inputs)
    for (Site& site : sites_)
      if (site.own_signal == driver_of(input.port) + ".y") site.name = site.own_signal = input.port;
  std::vector<Wire> wanted;
  for (const auto& experiment : experiments) std::ranges::copy(experiment->sites, std::back_inserter(wanted));
  limit_search(sites_, wanted, problems);
  if (problems.has_errors()) return;
  find_inputs_and_outputs(*runs_.front().plan, problems);
  if (problems.has_errors()) return;
  for (size_t r = 0; r < runs_.size(); ++r) {
    start(runs_[r]);
    runs_[r].parameters = find_parameters(path, driven[r], *diagrams[r], *runs_[r].plan, *runs_[r].run);
  }
  plan_ = runs_.front().plan;
  share_parameters(experiments);
  leave_idle_sites_out();
  lines_.resize(record_.inputs.size()), draw_all_lines();
  for (auto& slope : slope_) slope.resize(size_t(plan_->states));
  for (auto* list : {&stage_, &begin_, &changed_}) list->resize(size_t(plan_->states));
  for (const std::span<char> mode : runs_.front().modes) mode_bytes_ += mode.size();
  mode_bytes_ += signals_.size() * sizeof(SiteSignal::memory);
}

/// Only what the outputs need is computed.
void SiteModel::start(OwnRun& own) {
  auto pruned = std::make_shared<Plan>(*own.plan);
  const std::vector<bool> needed = blocks_behind(*pruned, outputs_, {});
  std::erase_if(pruned->order, [&](const Plan::Entry& entry) {
    return entry.kind != Plan::Entry::Kind::algebraic_loop && !needed[size_t(entry.block)];
  });
  own.plan = std::move(pruned);
  own.run = std::make_unique<Run<double>>(*own.plan);
  own.numbers = reinterpret_cast<double*>(own.run->arena().data());
  switch_off_noise(*own.run, *own.plan);
  for (const RecordedInput& input : record_.inputs) {
    const std::string block = driver_of(input.port);
    own.inputs.push_back({own.run->parameter(block + ".value"), own.run->parameter(block + ".slope"),
                          own.run->parameter(block + ".since")});
  }
  for (size_t b = 0; b < own.plan->blocks.size(); ++b)
    if (const size_t bytes = own.plan->blocks[b].type->kernels.mode_size; bytes > 0)
      own.modes.emplace_back(static_cast<char*>(own.run->call(int(b)).mode), bytes);
}

/// What every record has, and none states for itself: that is known.
void SiteModel::share_parameters(const Experiments& experiments) {
  const auto is_known = [&](const std::string& name) {
    return std::ranges::any_of(experiments, [&](const auto& experiment) {
      return std::ranges::find(experiment->set, name, &Value::Member::name) != experiment->set.end();
    });
  };
  const auto in_all = [&](const std::string& name) {
    return std::ranges::all_of(runs_, [&](const OwnRun& own) {
      const std::vector<ModelParameter>& list = own.parameters.list;
      return std::ranges::find(list, name, &ModelParameter::name) != list.end();
    });
  };
  std::vector<std::string> shared;
  for (const ModelParameter& parameter : runs_.front().parameters.list)
    if (in_all(parameter.name) && !is_known(parameter.name)) shared.push_back(parameter.name);
  for (OwnRun& own : runs_) {
    std::vector<ModelParameter> list;
    for (const std::string& name : shared)
      list.push_back(std::move(*std::ranges::find(own.parameters.list, name, &ModelParameter::name)));
    own.parameters.list = std::move(list);
  }
  for (size_t i = 0; i < shared.size(); ++i) {
    const auto size = [&](const OwnRun& own) { return std::abs(own.parameters.list[i].nominal); };
    const double least = std::ranges::min_element(runs_, {}, size)->parameters.list[i].nominal;
    for (OwnRun& own : runs_) own.parameters.list[i].refer_to(least);
  }
  parameters_ = runs_.front().parameters.list;
}

/// Sensors that count or sample are left out: their resolution is noise of the measurement.
void SiteModel::find_inputs_and_outputs(const Plan& plan, Problems& problems) {
  if (plan.states == 0)
    problems.error({}, "", "", "a diagnosis without roles needs a diagram with continuous states");
  for (const RecordedOutput& output : record_.outputs) {
    Number number = plan.find(output.port).front();
    const Number state = state_behind(plan, number);
    if (state >= 0 && (number == state || is_sampled_between(plan, state, number))) number = state;
    outputs_.push_back(number);
    measured_state_.push_back(number >= plan.signals ? number - plan.signals : -1);
    all_are_states_ &= number >= plan.signals;
  }
  const std::vector<bool> needed = blocks_behind(plan, outputs_, {});
  reject_what_remembers(plan, needed, problems);
  has_decisions_ = std::ranges::any_of(plan.order, [&](const Plan::Entry& e) {
    return e.kind == Plan::Entry::Kind::decide && needed[size_t(e.block)];
  });
}

}  // namespace loopwright::diagnosis
