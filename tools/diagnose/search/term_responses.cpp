#include "tools/diagnose/search/term_responses.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/remembered_path.h"

namespace loopwright::diagnosis {
namespace {

/// An orthonormal basis of the columns.
Eigen::MatrixXd basis_of(const Eigen::MatrixXd& J) {
  if (J.cols() == 0) return J;
  Eigen::VectorXd norm = J.colwise().norm().transpose();
  for (double& size : norm)
    if (!(size > 0)) size = 1;
  const Eigen::MatrixXd unit = J * norm.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unit.transpose() * unit);
  Eigen::MatrixXd basis(J.rows(), J.cols());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < J.cols(); ++i)
    if (eigen.eigenvalues()[i] > criteria::weakest_direction)
      basis.col(count++) = unit * eigen.eigenvectors().col(i) / std::sqrt(eigen.eigenvalues()[i]);
  return basis.leftCols(count);
}

}  // namespace

TermResponses::TermResponses(SiteFitter& fitter, SiteHypothesis& at) : fitter_(fitter) {
  is_good_ = fitter_.pass(at, true, pass_);
  if (!is_good_) return;
  basis_ = basis_of(fitter_.jacobian(at, pass_));
  rest_ = fitter_.whitened(pass_);
  rest_ -= basis_ * (basis_.transpose() * rest_);
  for (auto& list : phi_) list.resize(pass_.rows);
}

std::vector<double> TermResponses::signal(int variable) const {
  std::vector<double> values(pass_.rows);
  for (size_t k = 0; variable >= 0 && k < pass_.rows; ++k)
    values[k] = fitter_.model().variables()[size_t(variable)].at(&pass_.path[0][k * pass_.numbers]);
  return values;
}

void TermResponses::evaluate(const SiteTerm& term, bool in_middle_alone) {
  const SiteVariable none;
  const SiteVariable& variable =
      term.variable < 0 ? none : fitter_.model().variables()[size_t(term.variable)];
  const size_t count = size_t(term.shape->columns), rows = pass_.rows;
  for (auto& list : phi_) list.resize(count * rows);
  if (term.shape->remembered) phi_ = remembered_along(fitter_.model(), pass_, term);
  std::array<double, most_columns> square{}, all;
  for (size_t part = 0; part < 3; ++part) {
    if (in_middle_alone && part != 1) continue;
    for (size_t k = 0; k < rows; ++k) {
      if (term.shape->remembered)
        all[0] = phi_[part][k];
      else
        term.columns(term.variable < 0 ? 0 : variable.at(&pass_.path[part][k * pass_.numbers]), all.data());
      for (size_t c = 0; c < count; ++c) phi_[part][c * rows + k] = all[c], square[c] += all[c] * all[c];
    }
  }
  is_in_middle_alone_ = in_middle_alone;
  for (size_t c = 0; c < count; ++c)
    sizes_[c] = std::sqrt(square[c] / ((in_middle_alone ? 1 : 3) * double(rows)));
}

Eigen::MatrixXd TermResponses::responses(SiteTerm& term, int site) {
  term.site = site;
  const size_t rows = pass_.rows;
  Eigen::MatrixXd columns(Eigen::Index(pass_.error.size()), term.shape->columns);
  for (size_t c = 0; c < size_t(term.shape->columns); ++c) {
    term.unit[c] = sizes_[c] > 0 ? fitter_.filter().site_scale(site) / sizes_[c] : 1;
    const auto along = [&](size_t part) {
      return std::span(phi_[is_in_middle_alone_ ? 1 : part]).subspan(c * rows, rows);
    };
    fitter_.filter().respond(pass_, site, along(0), along(1), along(2),
                             {columns.col(Eigen::Index(c)).data(), pass_.error.size()});
  }
  return columns;
}

Eigen::MatrixXd TermResponses::response_of_input(int site, const InputLines& change) {
  const SignalRecord& record = fitter_.model().record();
  for (size_t k = 0; k < pass_.rows; ++k)
    for (size_t part = 0; part < 3; ++part)
      phi_[part][k] = change[k].value + change[k].slope * record.step(k) * double(part) / 2;
  Eigen::MatrixXd column(Eigen::Index(pass_.error.size()), 1);
  fitter_.filter().respond(pass_, site, phi_[0], phi_[1], phi_[2],
                           {column.col(0).data(), pass_.error.size()});
  leave_out_free(column);
  return column;
}

double TermResponses::explain(const Eigen::MatrixXd& columns, SiteTerm& term) const {
  const Eigen::VectorXd norm = columns.colwise().norm().transpose();
  if (!(norm.maxCoeff() > 0)) return 0;
  Eigen::VectorXd weight(norm.size());
  for (Eigen::Index i = 0; i < norm.size(); ++i) weight[i] = norm[i] > 0 ? 1 / norm[i] : 0;
  const Eigen::MatrixXd unit = columns * weight.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unit.transpose() * unit);
  const Eigen::VectorXd right = unit.transpose() * rest_;
  Eigen::VectorXd coefficient = Eigen::VectorXd::Zero(norm.size());
  for (Eigen::Index i = 0; i < norm.size(); ++i)
    if (eigen.eigenvalues()[i] > 1e-6)
      coefficient +=
          eigen.eigenvectors().col(i) * (eigen.eigenvectors().col(i).dot(right) / eigen.eigenvalues()[i]);
  const double before = rest_.squaredNorm(), after = (rest_ - unit * coefficient).squaredNorm();
  coefficient = weight.asDiagonal() * coefficient;
  for (Eigen::Index c = 0; c < norm.size(); ++c) term.coefficient[size_t(c)] = coefficient[c];
  return double(pass_.readings) * std::log(before / std::max(after, 1e-12 * before));
}

}  // namespace loopwright::diagnosis
