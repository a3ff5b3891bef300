#include "tools/diagnose/search/same_response.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

using Kind = FittedNumber::Kind;

constexpr size_t fitted_in_one_place = 2;
constexpr double most_factor = 3;  // of a first guess

class Responses {
 public:
  Responses(SiteFitter& fitter, const SiteHypothesis& at, const std::vector<bool>& seen)
      : fitter_(fitter), at_(at) {
    SiteHypothesis all = at;
    for (size_t i = 0; i < seen.size(); ++i) all.is_free[i] = at.is_free[i] || seen[i];
    numbers_ = fitted_numbers(all);
    SitePass pass;
    if (fitter.pass(all, false, pass)) J_ = fitter.jacobian(all, pass);
  }

  bool is_known() const { return J_.size() > 0 && J_.allFinite(); }

  void try_in_place_of_term(size_t term) {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(J_.rows());
    for (size_t i = 0; i < numbers_.size(); ++i)
      if (numbers_[i].kind == Kind::coefficient && numbers_[i].owner == int(term))
        change += J_.col(Eigen::Index(i)) * at_.terms[term].coefficient[size_t(numbers_[i].index)];
    try_parameters(change, without(at_, term), term);
  }
  void try_in_place_of_parameters() {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(J_.rows());
    for (size_t i = 0; i < numbers_.size(); ++i)
      if (numbers_[i].kind == Kind::factor && at_.is_free[size_t(numbers_[i].owner)])
        change += J_.col(Eigen::Index(i)) * (at_.factors[size_t(numbers_[i].owner)] - 1);
    SiteHypothesis base = at_;
    std::ranges::fill(base.factors, 1.0);
    base.is_free.assign(base.is_free.size(), false);
    try_parameters(change, base, {});
  }
  std::vector<SameResponse> take() { return std::move(list_); }

 private:
  struct Similar {
    double cosine;
    int parameter;
    double change;  // of the factor
  };

  /// The responses of what stays: other terms, and parameters that have moved in the base.
  Eigen::MatrixXd kept(const SiteHypothesis& base, std::optional<size_t> of) const {
    std::vector<Eigen::Index> list;
    for (size_t i = 0; i < numbers_.size(); ++i) {
      const bool stays = numbers_[i].kind == Kind::factor ? bool(base.is_free[size_t(numbers_[i].owner)])
                                                          : !of || numbers_[i].owner != int(*of);
      if (stays && J_.col(Eigen::Index(i)).norm() > 0) list.push_back(Eigen::Index(i));
    }
    if (list.empty()) return {};
    const Eigen::MatrixXd columns = J_(Eigen::all, list);
    return columns * columns.colwise().norm().cwiseInverse().asDiagonal();
  }

  void try_parameters(const Eigen::VectorXd& change, const SiteHypothesis& base, std::optional<size_t> of) {
    const Eigen::MatrixXd stay = kept(base, of);
    const auto left_of = [&](const Eigen::VectorXd& column) -> Eigen::VectorXd {
      if (stay.cols() == 0) return column;
      return column - stay * stay.completeOrthogonalDecomposition().solve(column);
    };
    const Eigen::VectorXd wanted = left_of(change);
    std::vector<Similar> similar;
    const bool is_of_one = !of && at_.free_parameters() == 1;
    for (size_t i = 0; i < numbers_.size(); ++i) {
      if (numbers_[i].kind != Kind::factor) continue;
      const int parameter = numbers_[i].owner;
      if (base.is_free[size_t(parameter)] || (is_of_one && at_.is_free[size_t(parameter)])) continue;
      const Eigen::VectorXd column = J_.col(Eigen::Index(i)), own = left_of(column);
      if (!(own.norm() > criteria::least_own_response * column.norm()) || !(wanted.norm() > 0)) continue;
      const double product = own.dot(wanted);
      const double cosine = std::abs(product) / (own.norm() * wanted.norm());
      if (cosine > criteria::same_response)
        similar.push_back({cosine, parameter, product / own.squaredNorm()});
    }
    std::ranges::sort(similar, std::greater{}, &Similar::cosine);
    similar.resize(std::min(fitted_in_one_place, similar.size()));
    for (const Similar& s : similar) fit(base, s, of);
  }

  void fit(SiteHypothesis h, const Similar& similar, std::optional<size_t> of) {
    h.is_free[size_t(similar.parameter)] = true;
    h.factors[size_t(similar.parameter)] = std::clamp(1 + similar.change, 1 / most_factor, most_factor);
    fitter_.refine(h, 8);
    fitter_.fit_noise(h);
    fitter_.refine(h, 3);
    if (std::isfinite(h.objective)) list_.push_back({std::move(h), similar.parameter, of});
  }

  SiteFitter& fitter_;
  const SiteHypothesis& at_;
  std::vector<FittedNumber> numbers_;
  Eigen::MatrixXd J_;
  std::vector<SameResponse> list_;
};

}  // namespace

std::vector<SameResponse> parameters_of_same_response(SiteFitter& fitter, const SiteHypothesis& at,
                                                      const std::vector<bool>& seen) {
  if (at.terms.empty() && at.free_parameters() == 0) return {};
  Responses responses(fitter, at, seen);
  if (!responses.is_known()) return {};
  for (size_t t = 0; t < at.terms.size(); ++t)
    if (at.terms[t].shape->has_coefficients() && !is_unknown_function(*at.terms[t].shape))
      responses.try_in_place_of_term(t);
  if (at.free_parameters() > 0) responses.try_in_place_of_parameters();
  return responses.take();
}

}  // namespace loopwright::diagnosis
