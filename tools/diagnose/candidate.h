/// An effect as the diagnosis sees it: columns along a path, and what its parameters may be.
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "tools/diagnose/predictor.h"
#include "tools/effects/effect.h"

namespace loopwright::diagnosis {

struct CandidateParameter {
  std::string name, unit;
  double low = 0, high = 0;
  bool logarithmic = false;  ///< how it is stepped through, when nonlinear
  std::vector<double> grid;  ///< where the search looks first, when nonlinear
  double span = 0;   ///< of a period: the stroke or time over which it repeats; decides how sharp it is
  double start = 0;  ///< a usual value

  /// The range ends at this value: a warning, not a result.
  bool ends_at(double value) const {
    const double edge = 1e-6 * (high - low);
    return value <= low + edge || value >= high - edge;
  }
};

struct Member;

struct Candidate {
  std::string name, form;  ///< form: of an effect with several
  Acts acts = Acts::force;
  Attachment::Stage stage = Attachment::Stage::command;  ///< of Acts::input
  std::vector<CandidateParameter> linear;                ///< amplitudes
  std::vector<CandidateParameter> nonlinear;             ///< shapes
  /// Pure shape (a delay, a lag): the amplitude stands for the step from 0 to the shape and must be near one.
  bool amplitude_is_one = false;
  /// Scans every pitch: the first nonlinear parameter is one, the columns are its sine and cosine.
  bool is_periodic = false;
  AtRest at_rest = AtRest::free;
  bool flies = false;            ///< its force is nothing for a while and comes back with a blow
  bool is_repeatable = false;    ///< may be there more than once
  bool repeats_in_time = false;  ///< its period is one of time, not of position
  bool is_unknown = false;       ///< no effect of the catalogue but any function of the variables in `form`
  /// At several shapes, side by side: cheaper than one after the other.
  std::function<std::vector<Columns>(const Path& path, const std::vector<std::vector<double>>& shapes)>
      columns_at;
  Columns columns(const Path& path, const std::vector<double>& shape) const {
    return std::move(columns_at(path, {shape}).front());
  }
  /// How much of what it consumes is a mass times the acceleration of the moving part; empty: nothing. That
  /// part is put into the model's own mass, where it acts at once.
  std::function<double(const Member& member)> added_inertia;
};

/// An effect taken into the model, with its parameters.
struct Member {
  const Candidate* candidate = nullptr;
  std::vector<double> linear, nonlinear;
};

}  // namespace loopwright::diagnosis
