/// The derivatives of a sample and of the outputs, by differences of the model.
#include <algorithm>
#include <cmath>
#include "tools/diagnose/predict/site_filter.h"

namespace loopwright::diagnosis {
namespace {

using Map = Eigen::Map<Eigen::VectorXd>;

/// The first length at whose end the model is finite; 0 if there is none. A square root ends at an empty
/// tank, and what moves a state by a notable amount is unknown at first: steps to the other side and shorter
/// ones are tried then.
template <class IsFiniteAt> double first_finite(IsFiniteAt&& is_finite_at) {
  for (double length = 1; length > 1e-9; length /= 10) {
    if (is_finite_at(length)) return length;
    if (is_finite_at(-length)) return -length;
  }
  return 0;
}

}  // namespace

bool SiteFilter::slopes_of_outputs(size_t row, SitePass& pass) {
  const size_t n = pass.states;
  double* const C = &pass.C[row * pass.outputs * n];
  bool are_all_known = true;
  for (size_t j = 0; j < pass.outputs; ++j) {
    std::fill_n(C + j * n, n, 0.0);
    if (const int state = model_.measured_state(j); state >= 0 && !model_.is_distorted(j))
      C[j * n + size_t(state)] = 1;
    else
      are_all_known = false;
    for (size_t s = 0; s < pass.noise.slow.size(); ++s)
      if (pass.noise.slow[s].output == int(j)) C[j * n + model_states_ + s] = 1;
  }
  if (are_all_known) return true;
  moved_ = x_;
  model_.keep_modes(row, modes_.data());
  for (size_t i = 0; i < model_states_; ++i) {
    const auto is_finite_with = [&](double length) {
      moved_[Eigen::Index(i)] = x_[Eigen::Index(i)] + length * difference_step * state_scale_[i];
      model_.put_modes_back(row, modes_.data());
      return model_.outputs(row, moved_.data(), y_moved_.data()) &&
             std::ranges::all_of(y_moved_, [](double y) { return std::isfinite(y); });
    };
    const double change = difference_step * state_scale_[i] * first_finite(is_finite_with);
    if (change == 0) return false;
    moved_[Eigen::Index(i)] = x_[Eigen::Index(i)];
    for (size_t j = 0; j < pass.outputs; ++j)
      if (model_.measured_state(j) < 0 || model_.is_distorted(j))
        C[j * n + i] = (y_moved_[j] - y_[j]) / change;
  }
  model_.put_modes_back(row, modes_.data());
  return true;
}

bool SiteFilter::respond_to(int site, bool ramp, size_t row, SitePass& pass, std::span<double> to) {
  if (model_.output_of_sensor(site) >= 0) {
    std::ranges::fill(to, 0.0);
    return true;
  }
  const double held = model_.held(site);
  const auto is_finite_with = [&](double length) {
    const double tried = length * site_scale_[size_t(site)];
    if (ramp)
      model_.set_ramp(site, row, tried);
    else
      model_.hold(site, held + tried);
    return try_flow(row, pass, x_.data(), moved_next_.data());
  };
  const double size = site_scale_[size_t(site)] * first_finite(is_finite_with);
  if (ramp) model_.set_ramp(site, row, 0);
  model_.hold(site, held);
  if (size == 0) return false;
  for (size_t i = 0; i < to.size(); ++i)  // slow noise stays as it is
    to[i] = (moved_next_[Eigen::Index(i)] - next_[Eigen::Index(i)]) / size;
  return true;
}

bool SiteFilter::linearize(size_t row, const SiteNoise& noise, SitePass& pass) {
  hold_disturbances(noise);
  const bool good = differences(row, noise, pass);
  release_disturbances(noise);
  for (size_t j = 0; good && j < noise.slow.size(); ++j) {
    const size_t n = pass.states, state = model_states_ + j;
    double* const column = &pass.A[(row * n + state) * n];
    if (const int site = noise.slow[j].site; site >= 0)
      std::copy_n(&pass.G[(row * pass.sites + size_t(site)) * n], model_states_, column);
    column[state] = noise.slow[j].kept(record_.step(row));
  }
  return good;
}

void SiteFilter::choose_changes(const SiteNoise& noise, const SitePass& pass) {
  std::vector<double> of_states, at_sites;
  for (double scale : state_scale_) of_states.push_back(difference_step * scale);
  std::vector<int> sites = noise.sites;
  if (pass.has_columns) {
    sites.clear();
    for (int site = 0; site < int(pass.sites); ++site)
      if (model_.output_of_sensor(site) < 0) sites.push_back(site);
  }
  for (int site : sites) at_sites.push_back(site_scale_[size_t(site)]);
  slopes_.prepare(of_states, std::move(sites), std::move(at_sites), pass.has_columns);
}

void SiteFilter::take_slopes(size_t row, SitePass& pass) {
  const size_t n = pass.states;
  const auto m = Eigen::Index(model_states_);
  Map(&pass.A[row * n * n], Eigen::Index(n * n)).setZero();
  for (Eigen::Index i = 0; i < m; ++i)
    Map(&pass.A[(row * n + size_t(i)) * n], m) = slopes_.by_states().col(i);
  if (pass.has_columns) {  // sensors move no state
    Map(&pass.G[row * pass.sites * n], Eigen::Index(pass.sites * n)).setZero();
    Map(&pass.ramp[row * pass.sites * n], Eigen::Index(pass.sites * n)).setZero();
  }
  for (size_t s = 0; s < slopes_.sites().size(); ++s) {
    const size_t at = (row * pass.sites + size_t(slopes_.sites()[s])) * n;
    Map(&pass.G[at], Eigen::Index(n)).setZero();
    Map(&pass.G[at], m) = slopes_.by_held(s);
    if (pass.has_columns) Map(&pass.ramp[at], m) = slopes_.by_ramp(s);
  }
}

bool SiteFilter::differences(size_t row, const SiteNoise& noise, SitePass& pass) {
  const size_t n = pass.states;
  model_.keep_modes(row, modes_.data());  // where the next row goes on
  if (slopes_.is_known()) {
    take_slopes(row, pass);
    return !pass.has_columns || look_along(row, pass);
  }
  moved_ = x_, moved_next_ = next_;
  Map(&pass.A[row * n * n], Eigen::Index(n * n)).setZero();
  for (size_t i = 0; i < model_states_; ++i) {
    const auto is_finite_with = [&](double length) {
      moved_[Eigen::Index(i)] = x_[Eigen::Index(i)] + length * difference_step * state_scale_[i];
      return try_flow(row, pass, moved_.data(), moved_next_.data());
    };
    const double change = difference_step * state_scale_[i] * first_finite(is_finite_with);
    if (change == 0) return false;
    moved_[Eigen::Index(i)] = x_[Eigen::Index(i)];
    Map(&pass.A[(row * n + i) * n], Eigen::Index(n)) = (moved_next_ - next_) / change;
  }
  const auto G = [&](int site) { return std::span(&pass.G[(row * pass.sites + size_t(site)) * n], n); };
  if (!pass.has_columns) {
    for (int site : noise.sites)
      if (!respond_to(site, false, row, pass, G(site))) return false;
    model_.put_modes_back(row, modes_.data());
    return true;
  }
  for (int site = 0; site < int(pass.sites); ++site) {
    const std::span ramp(&pass.ramp[(row * pass.sites + size_t(site)) * n], n);
    if (!respond_to(site, false, row, pass, G(site)) || !respond_to(site, true, row, pass, ramp))
      return false;
  }
  return look_along(row, pass);
}

bool SiteFilter::look_along(size_t row, SitePass& pass) {
  const double begin = record_.time[row], step = record_.step(row);
  const auto numbers = [&](size_t k) { return &pass.path[k][row * pass.numbers]; };
  model_.put_modes_back(row, modes_at(pass, row));
  const bool good = model_.look(row, begin, x_.data(), numbers(0)) &&
                    model_.look(row, begin + step / 2, middle_.data(), numbers(1)) &&
                    model_.look(row, begin + step, next_.data(), numbers(2));
  model_.put_modes_back(row, modes_.data());
  return good;
}

}  // namespace loopwright::diagnosis
