#include "tools/diagnose/verdict/site_covariance.h"
#include <cmath>
#include <limits>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// [of that of the best direction] Less is rounding of the products of a Jacobian.
constexpr double least_information = 1e-14;
/// [of a number's square] In directions without information, from which on it is not told: less is rounding.
constexpr double least_untold_share = 1e-6;

}  // namespace

Eigen::MatrixXd covariance_of(SiteFitter& fitter, SiteHypothesis h) {
  SitePass pass;
  const Eigen::Index count = Eigen::Index(size_of(h));
  const Eigen::MatrixXd untold =
      Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity()).asDiagonal();
  if (count == 0 || !fitter.pass(h, false, pass)) return untold;
  const Eigen::MatrixXd readings = fitter.jacobian(h, pass);
  const double scale = std::sqrt(pass.squares / double(pass.readings));
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(readings.rows() + count, count);
  J.topRows(readings.rows()) = readings / scale;
  const std::vector<FittedNumber> numbers = fitted_numbers(h);
  for (Eigen::Index i = 0; i < count; ++i)  // what is stated counts too, as in the fit
    if (numbers[size_t(i)].kind == FittedNumber::Kind::factor)
      J(readings.rows() + i, i) = 1 / criteria::deviation_of_stated_parameter;
  Eigen::VectorXd norm = J.colwise().norm().transpose();
  for (double& size : norm)
    if (!(size > 0)) size = 1;
  const Eigen::MatrixXd unit = J * norm.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> information(unit.transpose() * unit);
  const Eigen::VectorXd& strength = information.eigenvalues();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd untold_share = Eigen::VectorXd::Zero(count);  // of each number, in directions nobody sees
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto direction = information.eigenvectors().col(k);
    if (strength[k] > least_information * strength[count - 1])
      inverse += direction * direction.transpose() / strength[k];
    else
      untold_share += direction.cwiseAbs2();
  }
  Eigen::MatrixXd covariance = norm.cwiseInverse().asDiagonal() * inverse * norm.cwiseInverse().asDiagonal();
  for (Eigen::Index i = 0; i < count; ++i)
    if (untold_share[i] > least_untold_share) covariance(i, i) = std::numeric_limits<double>::infinity();
  return covariance;
}

}  // namespace loopwright::diagnosis
