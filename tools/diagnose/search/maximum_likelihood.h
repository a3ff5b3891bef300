/// Joint maximum likelihood: the parameters of all members, and the noise.
#pragma once
#include <limits>
#include "tools/diagnose/search/hypothesis.h"

namespace loopwright::diagnosis {

struct Estimate {
  std::vector<Member> members;
  Noise noise;
  Motion motion;  ///< motion on which the members ran
  Results fitted;
  double mean_square = 0;      ///< of the whitened errors; 1 when model and noise are correct
  double profile = 0;          ///< see profile(): smaller is better
  double against_at_rest = 0;  ///< see against_at_rest()
  Eigen::MatrixXd covariance;  ///< of the free parameters, times max(1, mean_square)
  bool is_valid = false;

  /// Twice the negative log-likelihood, without the price of the parameters.
  double misfit() const {
    return is_valid ? profile + against_at_rest : std::numeric_limits<double>::infinity();
  }
};

/// Gauss-Newton on the prediction errors with the given noise, starting from the given members. Each
/// iteration steps the diagram once or, if a step must be shortened, a few times. The motion estimated by a
/// better model replaces the given motion as soon as the two may differ. It ends early where the profile
/// would stay above `worst` though every iteration left gained as much as the present one promises.
Estimate fit_members(Trials& trials, std::vector<Member> members, const Noise& noise, const Motion& motion,
                     int iterations, double worst = std::numeric_limits<double>::infinity());

/// Parameters and noise in turn: the likelihood of both together. It ends early where the profile would stay
/// above `worst` though the next turn gained as much as the present one.
Estimate with_own_noise(Trials& trials, Estimate estimate, int iterations,
                        double worst = std::numeric_limits<double>::infinity());

/// On a rotary axis what belongs to motor, bearing or encoder repeats a whole number of times a turn, and a
/// pitch that is wrong by a thousandth is wrong by a period after a few turns. Every pitch that the records
/// cannot tell from such a part of a turn is set to it and no longer fitted.
Estimate snap_to_turn(Trials& trials, Estimate estimate);

/// The same on the motion that it estimated itself.
Estimate on_own_motion(Trials& trials, Estimate estimate);
/// The same members fitted along it, again and again, as long as they explain more so. The motion that a
/// wrong set predicted bends the parameters of the right one, which then explain less along their own motion
/// until they are fitted there.
Estimate with_own_motion(Trials& trials, Estimate estimate, int iterations);

/// Noise for the search: small, so that a missing effect is not taken for noise.
Noise search_noise(const Trials& trials);

/// Which of its parameters may be changed.
enum class FreeNoise { with_random_walk, white, white_and_slow, all };
/// Maximizes the likelihood of the noise for the errors of the given estimate. Bounded: a factor of thirty
/// around the start.
Noise fit_noise(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& start, FreeNoise free);

/// Whether the slow force lasts a few samples, and stands for white noise.
bool is_soon_forgotten(const Noise& noise);
/// Whether the slow force that the errors ask for is small, forgotten quickly, or as likely white: noise that
/// lasts no longer than the sensor takes to show it. Otherwise it is something that the model lacks.
bool is_remainder_noise(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& start);

/// fit_noise; but if the slow force is more than noise, all of it is counted as white, by the likelihood too.
/// Otherwise the predictor would follow what the model lacks, and effects fitted with it would lose their
/// steady parts to it; with less noise than that, the errors would ask for effects that make up for it.
Noise fit_noise_alone(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& start,
                      FreeNoise free);

/// Increases the covariance if errors in blocks of half a second are more correlated than independent errors:
/// the sandwich estimator by blocks (Liang and Zeger 1986), a factor for each parameter, never less than one.
void widen_by_blocks(const Trials& trials, Estimate& estimate);

/// Increases the variance of each parameter until it covers what the two halves of the rows ask for by
/// themselves, where a load moves by itself: what it does hangs on moments, such as a blow, that the
/// likelihood of the whole takes for certain.
void widen_by_halves(Trials& trials, Estimate& estimate);

/// Jᵀ J and Jᵀ e for changes of the free parameters, over the fitted rows.
struct NormalEquations {
  Eigen::MatrixXd G;
  Eigen::VectorXd b;
};
/// With other whitened errors of each record than those of the estimate.
NormalEquations normal_equations(const Trials& trials, const Estimate& estimate,
                                 const std::vector<std::vector<double>>& errors);

/// Fills Estimate::covariance; sine and cosine of a pattern with the phase at the middle of the record.
void work_out_covariance(Trials& trials, Estimate& estimate);
/// The same with the phase at zero.
void refer_to_zero(Estimate& estimate);

}  // namespace loopwright::diagnosis
