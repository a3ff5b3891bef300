/// Sufficient statistics of the samples for a kernel of a given structure. Their number does not depend on N.
///
///   moments[q][p] = Σ_i m_q(x_i) n_p(v_i),   label_moments[q][p] = Σ_i y_i m_q(x_i) n_p(v_i)
///
/// with the moment functions of two bases. They are formed once in O(N). Log evidence, gradient and posterior
/// then take a time that does not depend on N, and a model file needs no samples.
#pragma once
#include <optional>
#include "models/gp/basis.h"

namespace loopwright::gp {

struct Statistics {
  std::array<Basis, 2> bases;
  size_t count = 0;         ///< number of samples
  double label_square = 0;  ///< Σ y²
  std::vector<double> moments, label_moments;
};

/// Returns nothing, and the reason in `why_not`, if the kernel lacks this structure: an input that is
/// periodic in one term but not in another, two periods on one input, or more functions than
/// `most_functions`. `shortest` has the shortest length scale that will be requested, one for each input.
std::optional<Statistics> summarise(const Kernel& kernel, const std::array<double, 2>& shortest,
                                    const Samples& samples, std::string& why_not);

/// The smaller statistics that suffice if only this kernel will be used.
Statistics cut(const Statistics& statistics, const Kernel& kernel);

/// Largest number of distinct values for which an input is treated as levels.
inline constexpr size_t most_levels = 40;
/// Largest number of functions of one input, and of both together. Beyond it the full matrix is the better
/// method.
inline constexpr int most_functions = 1024;

/// The shortest length that a basis resolves to rounding; 0: any length.
double resolved_length(const Basis& basis);

}  // namespace loopwright::gp
