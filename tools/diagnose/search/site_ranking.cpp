#include "tools/diagnose/search/site_ranking.h"
#include <algorithm>
#include <cmath>
#include <utility>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/state_behind.h"
#include "tools/diagnose/search/term_responses.h"

namespace loopwright::diagnosis {
namespace {

using criteria::least_energy, criteria::least_gain_of_second, criteria::share_of_held, criteria::of_far;
using criteria::of_derived, criteria::of_difference, criteria::of_indirect_sum, criteria::of_sensor;

/// First values of a shape, as of a pitch, of which more are compared coarsely before the best one is judged.
constexpr size_t most_starts = 30;

/// Far from its site a variable enters by plain laws only, and so does a recorded input or the output of a
/// filter into its own distortion: others would resemble saturation and dead zone.
bool is_plain(const TermShape& shape) {
  return shape.name == "linear" || shape.name == "signed_square" || shape.name == "square" ||
         shape.name == "cube";
}

class Ranking {
 public:
  Ranking(SiteFitter& fitter, SiteHypothesis hypothesis, bool with_constants)
      : fitter_(fitter),
        at_(std::move(hypothesis)),
        responses_(fitter, at_),
        with_constants_(with_constants) {
    if (responses_.is_good()) find_multiples();
  }

  std::vector<SiteCandidate> run(std::span<const TermShape> shapes) {
    if (!responses_.is_good()) return {};
    const SiteModel& model = fitter_.model();
    constants_.resize(model.sites().size());
    Lists lists(model.sites().size());
    std::vector<int> acting;
    for (int site = 0; site < int(model.sites().size()); ++site)
      if (model.sites()[size_t(site)].is_searched && acts(site)) acting.push_back(site);
    const auto those_that = [&](auto&& wanted) {
      std::vector<int> sites;
      std::ranges::copy_if(acting, std::back_inserter(sites), wanted);
      return sites;
    };
    for (const TermShape& shape : shapes) {
      if (shape.of == TermShape::Of::nothing)
        rank(shape, those_that([&](int s) { return !is_distorted(s) || is_sensor(s); }), -1, lists);
      else if (shape.of == TermShape::Of::own)
        for (int site : acting) try_distortion(shape, site, lists[size_t(site)]);
      else if (shape.of == TermShape::Of::past)
        for (int site : those_that([&](int s) { return model.input_of(s) >= 0; }))
          try_past(shape, site, lists[size_t(site)]);
      else
        for (int v = 0; v < int(model.variables().size()); ++v)
          rank(shape, those_that([&](int s) { return is_admissible(shape, s, v); }), v, lists);
    }
    std::vector<SiteCandidate> list;
    for (const auto& own : lists) std::ranges::copy(own, std::back_inserter(list));
    std::ranges::sort(list, std::greater{}, [](const SiteCandidate& c) { return c.gain - 2 * c.cost; });
    return list;
  }

  std::vector<SiteCandidate> run_at(std::span<const TermShape> shapes, int site, int variable) {
    if (!responses_.is_good()) return {};
    constants_.resize(fitter_.model().sites().size());
    Lists lists(constants_.size());
    for (const TermShape& shape : shapes) rank(shape, {site}, variable, lists);
    return lists[size_t(site)];
  }

 private:
  using Lists = std::vector<std::vector<SiteCandidate>>;  // of the sites
  struct Constant {
    SiteTerm term;
    Eigen::MatrixXd column;
    double gain = 0;  ///< 0: none is admissible there
  };

  /// An output that is only a multiple of a state, as of a Gain, is no variable of its own.
  void find_multiples() {
    const std::vector<SiteVariable>& variables = fitter_.model().variables();
    is_multiple_.assign(variables.size(), false);
    std::vector<Eigen::VectorXd> directions;
    for (const bool states : {true, false})
      for (size_t v = 0; v < variables.size(); ++v) {
        if (variables[v].is_state != states) continue;
        const std::vector<double> values = responses_.signal(int(v));
        const Eigen::Map<const Eigen::VectorXd> along(values.data(), Eigen::Index(values.size()));
        const double size = along.norm();
        is_multiple_[v] = !(size > 0) || std::ranges::any_of(directions, [&](const auto& known) {
          return (along / size - known * known.dot(along / size)).norm() < 1e-6;
        });
        if (!is_multiple_[v]) directions.push_back(along / size);
      }
    state_behind_ = states_behind(fitter_.model(), responses_.pass());
  }
  bool acts(int site) const {
    if (is_sensor(site)) return true;
    for (size_t k = 0; k < responses_.pass().rows; ++k)
      for (size_t i = 0; i < responses_.pass().states; ++i)
        if (responses_.pass()
                .G[(k * responses_.pass().sites + size_t(site)) * responses_.pass().states + i] != 0)
          return true;
    return false;
  }
  /// A recorded input or the output of a filter: a term there depends on the signal itself. Others act at a
  /// Sum behind it.
  bool is_distorted(int site) const {
    const Site::Kind kind = fitter_.model().sites()[size_t(site)].kind;
    return kind == Site::Kind::input || kind == Site::Kind::block || kind == Site::Kind::sensor;
  }
  bool is_sensor(int site) const { return fitter_.model().sites()[size_t(site)].kind == Site::Kind::sensor; }
  /// A function without a name contains all laws of its signal, and constants. A second law of dry friction
  /// would only mend how the first one turns around rest, and a site has one memory.
  bool is_there(const TermShape& shape, int site, int variable) const {
    return std::ranges::any_of(at_.terms, [&](const SiteTerm& t) {
      if (t.site != site) return false;
      if (t.shape->remembered && shape.remembered) return true;
      const bool is_in_function = shape.of == TermShape::Of::nothing || t.variable == variable;
      if (is_unknown_function(*t.shape) && is_in_function) return true;
      if (t.variable != variable) return false;
      const bool is_same = t.shape == &shape || (is_dry_friction(*t.shape) && is_dry_friction(shape));
      return is_same && shape.name != "periodic";
    });
  }
  bool is_admissible(const TermShape& shape, int site, int variable) const {
    const SiteModel& model = fitter_.model();
    const Nearness nearness = model.nearness(site, variable);
    if (nearness == Nearness::unusable) return false;
    if (is_distorted(site) ? variable != model.own_variable(site) || !is_plain(shape)
                           : is_multiple_[size_t(variable)])
      return false;
    if (nearness == Nearness::far && !is_plain(shape)) return false;
    // A level of a function of a state is a level of the state.
    if (shape.nonlinear[0] == "level" && state_behind_[size_t(variable)] != variable) return false;
    return shape.fits(model.sites()[size_t(site)].quantity, model.variables()[size_t(variable)].quantity);
  }
  /// At any site.
  SiteTerm term_of(const TermShape& shape, int variable, const std::vector<double>& values,
                   const std::array<double, most_nonlinear>& start) const {
    SiteTerm term;
    term.shape = &shape, term.variable = variable, term.nonlinear = start;
    const auto [low, high] = std::ranges::minmax(values);
    const double largest = std::max(std::abs(low), std::abs(high));
    const bool is_level = shape.nonlinear[0] == "level" || is_unknown_function(shape);
    for (size_t p = 0; p < most_nonlinear; ++p) {
      term.low[p] = is_level ? low : 1e-4 * std::min(largest, high - low);
      term.high[p] = is_level ? high : 3 * std::max(largest, high - low);
    }
    if (shape.ranges) {
      const TermShape::Ranges ranges = shape.ranges(values);
      term.low = ranges.low, term.high = ranges.high;
    }
    if (shape.remembered)  // from samples to seconds
      for (auto* list : {&term.nonlinear, &term.low, &term.high})
        for (double& number : *list) number *= fitter_.model().record().sample_time;
    return term;
  }
  struct Best {
    SiteCandidate one, pair;
  };
  void rank(const TermShape& shape, std::vector<int> sites, int variable, Lists& lists) {
    std::erase_if(sites, [&](int site) { return is_there(shape, site, variable); });
    if (sites.empty()) return;
    const std::vector<double> values = responses_.signal(variable);
    std::vector<std::array<double, most_nonlinear>> starts{{}};
    if (shape.starts) starts = shape.starts(values);
    if (shape.starts) std::erase_if(starts, [](const auto& start) { return start[0] == 0 && start[1] == 0; });
    // They are compared by the middle of each sample first.
    const bool are_many = starts.size() > most_starts;
    std::vector<Best> best(sites.size());
    for (const auto& start : starts) {
      const SiteTerm term = term_of(shape, variable, values, start);
      responses_.evaluate(term, are_many);
      for (size_t s = 0; s < sites.size(); ++s) rank_at(sites[s], term, best[s]);
    }
    for (size_t s = 0; are_many && s < sites.size(); ++s) {
      if (best[s].one.gain <= 0) continue;
      const SiteTerm term = std::exchange(best[s], {}).one.term;
      responses_.evaluate(term, false);
      rank_at(sites[s], term, best[s]);
    }
    for (size_t s = 0; s < sites.size(); ++s)
      for (SiteCandidate* candidate : {&best[s].one, &best[s].pair}) {
        if (candidate->gain <= 0) continue;
        candidate->cost = cost_of(fitter_.model(), candidate->term);
        if (candidate->constant) candidate->cost += cost_of(fitter_.model(), *candidate->constant);
        lists[size_t(sites[s])].push_back(*candidate);
      }
  }
  /// An evaluated term.
  void rank_at(int site, SiteTerm term, Best& best) {
    Eigen::MatrixXd columns = responses_.responses(term, site);
    if (!columns.allFinite()) return;
    const Eigen::VectorXd energy = columns.colwise().squaredNorm().transpose();
    responses_.leave_out_free(columns);
    for (Eigen::Index c = 0; c < columns.cols(); ++c)
      if (!(columns.col(c).squaredNorm() > least_energy * energy[c])) columns.col(c).setZero();
    const double gain = responses_.explain(columns, term);
    if (gain > best.one.gain) best.one.gain = gain, best.one.term = term;
    Constant& constant = constants_[size_t(site)];
    if (term.shape->of == TermShape::Of::nothing)
      constant = {term, columns, gain};
    else if (with_constants_ && constant.gain > 0 && goes_with_constant(*term.shape))
      pair(columns, term, constant, std::max(gain, constant.gain), best.pair);
  }
  static bool goes_with_constant(const TermShape& shape) {
    return is_plain(shape) || shape.name == "absolute" || shape.name == "sign";
  }
  /// The term together with a constant, if both gain clearly more than the better of them.
  void pair(const Eigen::MatrixXd& column, const SiteTerm& term, const Constant& constant, double gain_of_one,
            SiteCandidate& best) const {
    Eigen::MatrixXd both(column.rows(), 2);
    both << column, constant.column;
    SiteTerm joint = term;
    const double gain = responses_.explain(both, joint);
    if (gain < gain_of_one + least_gain_of_second || gain <= best.gain) return;
    best.gain = gain, best.constant = constant.term, best.term = joint;
    best.constant->coefficient[0] = joint.coefficient[1];
    best.term.coefficient[1] = 0;
  }
  /// A distortion of what is measured moves no state, so that its response is nearly linear.
  bool is_promising(const TermShape& shape, int site, int own, const std::vector<double>& values) {
    double most = 0;
    for (const auto& start : shape.starts(values)) {
      if (start[0] == 0) continue;
      SiteTerm term = term_of(shape, own, values, start);
      responses_.evaluate(term, false);
      Eigen::MatrixXd column = responses_.responses(term, site);
      responses_.leave_out_free(column);
      most = std::max(most, responses_.explain(column, term));
    }
    return most > least_gain_of_second;
  }
  /// A strong distortion is far from linear: every first value is judged by a pass of the model.
  void try_distortion(const TermShape& shape, int site, std::vector<SiteCandidate>& list) {
    const int own = fitter_.model().own_variable(site);
    if (own < 0 || is_there(shape, site, own)) return;
    if (fitter_.model().nearness(site, own) == Nearness::unusable) return;
    const std::vector<double> values = responses_.signal(own);
    if (is_sensor(site) && !is_promising(shape, site, own, values)) return;
    SiteCandidate best;
    for (const auto& start : shape.starts(values)) {
      if (start[0] == 0) continue;
      SiteHypothesis trial = at_;
      trial.terms.push_back(term_of(shape, own, values, start));
      trial.terms.back().site = site, trial.terms.back().coefficient[0] = 1;
      const double gain =
          responses_.pass().scaled_objective() - fitter_.scaled_objective_beside(trial, responses_.pass());
      if (gain > best.gain) best.gain = gain, best.term = trial.terms.back();
    }
    if (best.gain <= 0) return;
    best.cost = cost_of(fitter_.model(), best.term);
    list.push_back(best);
  }

  /// An input that is held from row to row in the place of a curve acts half a sample later. That is a
  /// statement of the experiment, which is questioned as such.
  double gain_of_held(int site) {
    const SignalRecord& record = fitter_.model().record();
    RecordedInput input = record.inputs[size_t(fitter_.model().input_of(site))];
    if (input.between_rows == BetweenRows::hold) return 0;
    const InputLines lines = lines_of(record, input);
    input.between_rows = BetweenRows::hold;
    SiteTerm ignored;
    return responses_.explain(responses_.response_of_input(site, difference(lines_of(record, input), lines)),
                              ignored);
  }
  /// What a delay or a lag adds to an input is known from the record alone, so that the first values are
  /// judged by the response to it. As one adds in proportion to a short time, the share of the change that
  /// fits best corrects the time.
  void try_past(const TermShape& shape, int site, std::vector<SiteCandidate>& list) {
    constexpr double longest = 200, shortest = 0.05;  // [samples]
    constexpr double least_share = 0.3, most_share = 3;
    if (is_there(shape, site, -1)) return;
    const SignalRecord& record = fitter_.model().record();
    const double sample = record.sample_time;
    const std::vector<double>& input = record.inputs[size_t(fitter_.model().input_of(site))].value;
    const auto [least, most] = std::ranges::minmax(input);
    SiteCandidate best;
    for (const auto& [samples, before] : shape.starts(std::span(input).first(1))) {
      SiteTerm term;
      term.shape = &shape, term.site = site, term.nonlinear = {samples * sample, before};
      term.low = {shortest * sample, std::min(least, 0.0)},
      term.high = {longest * sample, std::max(most, 0.0)};
      const double gain =
          responses_.explain(responses_.response_of_input(site, fitter_.model().change_of_input(term)), term);
      const double share = term.coefficient[0];
      if (share < least_share || share > most_share || gain <= best.gain) continue;
      term.nonlinear[0] *= share, term.coefficient[0] = 1;
      best.gain = gain, best.term = term;
    }
    if (best.gain <= 0 || gain_of_held(site) > share_of_held * best.gain) return;
    SiteHypothesis trial = at_;
    trial.terms.push_back(best.term);
    SitePass there;
    if (!fitter_.pass(trial, false, there)) return;
    best.gain = responses_.pass().scaled_objective() - there.scaled_objective();
    best.cost = cost_of(fitter_.model(), best.term);
    if (best.gain > 0) list.push_back(best);
  }

  SiteFitter& fitter_;
  SiteHypothesis at_;
  TermResponses responses_;
  const bool with_constants_;
  std::vector<Constant> constants_;  // of the sites
  std::vector<bool> is_multiple_;
  std::vector<int> state_behind_;  // of each variable
};

}  // namespace

double cost_of(const SiteModel& model, const SiteTerm& term) {
  double cost = term.shape->cost;
  const Site& site = model.sites()[size_t(term.site)];
  if (site.kind == Site::Kind::sum && !model.drives_state(term.site)) cost += of_indirect_sum;
  if (site.kind == Site::Kind::sensor) cost += of_sensor;
  if (term.variable < 0 || term.variable == model.own_variable(term.site)) return cost;
  const SiteVariable& variable = model.variables()[size_t(term.variable)];
  if (model.nearness(term.site, term.variable) == Nearness::far) cost += of_far;
  if (!variable.is_state) cost += of_derived;
  if (variable.minus >= 0) cost += of_difference;
  return cost;
}

std::vector<SiteCandidate> rank_terms(SiteFitter& fitter, SiteHypothesis hypothesis,
                                      std::span<const TermShape> shapes, bool with_constants) {
  return Ranking(fitter, std::move(hypothesis), with_constants).run(shapes);
}

std::vector<SiteCandidate> rank_terms_at(SiteFitter& fitter, SiteHypothesis hypothesis,
                                         std::span<const TermShape> shapes, int site, int variable) {
  return Ranking(fitter, std::move(hypothesis), false).run_at(shapes, site, variable);
}

}  // namespace loopwright::diagnosis
