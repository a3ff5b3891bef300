/// How much the records speak for each member of a set, and how much force it explains.
#pragma once
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// The evidence for one member, and its size.
struct Weight {
  double wald = 0;       ///< χ²: squared distance from zero in standard deviations, its shape known
  double counts = 0;     ///< χ² that noise and counts of the first sensor alone would give it; 0: not asked
  double certainty = 0;  ///< the same with its shape estimated too, over the 95 % quantile; below 1 its
                         ///< interval contains zero
  double force_rms = 0;  ///< of the force it consumes, over the fitted rows; sensor: the equivalent force
  double unique_force = 0;  ///< the part of it that no other member could replace
  double loss = 0;          ///< loss of the criterion without it
};

/// Computes the covariance of an estimate with the given noise, and the weight of every member.
std::vector<Weight> weigh_all(Trials& trials, Estimate& estimate);
/// Fills Weight::counts, as weigh_all() does where the errors are not white.
void weigh_counts(const Trials& trials, const Estimate& estimate, std::vector<Weight>& weights);

/// The force by which an error of one standard deviation is counted.
double force_of_an_error(const Noise& noise);

/// Number of fitted rows × ports; rows at a higher rate than once in criteria::judged_row_s count as parts.
double judged_numbers(const Trials& trials);

/// How far a member is above all thresholds of certainty and force; a member below one of them is not
/// accepted.
double material(const Trials& trials, const Estimate& estimate, const Weight& weight);

/// The members without one of them.
std::vector<Member> without_one(std::vector<Member> members, size_t index);

}  // namespace loopwright::diagnosis
