#include "tools/diagnose/predict/site_model.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>
#include "engine/block.h"
#include "engine/json/reader.h"
#include "engine/run/run.h"
#include "tools/compare/machine.h"
#include "tools/diagnose/predict/axis_model.h"
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
    const auto found = std::ranges::find(sites, wanted.source, &Site::name);
    if (found != sites.end())
      found->is_searched = true;
    else
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

SiteModel::~SiteModel() = default;

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
  if (!problems.has_errors()) build(diagram, driven_by(*experiments.front(), options), experiments, problems);
  if (problems.has_errors()) explain_failure(diagram, paths, options, std::move(problems));
  find_variables();
  for (const RecordedInput& input : record_.inputs)  // the user's name for it
    for (SiteVariable& variable : variables_)
      if (variable.name == driver_of(input.port) + ".y") variable.name = input.port;
  Problems ignored;  // a diagram whose inputs only the record provides
  const auto stated = load_diagram(diagram, options, ignored);
  if (const auto plan = stated ? compile(*stated, ignored) : nullptr) complete_units(*plan);
  find_differences();
  find_nearness();
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

int SiteModel::input_of(int site) const {
  const Site& place = sites_[size_t(site)];
  if (place.kind != Site::Kind::input) return -1;
  const auto found = std::ranges::find(record_.inputs, place.own_signal, &RecordedInput::port);
  return found == record_.inputs.end() ? -1 : int(found - record_.inputs.begin());
}

InputLines SiteModel::change_of_input(const SiteTerm& term) const {
  const InputLines recorded = lines_of(record_, record_.inputs[size_t(input_of(term.site))]);
  return difference(term.shape->late(record_, recorded, term.nonlinear[0], term.nonlinear[1]), recorded);
}

int SiteModel::output_of_sensor(int site) const {
  const auto found = std::ranges::find(sensor_sites_, size_t(site));
  return found == sensor_sites_.end() ? -1 : int(found - sensor_sites_.begin());
}

/// In the units of the diagram's ports.
void SiteModel::read_records(const Plan& plan, const Experiments& experiments, Problems& problems) {
  std::vector<SignalRecord> records;
  for (const auto& experiment : experiments) {
    logging(plan, *experiment, problems);
    records.push_back(read_signal_record(in_units_of_ports(plan, *experiment), problems));
  }
  if (!problems.has_errors()) record_ = joined(records, problems);
}

void SiteModel::build(const std::string& path, const LoadOptions& options, const Experiments& experiments,
                      Problems& problems) {
  const auto diagram = load_diagram(path, options, problems);
  const auto plain = diagram ? compile(*diagram, problems) : nullptr;
  if (!plain || problems.has_errors()) return;
  read_records(*plain, experiments, problems);
  if (problems.has_errors()) return;
  const auto rewritten = with_sites(*diagram, *plain, sites_);
  const auto compiled = compile(*rewritten, problems);
  if (!compiled || problems.has_errors()) return;
  auto plan = std::make_shared<Plan>(*compiled);
  add_sensors(*plain);
  signals_.resize(sites_.size());
  for (size_t s = 0; s < sites_.size(); ++s) {
    if (sites_[s].kind == Site::Kind::sensor) continue;
    const int block = block_at(*plan, sites_[s].term_block);
    plan->blocks[size_t(block)].type = &site_block_type();
    plan->blocks[size_t(block)].value = std::make_shared<SiteBlock>(SiteBlock{&signals_[s]});
    evaluate_late(*plan, block);
  }
  for (const RecordedInput& input : record_.inputs)
    for (Site& site : sites_)
      if (site.own_signal == driver_of(input.port) + ".y") site.name = site.own_signal = input.port;
  std::vector<Wire> wanted;
  for (const auto& experiment : experiments) std::ranges::copy(experiment->sites, std::back_inserter(wanted));
  limit_search(sites_, wanted, problems);
  plan_ = std::move(plan);
  find_inputs_and_outputs(problems);
  if (problems.has_errors()) return;
  run_ = std::make_unique<Run<double>>(*plan_);
  numbers_ = reinterpret_cast<double*>(run_->arena().data());
  for (SiteSignal& signal : signals_) signal.numbers = numbers_;
  switch_off_noise(*run_, *plan_);
  for (const RecordedInput& input : record_.inputs) {
    const std::string block = driver_of(input.port);
    inputs_.push_back({run_->parameter(block + ".value"), run_->parameter(block + ".slope"),
                       run_->parameter(block + ".since")});
  }
  lines_.resize(inputs_.size()), draw_all_lines();
  parameters_ = find_parameters(path, options, *diagram, *plan_, *run_);
  for (auto& slope : slope_) slope.resize(size_t(plan_->states));
  stage_.resize(size_t(plan_->states));
  for (size_t b = 0; b < plan_->blocks.size(); ++b)
    if (const size_t bytes = plan_->blocks[b].type->kernels.mode_size; bytes > 0)
      modes_.emplace_back(static_cast<char*>(run_->call(int(b)).mode), bytes), mode_bytes_ += bytes;
}

/// Sensors that count or sample are left out: their resolution is noise of the measurement.
void SiteModel::find_inputs_and_outputs(Problems& problems) {
  if (plan_->states == 0)
    problems.error({}, "", "", "a diagnosis without roles needs a diagram with continuous states");
  for (const RecordedOutput& output : record_.outputs) {
    Number number = plan_->find(output.port).front();
    const Number state = state_behind(*plan_, number);
    if (state >= 0 && (number == state || is_sampled_between(*plan_, state, number))) number = state;
    outputs_.push_back(number);
    measured_state_.push_back(number >= plan_->signals ? number - plan_->signals : -1);
    all_are_states_ &= number >= plan_->signals;
  }
  const std::vector<bool> needed = blocks_behind(*plan_, outputs_, {});
  reject_what_remembers(*plan_, needed, problems);
  auto pruned = std::make_shared<Plan>(*plan_);
  std::erase_if(pruned->order, [&](const Plan::Entry& entry) {
    return entry.kind != Plan::Entry::Kind::algebraic_loop && !needed[size_t(entry.block)];
  });
  has_decisions_ = std::ranges::any_of(
      pruned->order, [](const Plan::Entry& e) { return e.kind == Plan::Entry::Kind::decide; });
  plan_ = std::move(pruned);
}

int SiteModel::states() const { return plan_->states; }
int SiteModel::numbers() const { return plan_->signals + plan_->states; }

std::string SiteModel::state_name(int state) const {
  const Plan::Block& block = plan_->blocks[size_t(plan_->block_of_state[size_t(state)])];
  for (size_t o = 0; o < block.outputs.size(); ++o)
    if (block.outputs[o] == plan_->signals + state)
      return fmt::format("{}.{}", block.path, block.type->info.outputs[o].name);
  return block.path;
}

void SiteModel::use(std::span<const double> factors, std::span<const SiteTerm> terms) {
  for (size_t i = 0; i < parameters_.size(); ++i) parameters_[i].set(factors[i]);
  for (SiteSignal& signal : signals_) signal.terms.clear(), signal.held = signal.ramp = 0;
  if (std::exchange(is_late_, false)) draw_all_lines();
  for (const SiteTerm& term : terms) {
    if (term.shape->of != TermShape::Of::past) {
      signals_[size_t(term.site)].terms.emplace_back(
          term, term.variable < 0 ? SiteVariable{} : variables_[size_t(term.variable)]);
      continue;
    }
    InputLines& lines = lines_[size_t(input_of(term.site))];
    lines = term.shape->late(record_, lines, term.nonlinear[0], term.nonlinear[1]), is_late_ = true;
  }
  run_->reset({plan_->seed, 0});
}

void SiteModel::suppose_between_rows(size_t input, BetweenRows between) {
  record_.inputs[input].between_rows = between;
  draw_all_lines();
}

void SiteModel::draw_all_lines() {
  for (size_t i = 0; i < lines_.size(); ++i) lines_[i] = lines_of(record_, record_.inputs[i]);
}

std::vector<double> SiteModel::initial_states() const {
  run_->reset({plan_->seed, 0});
  return {run_->states().begin(), run_->states().end()};
}

void SiteModel::set_inputs(size_t row) {
  for (size_t i = 0; i < inputs_.size(); ++i) {
    const InputLine& line = lines_[i][row];
    *inputs_[i].value = line.value, *inputs_[i].slope = line.slope, *inputs_[i].since = record_.time[row];
  }
}

void SiteModel::keep_modes(char* to) const {
  for (const std::span<char> mode : modes_) to = std::ranges::copy(mode, to).out;
}

void SiteModel::put_modes_back(const char* from) {
  for (const std::span<char> mode : modes_) std::copy_n(from, mode.size(), mode.data()), from += mode.size();
}

bool SiteModel::flow(size_t row, const double* from, double* to, double* middle) {
  set_inputs(row);
  work_.add(size_t(substeps_), 4 * Work::of_a_block * double(plan_->blocks.size()));
  const size_t n = size_t(plan_->states);
  const double begin = record_.time[row], h = record_.step(row) / substeps_;
  std::copy_n(from, n, to);
  for (int step = 0; step < substeps_; ++step) {
    const double t = begin + step * h;
    if (has_decisions_) {
      run_->look_at(t, to);
      run_->evaluate(0, false);
      std::ranges::copy(run_->states(), to);  // it may have jumped
      run_->reuse_signals();
    }
    bool good = run_->derivatives_at(t, to, slope_[0].data());
    for (int k = 1; k < 4; ++k) {
      const double part = k == 3 ? h : 0.5 * h;
      for (size_t i = 0; i < n; ++i) stage_[i] = to[i] + part * slope_[k - 1][i];
      good &= run_->derivatives_at(t + part, stage_.data(), slope_[k].data());
    }
    for (size_t i = 0; i < n; ++i)
      to[i] += h / 6 * (slope_[0][i] + 2 * (slope_[1][i] + slope_[2][i]) + slope_[3][i]);
    if (!good || run_->failed()) {
      run_->restored(run_->now());
      return false;
    }
    if (middle && 2 * (step + 1) == substeps_) std::copy_n(to, n, middle);
  }
  return std::ranges::all_of(std::span(to, n), [](double x) { return std::isfinite(x); });
}

bool SiteModel::look(size_t row, double time, const double* states, double* numbers) {
  set_inputs(row);
  run_->look_at(time, states);
  run_->evaluate(0, true);
  const bool good = !run_->failed();
  if (!good) run_->restored(run_->now());
  std::copy_n(numbers_, this->numbers(), numbers);
  return good;
}

bool SiteModel::outputs(size_t row, const double* states, double* to) {
  bool good = true;
  if (all_are_states_) {
    for (size_t j = 0; j < outputs_.size(); ++j) to[j] = states[outputs_[j] - plan_->signals];
  } else {
    set_inputs(row);
    work_.add(1, Work::of_a_block * double(plan_->blocks.size()));
    run_->look_at(record_.time[row], states);
    run_->evaluate(0, true);
    good = !run_->failed();
    if (!good) run_->restored(run_->now());
    for (size_t j = 0; j < outputs_.size(); ++j) to[j] = numbers_[outputs_[j]];
  }
  for (size_t j = 0; j < outputs_.size(); ++j) {
    const double true_value = to[j];
    for (const auto& [term, variable] : signals_[sensor_sites_[j]].terms) to[j] += term.value(true_value);
  }
  return good;
}

}  // namespace loopwright::diagnosis
