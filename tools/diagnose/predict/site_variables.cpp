/// On which signals of the diagram a term at a site may depend.
#include <algorithm>
#include <set>
#include "engine/run/run.h"
#include "tools/diagnose/predict/site_model.h"

namespace loopwright::diagnosis {
namespace {

/// Names of generated blocks contain what no block of a file may contain.
bool is_generated(const std::string& path) { return path.find("term at ") != path.npos; }

/// Place of the call that computes a number in the order of evaluation; -1: never within a step.
int order_of(const Plan& plan, Number number) {
  const auto [block, output] = plan.source_of(number);
  if (block < 0) return -1;
  const int group = plan.blocks[size_t(block)].type->info.outputs[size_t(output)].group;
  for (size_t i = 0; i < plan.order.size(); ++i) {
    const Plan::Entry& entry = plan.order[i];
    if (entry.kind == Plan::Entry::Kind::outputs && entry.block == block && entry.group == group)
      return entry.in_stages || entry.rate.kind == Rate::Kind::constant ? int(i) : -1;
  }
  return -1;
}

bool is_state(const Plan& plan, Number number) { return number >= plan.signals; }

/// Of a machine whose diagram states no units, or none for angles.
Quantity quantity_of_port(std::string_view port) {
  if (port.ends_with("position")) return Quantity::position;
  return port.ends_with("velocity") ? Quantity::velocity : Quantity::other;
}

class Neighbourhood {
 public:
  Neighbourhood(const Plan& plan, Number term) : plan_(plan) {
    for (size_t b = 0; b < plan_.blocks.size(); ++b)
      if (reads(b, term)) open_upstream(b), follow_downstream(b);
  }
  bool has(Number number) const { return near_.contains(number); }
  bool drives_state() const { return drives_state_; }

 private:
  bool reads(size_t block, Number number) const {
    for (const auto& port : plan_.blocks[block].inputs)
      if (std::ranges::find(port, number) != port.end()) return true;
    return false;
  }
  /// What the Sum adds up, and what the blocks of its terms read.
  void open_upstream(size_t sum) {
    for (const auto& port : plan_.blocks[sum].inputs)
      for (Number term : port) {
        near_.insert(term);
        const int source = plan_.source_of(term).first;
        if (source < 0) continue;
        for (const auto& behind : plan_.blocks[size_t(source)].inputs)
          near_.insert(behind.begin(), behind.end());
      }
  }
  /// The states that the Sum drives, and those that integrate these.
  void follow_downstream(size_t sum) {
    struct Behind {
      size_t block;
      bool is_direct;  // nothing but factors in between
    };
    std::vector<Behind> todo{{sum, true}};
    std::set<size_t> seen{sum};
    for (size_t i = 0; i < todo.size(); ++i)
      for (Number output : plan_.blocks[todo[i].block].outputs)
        for (size_t b = 0; b < plan_.blocks.size(); ++b) {
          if (!reads(b, output) || !seen.insert(b).second) continue;
          const bool is_direct = todo[i].is_direct;
          if (plan_.blocks[b].states == 0)
            todo.push_back({b, is_direct && plan_.blocks[b].type->info.type == "Gain"});
          else
            drives_state_ |= is_direct, add_states(b, true);
        }
  }
  void add_states(size_t block, bool with_integrals) {
    for (Number output : plan_.blocks[block].outputs) {
      if (!is_state(plan_, output)) continue;
      near_.insert(output);
      if (!with_integrals) continue;
      for (size_t b = 0; b < plan_.blocks.size(); ++b)
        if (plan_.blocks[b].states > 0 && reads(b, output)) add_states(b, false);
    }
  }

  const Plan& plan_;
  std::set<Number> near_;
  bool drives_state_ = false;
};

}  // namespace

void SiteModel::find_variables() {
  for (const Plan::Block& block : plan_->blocks) {
    if (is_generated(block.path)) continue;
    for (size_t o = 0; o < block.outputs.size(); ++o) {
      if (block.output_lengths[o] != 1) continue;
      SiteVariable variable;
      variable.number = block.outputs[o], variable.is_state = is_state(*plan_, variable.number);
      if (!variable.is_state && order_of(*plan_, variable.number) < 0) continue;
      variable.name = plan_->name_of(variable.number), variable.unit = block.output_units[o];
      variable.quantity = quantity_of(variable.unit);
      if (variable.quantity == Quantity::other)
        variable.quantity = quantity_of_port(block.type->info.outputs[o].name);
      variables_.push_back(std::move(variable));
    }
  }
  for (size_t j = 0; j < outputs_.size(); ++j) find_variable_of_sensor(j);
}

/// Of states of the same unit, once all units are known.
void SiteModel::find_differences() {
  const size_t plain = variables_.size();
  for (size_t a = 0; a < plain; ++a)
    for (size_t b = a + 1; b < plain; ++b) {
      const SiteVariable first = variables_[a], second = variables_[b];
      if (!first.is_state || !second.is_state || !first.unit || first.unit != second.unit) continue;
      variables_.push_back(
          {first.name + " - " + second.name, first.number, second.number, first.unit, first.quantity, true});
    }
}

/// What a sensor measures, unless it is a variable already.
void SiteModel::find_variable_of_sensor(size_t output) {
  const Site& site = sites_[sensor_sites_[output]];
  if (std::ranges::find(variables_, outputs_[output], &SiteVariable::number) != variables_.end()) return;
  SiteVariable variable;
  variable.name = site.own_signal, variable.number = outputs_[output], variable.unit = site.unit;
  variable.quantity = site.quantity, variable.is_of_sensor = true;
  variables_.push_back(std::move(variable));
}

void SiteModel::find_nearness() {
  nearness_.assign(sites_.size() * variables_.size(), Nearness::unusable);
  for (size_t s = 0; s < sites_.size(); ++s) {
    if (const int output = output_of_sensor(int(s)); output >= 0) {
      const auto own = std::ranges::find(variables_, outputs_[size_t(output)], &SiteVariable::number);
      own_.push_back(int(own - variables_.begin())), drives_state_.push_back(false);
      nearness_[s * variables_.size() + size_t(own_.back())] = Nearness::near;
      continue;
    }
    const Number term = plan_->find(sites_[s].term_block + ".y").front();
    const int place = order_of(*plan_, term);
    const Neighbourhood around(*plan_, term);
    drives_state_.push_back(around.drives_state());
    own_.push_back(-1);
    for (size_t v = 0; v < variables_.size(); ++v) {
      const SiteVariable& variable = variables_[v];
      if (variable.is_of_sensor) continue;
      if (!sites_[s].own_signal.empty() && variable.name == sites_[s].own_signal) own_[s] = int(v);
      if (!variable.is_state && order_of(*plan_, variable.number) > place) continue;
      const bool is_near = around.has(variable.number) && (variable.minus < 0 || around.has(variable.minus));
      nearness_[s * variables_.size() + v] = is_near ? Nearness::near : Nearness::far;
    }
  }
}

}  // namespace loopwright::diagnosis
