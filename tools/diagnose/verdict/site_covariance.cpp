#include "tools/diagnose/verdict/site_covariance.h"
#include <cmath>
#include <limits>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {

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
  const Eigen::MatrixXd inverse = (unit.transpose() * unit).completeOrthogonalDecomposition().pseudoInverse();
  Eigen::MatrixXd covariance = norm.cwiseInverse().asDiagonal() * inverse * norm.cwiseInverse().asDiagonal();
  for (Eigen::Index i = 0; i < count; ++i)
    if (!(J.col(i).norm() > 0)) covariance(i, i) = std::numeric_limits<double>::infinity();
  return covariance;
}

}  // namespace loopwright::diagnosis
