/// Answers of few numbers beside which a set that was found has to stand: a single parameter, an error of a
/// single sensor.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>
#include "tools/diagnose/search/judged_fits.h"

namespace loopwright::diagnosis {

class SimplerAnswers : protected JudgedFits {
 protected:
  using JudgedFits::JudgedFits;

  /// Takes an answer in the place of one that it is no part of.
  void take(SiteHypothesis& at, const SiteHypothesis& other, const std::string& what);
  /// A parameter that does what a term does is the simpler explanation, and so is one that does what several
  /// parameters do together. One that does what a single other one does is declared.
  void compare_with_parameters_of_same_response(SiteHypothesis& at);
  /// Terms and parameters that do what a single parameter does are that parameter.
  void compare_with_one_parameter(SiteHypothesis& at);
  /// A single term in the place of two of several: a constant at a coupling and one at a sum that it feeds
  /// are the constant of the other sum. The two are declared. `decide`: which parameters moved then.
  void join_terms(SiteHypothesis& at, const std::function<void(SiteHypothesis&)>& decide);
  /// Sensors are not looked at unless the experiment says so, but what one that is off does is no constant of
  /// the machine.
  void declare_offsets_of_sensors(const SiteHypothesis& at);
  /// What a single sensor that is off does with fewer numbers, alone or beside one of the changes, is that
  /// sensor, unless the experiment limits where something may be missing. One that does as well is declared.
  void compare_with_sensors(SiteHypothesis& at);

  std::vector<SiteHypothesis> single_;  ///< see with_one_parameter()
  std::vector<bool> exchanged_beside_;  ///< the parameters that were free when terms were exchanged

 private:
  /// The two in whose place one stands now, without the number of that one.
  std::optional<ParameterRival> join_any_pair(SiteHypothesis& at);
  std::optional<ParameterRival> join_pair(SiteHypothesis& at, size_t first, size_t second);
  /// The diagram with a single one of several changes, for each of them.
  std::vector<SiteHypothesis> changes_alone(const SiteHypothesis& at);
  bool looks_everywhere();

  std::vector<SiteHypothesis> of_sensors_;  ///< see with_error_of_one_sensor()
  std::vector<std::string> asked_beside_;   ///< the changes in whose place they stand
  std::vector<std::string> not_joined_;     ///< changes of which no pair is one
};

}  // namespace loopwright::diagnosis
