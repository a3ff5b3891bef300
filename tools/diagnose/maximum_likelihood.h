/// Joint maximum likelihood: the parameters of all members, and the noise.
#pragma once
#include "tools/diagnose/hypothesis.h"

namespace loopwright::diagnosis {

struct Estimate {
  std::vector<Member> members;
  Noise noise;
  Motion motion;  ///< on which the members ran
  std::vector<Fitted> fitted;
  double mean_square = 0;      ///< of the whitened errors; 1 when model and noise are right
  double profile = 0;          ///< see profile(): smaller is better
  double against_at_rest = 0;  ///< see against_at_rest()
  Eigen::MatrixXd covariance;  ///< of the free parameters, times max(1, mean_square)
  bool is_valid = false;
};

/// Gauss-Newton on the prediction errors with the noise as given, from the members as given. Each iteration
/// steps the diagram once or, where a step has to be shortened, a few times. What a better model sees takes
/// the place of the motion given as soon as the two may differ.
Estimate fit_members(Trials& trials, std::vector<Member> members, const Noise& noise, const Motion& motion,
                     int iterations);

/// The same on the motion that it saw itself.
Estimate on_own_motion(Trials& trials, Estimate estimate);

/// Noise for the search: tight, so that a missing effect is not taken for noise.
Noise search_noise(const Trials& trials);

/// Which of its numbers the likelihood may change.
enum class FreeNoise { with_random_walk, white_and_slow, all };
/// Maximises the likelihood of the noise, the errors of the estimate given. Bounded: a factor of thirty
/// around the start.
Noise fit_noise(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& start, FreeNoise free);

/// The slow force of an amplifier, as a part of the white one.
constexpr double usual_slow_noise = 0.3;
/// A slow force above this part of the white one is no noise but something that the model lacks.
constexpr double most_slow_noise = 0.8;

/// fit_noise; but where the slow force comes out as more than noise, all of it is counted as white. The
/// predictor would else follow what the model lacks, and effects fitted beside it would lose their steady
/// parts to it.
Noise fit_noise_alone(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& start,
                      FreeNoise free);

/// Widens the covariance where errors in blocks of half a second are more alike than independent errors are:
/// the sandwich estimator by blocks (Liang and Zeger 1986), a factor for each parameter, never less than one.
void widen_by_blocks(const Trials& trials, Estimate& estimate);

/// Fills Estimate::covariance.
void work_out_covariance(Trials& trials, Estimate& estimate);

}  // namespace loopwright::diagnosis
