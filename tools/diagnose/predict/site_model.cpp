#include "tools/diagnose/predict/site_model.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include "engine/run/run.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {

SiteModel::~SiteModel() = default;

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
  for (OwnRun& own : runs_) own.parameters.set(factors);
  for (SiteSignal& signal : signals_)
    signal.terms.clear(), signal.held = signal.ramp = 0, signal.remembering = -1;
  fronts_.clear(), has_memory_ = false;
  if (std::exchange(is_late_, false)) draw_all_lines();
  for (const SiteTerm& term : terms) {
    if (term.shape->of != TermShape::Of::past) {
      SiteSignal& signal = signals_[size_t(term.site)];
      if (term.shape->remembered) signal.remembering = int(signal.terms.size()), has_memory_ = true;
      if (term.shape->has_front && output_of_sensor(term.site) < 0)
        fronts_.push_back({Front(term.nonlinear[0]), size_t(term.site), signal.terms.size()});
      signal.terms.emplace_back(term, term.variable < 0 ? SiteVariable{} : variables_[size_t(term.variable)]);
      continue;
    }
    InputLines& lines = lines_[size_t(input_of(term.site))];
    lines = term.shape->late(record_, lines, term.nonlinear[0], term.nonlinear[1]), is_late_ = true;
  }
  leave_idle_sites_out();
  for (const OwnRun& own : runs_) own.run->reset({own.plan->seed, 0});
}

void SiteModel::leave_idle_sites_out() {
  is_idle_.assign(sites_.size(), false);
  if (runs_.size() > 1) return;  // what is held would be in the numbers of one of them
  std::vector<bool> blocks(plan_->blocks.size(), false);
  for (size_t s = 0; s < sites_.size(); ++s)
    if (site_blocks_[s] >= 0 && signals_[s].terms.empty() && signals_[s].ramp == 0)
      blocks[size_t(site_blocks_[s])] = is_idle_[s] = true;
  runs_.front().run->leave_out(blocks);
}

void SiteModel::hold(int site, double value) {
  signals_[size_t(site)].held = value;
  if (is_idle_[size_t(site)])
    runs_.front().numbers[plan_->blocks[size_t(site_blocks_[size_t(site)])].outputs[0]] = value;
}

void SiteModel::set_ramp(int site, size_t row, double ramp) {
  SiteSignal& signal = signals_[size_t(site)];
  signal.ramp = ramp, signal.begin = record_.time[row], signal.length = record_.step(row);
  leave_idle_sites_out();
  hold(site, signal.held);
}

void SiteModel::suppose_between_rows(size_t input, BetweenRows between) {
  record_.inputs[input].between_rows = between, ++suppositions_;
  draw_all_lines();
}

void SiteModel::suppose_input(size_t input, std::vector<double> values) {
  record_.inputs[input].value = std::move(values), ++suppositions_;
  draw_all_lines();
}

void SiteModel::draw_all_lines() {
  for (size_t i = 0; i < lines_.size(); ++i) lines_[i] = lines_of(record_, record_.inputs[i]);
}

SiteModel::OwnRun& SiteModel::run_of(size_t row) {
  OwnRun& own = runs_[runs_.size() > 1 ? record_.of_record[row] : 0];
  if (std::exchange(is_read_, &own) != &own)
    for (SiteSignal& signal : signals_) signal.numbers = own.numbers;
  return own;
}

std::vector<double> SiteModel::initial_states(size_t row) {
  const OwnRun& own = run_of(row);
  own.run->reset({own.plan->seed, 0});
  for (SiteSignal& signal : signals_) signal.memory = 0;
  return {own.run->states().begin(), own.run->states().end()};
}

SiteModel::OwnRun& SiteModel::driven_at(size_t row) {
  OwnRun& own = run_of(row);
  for (SiteSignal& signal : signals_) signal.since = record_.time[row];
  for (size_t i = 0; i < own.inputs.size(); ++i) {
    const InputLine& line = lines_[i][row];
    const Input& input = own.inputs[i];
    *input.value = line.value, *input.slope = line.slope, *input.since = record_.time[row];
  }
  return own;
}

void SiteModel::keep_modes(size_t row, char* to) {
  for (const std::span<char> mode : run_of(row).modes) to = std::ranges::copy(mode, to).out;
  for (const SiteSignal& signal : signals_)
    std::memcpy(std::exchange(to, to + sizeof signal.memory), &signal.memory, sizeof signal.memory);
}

void SiteModel::put_modes_back(size_t row, const char* from) {
  for (const std::span<char> mode : run_of(row).modes)
    std::copy_n(from, mode.size(), mode.data()), from += mode.size();
  for (SiteSignal& signal : signals_)
    std::memcpy(&signal.memory, std::exchange(from, from + sizeof signal.memory), sizeof signal.memory);
}

double SiteModel::longest_step(double length, int stage) {
  double longest = length;
  for (auto& [front, site, term] : fronts_) {
    const SiteSignal& signal = signals_[site];
    const double now = signal.terms[term].second.at(signal.numbers);
    if (stage == 0) front.begins(now);
    if (stage == 1) front.goes(now, length);
    if (stage == 2) front.bends(now, length);
    if (stage == 1 || stage == 2) longest = std::min(longest, front.longest_step());
  }
  return longest;
}

double SiteModel::step(Run<double>& run, double t, double most, bool ends_at_fronts, double* states) {
  constexpr double notably_shorter = 0.999;
  const size_t n = size_t(plan_->states);
  work_.add(4, Work::of_a_block * double(plan_->blocks.size()));
  const bool begins_well = run.derivatives_at(t, states, slope_[0].data());
  for (SiteSignal& signal : signals_) signal.go_on(t);
  longest_step(most, 0);
  bool good = begins_well;
  double h = most;
  for (int k = 1; k < 4; ++k) {
    const double part = k == 3 ? h : 0.5 * h;
    for (size_t i = 0; i < n; ++i) stage_[i] = states[i] + part * slope_[k - 1][i];
    good &= run.derivatives_at(t + part, stage_.data(), slope_[k].data());
    if (const double shorter = longest_step(h, k); ends_at_fronts && shorter < notably_shorter * h) {
      h = shorter, k = 0, good = begins_well;
      continue;
    }
    if (k == 2)  // in the middle of the step
      for (SiteSignal& signal : signals_) signal.go_on(t + part);
  }
  for (SiteSignal& signal : signals_) signal.go_on(t + h);
  for (size_t i = 0; i < n; ++i)
    states[i] += h / 6 * (slope_[0][i] + 2 * (slope_[1][i] + slope_[2][i]) + slope_[3][i]);
  return good && !run.failed() ? h : 0;
}

void SiteModel::linearize_step(Run<double>& run, double t, double length, const double* begin,
                               FlowSlopes& slopes) {
  const size_t n = size_t(plan_->states);
  const double middle = t + 0.5 * length;
  const double* const slope = slope_[2].data();  // at the second state in the middle
  for (size_t i = 0; i < n; ++i) stage_[i] = begin[i] + 0.5 * length * slope_[1][i];
  const auto difference = [&](double change, auto to) {
    work_.add(1, Work::of_a_block * double(plan_->blocks.size()));
    if (!run.derivatives_at(middle, stage_.data(), changed_.data())) slopes.give_up();
    for (size_t i = 0; i < n; ++i) to[Eigen::Index(i)] = (changed_[i] - slope[i]) / change;
  };
  for (size_t i = 0; i < n; ++i) {
    const double before = stage_[i];
    stage_[i] += slopes.changes_of_states()[i];
    difference(slopes.changes_of_states()[i], slopes.by_state(i));
    stage_[i] = before;
  }
  for (size_t s = 0; s < slopes.sites().size(); ++s) {
    const int site = slopes.sites()[s];
    const double before = held(site);
    hold(site, before + slopes.change_at_site(s));
    difference(slopes.change_at_site(s), slopes.by_site(s));
    hold(site, before);
  }
  if (!slopes.is_known()) run.restored(run.now());
}

bool SiteModel::flow(size_t row, const double* from, double* to, double* middle, FlowSlopes* slopes) {
  constexpr double nothing_left = 1e-9;
  Run<double>& run = *driven_at(row).run;
  const size_t n = size_t(plan_->states);
  const double begin = record_.time[row], whole = record_.step(row), h = whole / substeps_;
  std::copy_n(from, n, to);
  if (slopes) slopes->begin();
  if (slopes && has_memory_) slopes->give_up();
  int parts = 0;
  for (int step = 0; step < substeps_; ++step) {
    const double t = begin + step * h;
    if (has_decisions_) {
      run.look_at(t, to);
      run.evaluate(0, false);
      if (slopes && !std::equal(to, to + n, run.states().data())) slopes->give_up();
      std::ranges::copy(run.states(), to);  // it may have jumped
      run.reuse_signals();
    }
    for (double done = 0; h - done > nothing_left * h;) {
      std::copy_n(to, n, begin_.data());
      const double length = this->step(run, t + done, h - done, parts < criteria::most_parts_of_fronts, to);
      if (length == 0) {
        run.restored(run.now());
        return false;
      }
      if (slopes && (done > 0 || length < h || parts > 0)) slopes->give_up();  // a front is on its way
      if (slopes && slopes->is_known()) {
        linearize_step(run, t + done, length, begin_.data(), *slopes);
        slopes->add_step(length, (step * h + done) / whole, (step * h + done + length) / whole);
      }
      done += length, parts += done < h;
    }
    if (middle && 2 * (step + 1) == substeps_) std::copy_n(to, n, middle);
  }
  return std::ranges::all_of(std::span(to, n), [](double x) { return std::isfinite(x); });
}

bool SiteModel::look(size_t row, double time, const double* states, double* numbers) {
  const OwnRun& own = driven_at(row);
  Run<double>& run = *own.run;
  run.look_at(time, states);
  run.evaluate(0, true);
  if (time == record_.time[row])
    for (SiteSignal& signal : signals_) signal.go_on(time);
  const bool good = !run.failed();
  if (!good) run.restored(run.now());
  std::copy_n(own.numbers, this->numbers(), numbers);
  return good;
}

bool SiteModel::outputs(size_t row, const double* states, double* to) {
  bool good = true;
  if (all_are_states_) {
    for (size_t j = 0; j < outputs_.size(); ++j) to[j] = states[outputs_[j] - plan_->signals];
  } else {
    const OwnRun& own = driven_at(row);
    Run<double>& run = *own.run;
    work_.add(1, Work::of_a_block * double(plan_->blocks.size()));
    run.look_at(record_.time[row], states);
    run.evaluate(0, true);
    good = !run.failed();
    if (!good) run.restored(run.now());
    for (size_t j = 0; j < outputs_.size(); ++j) to[j] = own.numbers[outputs_[j]];
  }
  for (size_t j = 0; j < outputs_.size(); ++j) {
    const double true_value = to[j];
    for (const auto& [term, variable] : signals_[sensor_sites_[j]].terms) to[j] += term.value(true_value);
  }
  return good;
}

}  // namespace loopwright::diagnosis
