#include "tools/diagnose/verdict/site_plots.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/search/site_whiteness.h"
#include "tools/diagnose/verdict/site_units.h"

namespace loopwright::diagnosis {
namespace {

constexpr double usual_nodes = 25, nodes_a_period = 8, most_nodes = 120;
constexpr size_t points_of_shape = 400;
/// [largest value of the term] Standard deviation of a node that is still drawn.
constexpr double most_deviation = 0.3;
/// [of the strongest] Response of a node that the record tells at all.
constexpr double least_response = 1e-3;

/// With the noise of the answer, so that both are judged alike.
void add_whiteness(SiteFitter& fitter, SiteHypothesis nominal, SiteHypothesis found, Diagnosis& result) {
  SitePass before, after;
  nominal.noise = found.noise;
  if (!fitter.pass(nominal, false, before) || !fitter.pass(found, false, after)) return;
  const SignalRecord& record = fitter.model().record();
  size_t worst = 0;
  for (size_t j = 1; j < after.outputs; ++j)
    if (portmanteau_of(after, j, after.rows) > portmanteau_of(after, worst, after.rows)) worst = j;
  result.whiteness.port = record.outputs[worst].port;
  result.whiteness.before = correlations_of(before, worst, before.rows);
  result.whiteness.after = correlations_of(after, worst, after.rows);
  double readings = 0;
  for (size_t row = 0; row < after.rows; ++row)
    readings += std::isfinite(after.error[row * after.outputs + worst]);
  for (size_t lag = 1; lag <= result.whiteness.after.size(); ++lag)
    result.whiteness.lag_s.push_back(double(lag) * record.sample_time * double(after.rows) / readings);
  result.whiteness.most = 1.96 / std::sqrt(readings);
}

/// Nodes at even distances over the range of a variable.
struct Nodes {
  double low = 0, distance = 1;
  Eigen::Index count = 2;

  double at(Eigen::Index node) const { return low + double(node) * distance; }
  /// 1 at the node, 0 at its neighbors.
  double hat(Eigen::Index node, double v) const {
    return std::max(0.0, 1 - std::abs(v - at(node)) / distance);
  }
};

class TermPlot {
 public:
  TermPlot(SiteFitter& fitter, const SitePass& pass, const SiteTerm& term)
      : fitter_(fitter), pass_(pass), term_(term) {
    const SiteVariable& variable = fitter.model().variables()[size_t(term.variable)];
    for (size_t k = 0; k < 3; ++k)
      for (size_t row = 0; row < pass.rows; ++row)
        signal_[k].push_back(variable.at(&pass.path[k][row * pass.numbers]));
    const auto [low, high] = std::ranges::minmax(signal_[0]);
    double count = usual_nodes;
    if (term.shape->name == "periodic")
      count = std::clamp(nodes_a_period * (high - low) / term.nonlinear[0], usual_nodes, most_nodes);
    nodes_.low = low, nodes_.count = Eigen::Index(count);
    nodes_.distance = (high - low) / double(nodes_.count - 1);
  }

  bool is_drawn() const { return nodes_.distance > 0; }
  void add_to(MissingTerm& plot) const {
    const double low = nodes_.at(0), high = nodes_.at(nodes_.count - 1);
    for (size_t i = 0; i < points_of_shape; ++i) {
      plot.shape_at.push_back(low + (high - low) * double(i) / double(points_of_shape - 1));
      plot.shape.push_back(term_.value(plot.shape_at.back()));
    }
    double largest = 0;
    for (double value : plot.shape) largest = std::max(largest, std::abs(value));
    add_nodes(plot, most_deviation * largest);
  }

 private:
  /// Of the whitened errors to each node.
  Eigen::MatrixXd responses() const {
    Eigen::MatrixXd H(Eigen::Index(pass_.error.size()), nodes_.count);
    std::vector<double> hat[3], column(pass_.error.size());
    for (auto& list : hat) list.resize(pass_.rows);
    for (Eigen::Index node = 0; node < nodes_.count; ++node) {
      for (size_t k = 0; k < 3; ++k)
        for (size_t row = 0; row < pass_.rows; ++row) hat[k][row] = nodes_.hat(node, signal_[k][row]);
      fitter_.filter().respond(pass_, term_.site, hat[0], hat[1], hat[2], column);
      H.col(node) = Eigen::Map<const Eigen::VectorXd>(column.data(), Eigen::Index(column.size()));
    }
    return H;
  }
  /// The named shape and what the errors add to it.
  void add_nodes(MissingTerm& plot, double most) const {
    const Eigen::MatrixXd H = responses();
    const double strongest = H.colwise().norm().maxCoeff();
    std::vector<Eigen::Index> seen;
    for (Eigen::Index node = 0; node < nodes_.count; ++node)
      if (H.col(node).norm() > least_response * strongest) seen.push_back(node);
    const Eigen::MatrixXd columns = H(Eigen::all, seen);
    const Eigen::MatrixXd inverse =
        (columns.transpose() * columns).completeOrthogonalDecomposition().pseudoInverse();
    const Eigen::VectorXd more = inverse * (columns.transpose() * fitter_.whitened(pass_));
    const double scale = std::sqrt(pass_.squares / double(pass_.readings));
    for (size_t i = 0; i < seen.size(); ++i) {
      const auto at = Eigen::Index(i);
      if (!(scale * std::sqrt(inverse(at, at)) < most)) continue;
      plot.at.push_back(nodes_.at(seen[i]));
      plot.found.push_back(term_.value(plot.at.back()) + more[at]);
    }
  }

  SiteFitter& fitter_;
  const SitePass& pass_;
  const SiteTerm& term_;
  std::vector<double> signal_[3];  // at the start, middle and end of each sample
  Nodes nodes_;
};

}  // namespace

void add_site_plots(SiteFitter& fitter, const SiteHypothesis& nominal, const SiteHypothesis& found,
                    Diagnosis& result) {
  add_whiteness(fitter, nominal, found, result);
  SitePass pass;
  SiteHypothesis h = found;
  if (h.terms.empty() || !fitter.pass(h, true, pass)) return;
  const SiteModel& model = fitter.model();
  for (const SiteTerm& term : h.terms) {
    if (term.variable < 0 || term.shape->remembered) continue;  // no function of a signal
    const TermPlot drawn(fitter, pass, term);
    if (!drawn.is_drawn()) continue;
    const SiteVariable& variable = model.variables()[size_t(term.variable)];
    const Site& site = model.sites()[size_t(term.site)];
    MissingTerm& plot = result.terms.emplace_back();
    plot.effect = is_unknown_function(*term.shape) ? "function without a name" : term.shape->name;
    plot.site = site.name, plot.site_unit = unit_text(site.unit);
    plot.variable = variable.name, plot.unit = unit_text(variable.unit);
    drawn.add_to(plot);
  }
}

}  // namespace loopwright::diagnosis
