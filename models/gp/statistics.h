/// All that the samples say about a kernel of a given structure: sums whose number does not depend on theirs.
///
///   moments[q][p] = Σ_i m_q(x_i) n_p(v_i),   label_moments[q][p] = Σ_i y_i m_q(x_i) n_p(v_i)
///
/// with the moment functions of two bases. Formed once in O(N); log evidence, gradient and posterior follow
/// in a time that does not depend on N, and a model file needs no samples.
#pragma once
#include <optional>
#include "models/gp/basis.h"

namespace loopwright::gp {

struct Statistics {
  std::array<Basis, 2> bases;
  size_t count = 0;         ///< of samples
  double label_square = 0;  ///< Σ y²
  std::vector<double> moments, label_moments;
};

/// Nothing, and why in `why_not`, when the kernel has no such structure: an input that one term sees as
/// periodic and another as not, two periods on one input, or more functions than `most_functions`.
/// `shortest` are the shortest length scales that will ever be asked for, one an input.
std::optional<Statistics> summarise(const Kernel& kernel, const std::array<double, 2>& shortest,
                                    const Samples& samples, std::string& why_not);

/// What is left when only this kernel will ever be asked about.
Statistics cut(const Statistics& statistics, const Kernel& kernel);

/// Distinct values up to which an input counts as few levels.
inline constexpr size_t most_levels = 40;
/// Functions of one input beyond which the whole matrix is the better way, and of both together.
inline constexpr int most_functions = 1024;

/// The shortest length that a basis resolves to rounding; 0: every one.
double resolved_length(const Basis& basis);

}  // namespace loopwright::gp
