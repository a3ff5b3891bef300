#include "tools/design/design.h"
#include <fmt/format.h>
#include <algorithm>
#include <set>
#include "tools/design/weights.h"
#include "tools/linearize/analysis.h"

namespace loopwright {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

bool is_element_of(std::string_view name, std::string_view whole) {
  if (!name.starts_with(whole)) return false;
  return name.size() == whole.size() || name[whole.size()] == '[' || name[whole.size()] == '.';
}

std::optional<Unit> known_unit(const Plan& plan, const std::string& port) {
  const std::vector<Number> numbers = plan.find(port);
  return numbers.size() == 1 ? plan.unit_of(numbers[0]) : std::nullopt;
}

std::vector<DesignSignal> signals(const std::vector<std::string>& names,
                                  const std::vector<std::string>& units) {
  std::vector<DesignSignal> result;
  for (size_t i = 0; i < names.size(); ++i)
    result.push_back({names[i], units[i].empty() ? std::nullopt : parse_unit(units[i])});
  return result;
}

/// Collects weights and modes, and computes the gains.
class Designer {
 public:
  Designer(const Plan& plan, const DesignRequest& request, const RunOptions& options)
      : plan_(plan),
        request_(request),
        is_filter_(request.kind == DesignKind::filter),
        diagram_(request.at ? linearize_at(plan, *request.at, options) : linearize_at_start(plan)) {}

  Design compute() {
    read_numbers();
    end_if_wrong();
    find_system();
    end_if_wrong();
    find_kept();
    end_if_wrong();
    find_cost();
    end_if_wrong();
    reduce();
    end_if_wrong();
    solve();
    return std::move(result_);
  }

 private:
  Problem& error(const std::string& message) { return problems_.error({}, "", "", message); }
  void end_if_wrong() {
    if (problems_.has_errors()) throw InputError(std::move(problems_));
  }

  void read_numbers() {
    if (!is_filter_ && request_.from.empty())
      error("a state feedback needs the ports that it drives").hint = "--from PORT";
    if (is_filter_ && request_.to.empty())
      error("a filter needs the ports that are measured").hint = "--to PORT";
    if (request_.continuous && request_.sample_time > 0 && request_.keeps_loops && has_samples(diagram_))
      error("--continuous leaves the sampled loops out: --keep-loops contradicts it");
    Q_ = named_numbers(request_.Q, "--Q", problems_);
    R_ = named_numbers(request_.R, "--R", problems_);
    sizes_ = named_numbers(request_.sizes, is_filter_ ? "--deviation" : "--allow", problems_);
  }

  LinearSystem system_between(const Access& access) {
    if (!request_.continuous && (has_samples(diagram_) || request_.sample_time > 0)) {
      const SampledSystem sampled = sampled_system(diagram_, access, request_.sample_time);
      if (sampled.lifted > 1)
        error(fmt::format("the diagram has several rates: {} samples make one period", sampled.lifted)).hint =
            "design for its continuous part, --continuous --sample-time T, or for a diagram of the plant "
            "alone";
      return sampled;
    }
    LinearSystem system = continuous_part(diagram_, access);
    if (!system.matrices.delays.empty()) {
      error("a transport delay has no states in continuous time").hint =
          "--sample-time T: between samples it has";
      return system;
    }
    if (request_.sample_time > 0)
      system.matrices = hold_discretization(system.matrices, request_.sample_time);
    return system;
  }

  /// Names that weights may have beside ports: states.
  bool is_state(const std::string& name) const {
    return std::ranges::any_of(system_.states, [&](const std::string& s) { return is_element_of(s, name); });
  }
  bool is_command(const std::string& name) const {
    return std::ranges::any_of(request_.from, [&](const std::string& f) { return is_element_of(name, f); });
  }

  /// Commands or known inputs come first, then ports at which noise enters; measured ports come first, then
  /// ports that only have a weight.
  void find_system() {
    Access access{request_.from, request_.to, {}};
    if (!request_.keeps_loops) access.open = request_.from;
    system_ = system_between(access);
    inputs_ = Index(system_.inputs.size()), outputs_ = Index(system_.outputs.size());
    for (const auto* list : {&Q_, &sizes_})
      for (const NamedNumber& named : *list) {
        if (is_state(named.name)) continue;
        const bool is_own = is_filter_ ? is_measured(named.name) && list == &sizes_
                                       : is_command(named.name) && list == &sizes_;
        if (is_own) continue;
        (is_filter_ ? access.from : access.to).push_back(named.name);
      }
    if (!problems_.has_errors()) system_ = system_between(access);
  }
  bool is_measured(const std::string& name) const {
    return std::ranges::any_of(request_.to, [&](const std::string& t) { return is_element_of(name, t); });
  }

  /// All states but those named by --without, which must not act on the others.
  void find_kept() {
    const StateSpace& s = system_.matrices;
    for (const std::string& name : request_.without)
      if (!is_state(name)) {
        KnownNames names(system_.states);
        names.explain(error(fmt::format("--without: there is no state \"{}\"", name)), name);
      }
    for (Index i = 0; i < s.states(); ++i) {
      const bool is_out = std::ranges::any_of(request_.without, [&](const std::string& name) {
        return is_element_of(system_.states[size_t(i)], name);
      });
      (is_out ? removed_ : kept_).push_back(i);
    }
    for (const Index out : removed_)
      for (const Index in : kept_)
        if (s.A(in, out) != 0) {
          error(fmt::format("--without: \"{}\" acts on \"{}\", which stays", system_.states[size_t(out)],
                            system_.states[size_t(in)]))
              .hint = "cut the loop at the port in between, or leave both out";
          return;
        }
    if (kept_.empty()) error("the diagram has no states");
  }

  std::optional<Unit> state_unit(Index i) const { return known_unit(plan_, system_.states[size_t(i)]); }

  /// A block names all its states.
  void weigh_states(const NamedNumber& named, bool is_size) {
    for (Index i = 0; i < system_.matrices.states(); ++i)
      if (is_element_of(system_.states[size_t(i)], named.name))
        cost_.Q(i, i) += weight(named, state_unit(i), is_size, /*is_rate=*/true);
  }
  /// Of a size the weight is 1/x², or the variance x².
  double weight(const NamedNumber& named, const std::optional<Unit>& unit, bool is_size, bool is_rate) {
    if (is_size) {
      const double size = number_for(named, unit, 1, 0, problems_);
      if (!is_filter_ && size == 0) error(fmt::format("--allow of \"{}\" is zero", named.name));
      return is_filter_ ? size * size : 1 / (size * size);
    }
    if (!is_filter_) return number_for(named, unit, -2, 0, problems_);
    const bool is_density = system_.matrices.sample_time == 0;
    return number_for(named, unit, 2, !is_density ? 0 : is_rate ? -1 : 1, problems_);
  }

  void find_cost() {
    const StateSpace& s = system_.matrices;
    const Index n = s.states();
    const Index own = is_filter_ ? outputs_ : inputs_;
    cost_.Q = MatrixXd::Zero(n, n), cost_.R = MatrixXd::Zero(own, own), cost_.N = MatrixXd::Zero(n, own);
    if (is_filter_ && s.sample_time == 0 && !sizes_.empty())
      error("--deviation: noise in continuous time has an intensity, not a deviation").hint =
          "--Q and --R in unit^2*s, or a --sample-time";
    const std::vector<DesignSignal> all_inputs = signals(system_.inputs, system_.input_units),
                                    all_outputs = signals(system_.outputs, system_.output_units);
    const auto& own_signals = is_filter_ ? all_outputs : all_inputs;
    for (const auto& [list, is_size] : {std::pair{&R_, false}, std::pair{&sizes_, true}})
      for (const NamedNumber& named : *list) weigh_own(named, own_signals, is_size);
    for (const auto& [list, is_size] : {std::pair{&Q_, false}, std::pair{&sizes_, true}})
      for (const NamedNumber& named : *list) {
        if (is_state(named.name)) {
          if (!(is_size && is_own_signal(named.name))) weigh_states(named, is_size);
        } else if (!(is_size && is_own_signal(named.name))) {
          weigh_port(named, is_filter_ ? all_inputs : all_outputs, is_size);
        }
      }
    for (Index i = 0; i < own; ++i)
      if (!(cost_.R(i, i) > 0))
        error(fmt::format("{} \"{}\" has no {}", is_filter_ ? "the measurement" : "the command",
                          own_signals[size_t(i)].name, is_filter_ ? "noise" : "weight"))
            .hint = fmt::format("--R {}=NUMBER, above 0", own_signals[size_t(i)].name);
    if (cost_.Q.isZero(0))
      error(is_filter_ ? "no noise acts on the states" : "no state has a weight").hint =
          "--Q NAME=NUMBER, a state or a port";
  }
  bool is_own_signal(const std::string& name) const {
    return is_filter_ ? is_measured(name) : is_command(name);
  }

  void weigh_own(const NamedNumber& named, const std::vector<DesignSignal>& own_signals, bool is_size) {
    bool is_found = false;
    for (Index i = 0; i < cost_.R.rows(); ++i)
      if (is_element_of(own_signals[size_t(i)].name, named.name)) {
        cost_.R(i, i) += weight(named, own_signals[size_t(i)].unit, is_size, false);
        is_found = true;
      }
    if (is_found || is_size) return;
    KnownNames names;
    for (Index i = 0; i < cost_.R.rows(); ++i) names.add(own_signals[size_t(i)].name);
    names.explain(error(fmt::format("--R: \"{}\" is not one of the ports of {}", named.name,
                                    is_filter_ ? "--to" : "--from")),
                  named.name);
  }

  /// A weighted port y = C x + D u adds w yᵀy. Noise at a port, x' = A x + G w and y = C x + H w, adds its
  /// covariances.
  void weigh_port(const NamedNumber& named, const std::vector<DesignSignal>& ports, bool is_size) {
    const StateSpace& s = system_.matrices;
    const Index first = is_filter_ ? inputs_ : outputs_;
    for (Index p = first; p < Index(ports.size()); ++p) {
      if (!is_element_of(ports[size_t(p)].name, named.name)) continue;
      const double w = weight(named, ports[size_t(p)].unit, is_size, false);
      const Eigen::VectorXd of_states =
          is_filter_ ? Eigen::VectorXd(s.B.col(p)) : Eigen::VectorXd(s.C.row(p));
      const Eigen::VectorXd of_own =
          is_filter_ ? Eigen::VectorXd(s.D.col(p).head(outputs_)) : Eigen::VectorXd(s.D.row(p).head(inputs_));
      if (of_states.isZero(0)) {
        error(fmt::format("{}: \"{}\" {}", named.option, named.name,
                          is_filter_ ? "drives no state" : "does not depend on any state"));
        return;
      }
      cost_.Q += w * of_states * of_states.transpose();
      cost_.N += w * of_states * of_own.transpose();
      cost_.R += w * of_own * of_own.transpose();
    }
  }

  /// What seen quantities depend on: the weighted ones, or the measured ones.
  std::vector<bool> seen_states() const {
    const StateSpace& s = system_.matrices;
    std::vector<bool> seen(size_t(s.states()), false);
    for (const Index i : kept_)
      seen[size_t(i)] = is_filter_ ? !s.C.topRows(outputs_).col(i).isZero(0)
                                   : !cost_.Q.row(i).isZero(0) || !cost_.N.row(i).isZero(0);
    for (bool grows = true; grows;) {
      grows = false;
      for (const Index i : kept_)
        for (const Index j : kept_)
          if (seen[size_t(i)] && !seen[size_t(j)] && s.A(i, j) != 0) seen[size_t(j)] = grows = true;
    }
    return seen;
  }

  void reduce() {
    const StateSpace& s = system_.matrices;
    const std::vector<bool> seen = seen_states();
    std::vector<Index> stays, goes;
    for (const Index i : kept_) (seen[size_t(i)] ? stays : goes).push_back(i);
    for (const Index out : removed_)
      if (is_filter_ ? !s.C.topRows(outputs_).col(out).isZero(0) : !cost_.Q.row(out).isZero(0)) {
        error(fmt::format("--without: \"{}\" is {}", system_.states[size_t(out)],
                          is_filter_ ? "measured" : "weighted"));
        return;
      }
    if (!goes.empty()) refuse_unstable(s.A(goes, goes), goes);
    for (const Index i : goes) result_.left_out.push_back(system_.states[size_t(i)]);
    for (const Index i : stays) result_.states.push_back({system_.states[size_t(i)], state_unit(i)});
    result_.inputs = signals(system_.inputs, system_.input_units);
    result_.inputs.resize(size_t(inputs_));
    result_.outputs = signals(system_.outputs, system_.output_units);
    result_.outputs.resize(size_t(is_filter_ ? outputs_ : 0));
    const Index outputs = Index(result_.outputs.size());
    result_.system = {s.A(stays, stays),
                      s.B.leftCols(inputs_)(stays, Eigen::all),
                      s.C.topRows(outputs)(Eigen::all, stays),
                      s.D.topLeftCorner(outputs, inputs_),
                      s.sample_time,
                      {}};
    result_.cost = {cost_.Q(stays, stays), cost_.R, cost_.N(stays, Eigen::all)};
  }

  /// A mode that nothing weighted or measured shows may be left out only if it decays by itself.
  void refuse_unstable(const MatrixXd& A, const std::vector<Index>& states) {
    std::vector<std::string> names;
    for (const Index i : states) names.push_back(system_.states[size_t(i)]);
    for (const Pole& pole :
         poles({A, MatrixXd::Zero(A.rows(), 0), {}, {}, system_.matrices.sample_time, {}})) {
      if (pole.is_stable(system_.matrices.sample_time) || pole.value.imag() < 0) continue;
      error(fmt::format("{} depends on the mode {}, which does not decay by itself",
                        is_filter_ ? "nothing measured" : "nothing weighted", at(pole, names)))
          .hint = is_filter_ ? "measure it with --to, or leave its states out with --without"
                             : "weigh it with --Q, or leave its states out with --without";
    }
  }
  std::string at(const Pole& pole, const std::vector<std::string>& states) const {
    return "at " + text_of(pole, system_.matrices.sample_time, states);
  }

  void solve() {
    result_.kind = request_.kind, result_.title = plan_.title, result_.plan = plan_.hash;
    result_.time = diagram_.time, result_.notes = diagram_.notes;
    const StateSpace problem = is_filter_ ? dual(result_.system) : result_.system;
    for (const Obstacle& obstacle : obstacles(problem, result_.cost)) tell(obstacle);
    end_if_wrong();
    if (is_filter_)
      result_.filter = filter(result_.system, result_.cost);
    else
      result_.regulator = regulator(result_.system, result_.cost);
  }
  void tell(const Obstacle& obstacle) {
    std::vector<std::string> names;
    for (const DesignSignal& state : result_.states) names.push_back(state.name);
    const std::string mode = at(obstacle.mode, names);
    switch (obstacle.kind) {
      case Obstacle::Kind::uncontrollable:
        error(is_filter_ ? fmt::format("undetectable: the measurements do not show the mode {}", mode)
                         : fmt::format("uncontrollable: the commands do not reach the mode {}", mode))
            .hint = is_filter_ ? "measure another port" : "drive another port, or leave the mode out";
        return;
      case Obstacle::Kind::free:
        error(is_filter_ ? fmt::format("no noise drives the mode {}, which does not decay by itself", mode)
                         : fmt::format("no weight sees the mode {}, which does not decay by itself", mode))
            .hint = is_filter_ ? "--Q of one of its states, or of a port that drives it"
                               : "--Q of one of its states, or of a port that shows it";
        return;
      case Obstacle::Kind::ill_conditioned:
        error(fmt::format("the Riccati equation has no accurate solution; nearest to {}: the mode {}",
                          is_filter_ ? "undetectable" : "uncontrollable", mode))
            .hint = "weights of less different size help";
    }
  }

  const Plan& plan_;
  const DesignRequest& request_;
  const bool is_filter_;
  const LinearDiagram diagram_;
  Problems problems_;
  std::vector<NamedNumber> Q_, R_, sizes_;
  LinearSystem system_;
  Index inputs_ = 0, outputs_ = 0;  ///< of `from` and `to`, without ports of weights or noise
  std::vector<Index> kept_, removed_;
  QuadraticCost cost_;
  Design result_;
};

}  // namespace

Design design(const Plan& plan, const DesignRequest& request, const RunOptions& options) {
  return Designer(plan, request, options).compute();
}

}  // namespace loopwright
