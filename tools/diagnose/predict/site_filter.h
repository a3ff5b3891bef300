/// The general predictor: an extended Kalman filter along the filtered path of any diagram, from one time
/// stamp to the next.
///
/// Outputs are processed one after the other, so that a missing reading is left out and no matrix is
/// inverted:
///   e = y - h(x̂) - C δ,   S = C P Cᵀ + R,   K = P Cᵀ / S,   δ += K e,   P -= K S Kᵀ
///   x̂ ← flow(x̂ + δ),   P ← A P Aᵀ + Σ σ² G Gᵀ
/// with A, C and G (the effect of a unit at a site, held over the sample) by differences: in the middle of
/// each step of the integration (flow_slopes.h), or of the whole sample where that is not smooth enough.
#pragma once
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <span>
#include <vector>
#include "tools/diagnose/predict/site_model.h"

namespace loopwright::diagnosis {

/// [of the size of a state] Steps of differences: rounding and curvature then matter alike.
inline constexpr double difference_step = 1e-6;

inline double squared(double x) { return x * x; }

/// Noise that is alike for a while: a state of its own, s ← exp(-step / time) s + white noise.
struct SlowNoise {
  int output = -1;  ///< an error of this output, which a simulation misses; -1: a disturbance
  int site = -1;    ///< where the disturbance acts, held over each sample
  double size = 0;  ///< [unit of the output or site] standard deviation
  double time = 1;  ///< [s]

  /// Share that is left after a step in s.
  double kept(double step) const { return std::exp(-step / time); }
};

/// White noise, as standard deviations, and slow noise.
struct SiteNoise {
  std::vector<int> sites;           ///< where noise acts
  std::vector<double> process;      ///< [unit of the site] held over a typical sample; shorter ones have more
  std::vector<double> measurement;  ///< [unit of the output]
  std::vector<SlowNoise> slow;
  bool is_of_simulation = false;  ///< the process noise is as good as none, and is not fitted
};

/// Everything along one pass, row after row.
struct SitePass {
  size_t rows = 0, outputs = 0, sites = 0, numbers = 0;
  size_t states = 0;  ///< of the model, then slow noise
  SiteNoise noise;
  bool has_columns = false;                 ///< G of all sites, ramps and the path
  std::vector<double> error, variance;      ///< rows × outputs; NaN: no reading
  std::vector<double> innovation;           ///< rows × outputs: y - h(x̂)
  std::vector<double> C, gain;              ///< rows × outputs × states
  std::vector<double> A;                    ///< rows × states × states, column by column
  std::vector<double> G, ramp;              ///< rows × sites × states
  std::vector<double> share;                ///< rows: of δ that is taken; less than 1 where no state can be
  std::vector<double> correction;           ///< rows × states: what is taken of δ
  std::vector<double> filtered;             ///< rows × states
  std::vector<char> modes;                  ///< rows × bytes: of the blocks, before each flow
  std::array<std::vector<double>, 3> path;  ///< rows × numbers: at the start, middle and end of each sample
  size_t readings = 0;
  double log_variances = 0, squares = 0;  ///< Σ ln S, Σ e²/S

  /// -2 ln L but for a constant.
  double objective() const { return log_variances + squares; }
  /// The same for the best common scale of all variances.
  double scaled_objective() const;
};

class SiteFilter {
 public:
  explicit SiteFilter(SiteModel& model);

  SiteModel& model() { return model_; }
  /// A first guess of the noise, before anything is known but the record.
  SiteNoise guess_noise() const;
  /// With so little noise in the states that predictions are a simulation from estimated initial states,
  /// whose errors may be slow. Noise in a state that is not measured could otherwise explain anything.
  SiteNoise noise_of_simulation() const;
  /// With a slow disturbance at one of its sites, for a fit to begin with.
  SiteNoise with_disturbance(SiteNoise noise, int site) const;
  /// Sizes of states from the record and its initial values, and one for all sites, before any pass.
  void guess_scales(double site);
  /// Sizes of states and sites from a pass; differences are taken in proportion to them.
  void learn_scales(const SitePass& pass);

  /// The same as another filter has learned.
  void take_scales(const SiteFilter& other) {
    state_scale_ = other.state_scale_, site_scale_ = other.site_scale_;
  }

  /// A size at the site of notable effect on a state within a sample.
  double site_scale(int site) const { return site_scale_[size_t(site)]; }

  /// With the model's present parameters and terms, over the first `rows` rows. False if the model diverges.
  bool run(size_t rows, const SiteNoise& noise, bool with_columns, SitePass& pass);
  /// The errors of the model's present parameters and terms with gains and variances of another pass.
  bool run_frozen(const SitePass& gains, std::span<double> error);
  /// Without any correction from row `from` on, starting from the filtered state there: y - h, NaN where
  /// there is no reading. Where the filter `settles`, there is no error: it begins after that.
  bool simulate(const SitePass& pass, const std::vector<bool>& settles, size_t from, size_t to,
                std::span<double> error);
  /// Variances of the errors of simulations that begin anew every `length` rows, if nothing but the noise of
  /// the pass is missing; from row `from` to the end. Linearized about the pass; what it has learned of slow
  /// noise is forgotten where a simulation begins.
  void expect_of_simulations(const SitePass& pass, const std::vector<bool>& settles, size_t from,
                             size_t length, std::span<double> variance);
  /// The same from the initial states that fit these rows best.
  bool simulate_freely(size_t from, size_t to, std::span<double> error);
  /// -2 ln L of another noise, linearized about the pass.
  double objective_with(const SitePass& pass, const SiteNoise& noise) const;
  /// Response of the whitened errors to a term at a site that takes these values at the start, middle and end
  /// of each sample.
  void respond(const SitePass& pass, int site, std::span<const double> start, std::span<const double> middle,
               std::span<const double> end, std::span<double> column) const;
  /// The row at which the last pass has ended, and the states from which it was stepped last.
  struct End {
    size_t row = 0;
    Eigen::VectorXd states;
  };
  const End& end() const { return end_; }
  /// As many steps of the integration in a sample as make no difference, at rows along the pass. It is a
  /// share of the size of a state.
  void choose_substeps(const SitePass& pass, double difference = 1e-6);

 private:
  void allocate(size_t rows, bool with_columns, SitePass& pass);
  /// Of the record that begins at the row.
  std::vector<double> initial_states(size_t row);
  /// x_ at the beginning of a record.
  void begin_at(size_t row);
  double initial_variance(const SiteNoise& noise, size_t state) const;
  /// P_ there.
  void begin_covariance(const SiteNoise& noise);
  /// Of x_, to y_.
  void add_slow_errors(const SiteNoise& noise);
  /// Lets the disturbances of x_ act over the flows that follow, or none.
  void hold_disturbances(const SiteNoise& noise);
  void release_disturbances(const SiteNoise& noise);
  /// next_ from x_.
  bool advance(size_t row, const SiteNoise& noise, double* middle, FlowSlopes* slopes);
  /// The same after the correction delta_, or the share of it after which the model is finite: the noise of a
  /// reading may lead where no state can be.
  bool advance_from_correction(size_t row, const SitePass& pass, double* middle, double& share,
                               FlowSlopes* slopes = nullptr);
  void keep_correction(size_t row, double share, SitePass& pass) const;
  bool correct(size_t row, const SiteNoise& noise, SitePass& pass);
  bool slopes_of_outputs(size_t row, SitePass& pass);
  /// A, G, ramps and the path at the row, from x_ and next_.
  bool linearize(size_t row, const SiteNoise& noise, SitePass& pass);
  /// Those of the model's own states, with the disturbances that act.
  bool differences(size_t row, const SiteNoise& noise, SitePass& pass);
  /// The same from slopes_, where they are known.
  void take_slopes(size_t row, SitePass& pass);
  /// What differences are taken with.
  void choose_changes(const SiteNoise& noise, const SitePass& pass);
  /// The path at the row.
  bool look_along(size_t row, SitePass& pass);
  bool respond_to(int site, bool ramp, size_t row, SitePass& pass, std::span<double> to);
  /// A flow from other states or with other signals, from the modes of this row.
  bool try_flow(size_t row, const SitePass& pass, const double* from, double* to);
  char* modes_at(SitePass& pass, size_t row) const { return &pass.modes[row * model_.mode_bytes()]; }
  void predict_covariance(const SitePass& pass, size_t row, const SiteNoise& noise);
  /// At a site with these effects on the states, held over a typical sample: what moves one of them by a
  /// hundredth of its size. Infinite if it moves none.
  double notable_size(const double* G) const;
  /// Of the process noise at the row. In a simulation it is told by what it does to the states: parameters
  /// that all become smaller, and leave the motion as it is, would otherwise have it grow.
  double deviation_at(const SitePass& pass, size_t row, const SiteNoise& noise, size_t index) const;
  bool simulate_from(const Eigen::VectorXd& initial, size_t from, size_t to, std::span<double> error);

  SiteModel& model_;
  const SignalRecord& record_;
  const size_t model_states_;
  std::vector<double> state_scale_, site_scale_;
  Eigen::MatrixXd P_, product_;
  Eigen::VectorXd x_, next_, moved_, moved_next_, middle_, gain_, delta_, difference_;
  std::vector<double> y_, y_moved_;
  End end_;
  FlowSlopes slopes_;
  std::vector<char> modes_, start_modes_;  // after a flow; at the beginning of a record
};

}  // namespace loopwright::diagnosis
