/// An effect stands only if the diagram simulates no worse with it.
#pragma once
#include <functional>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/verdict/free_run.h"
#include "tools/diagnose/verdict/staircase.h"

namespace loopwright::diagnosis {

struct Acceptance {
  Conclusion conclusion;
  Staircase staircase;
  std::vector<FreeRun> runs;  ///< one per step of the staircase; empty if the diagram cannot be run
  std::vector<RefusedEffect> refused;
  bool is_worse = false;    ///< with all effects, than the nominal diagram
  bool diverges = false;    ///< the diagram with all of them, unless a load moves by itself
  std::string why_not_run;  ///< empty: it was run

  /// Too few to tell whether any effect makes them worse.
  bool has_few_simulations() const {
    return !runs.empty() && !runs.back().diverged && staircase.steps.size() > 1 &&
           double(runs.back().squares.size()) < criteria::least_windows;
  }
};

/// What a set of effects leaves, root mean squares: of the free simulation, and of the balance of forces in
/// the fitted and in the held-out rows (0: there are none).
struct Errors {
  double simulation = 0, force = 0, held_out_force = 0;
};
/// Whether simulation and held-out force are (if nothing is held out, the fitted force), though neither may
/// be so beyond doubt. An effect that makes them larger gains from the noise of single rows alone: at tens of
/// kilohertz encoder counts that a controller answers look like a delay.
bool are_larger(const Errors& before, const Errors& after);

/// An optional step that brings most of what the simulation gains is needed, and so are those before it.
void need_what_simulates_better(std::vector<DiagnosisStep>& steps);

/// Removes effects one by one as long as the diagram cannot be run with one of them, or simulates worse with
/// it than without it (unless a load moves by itself: where it is at the beginning of a window is not known),
/// as simulation and held-out force are both worse with one, as counts of the sensor are not white and the
/// diagram simulates no better with one, as the interval of one contains zero while the diagram simulates
/// no worse without it, as a load of its own explains less than a sensor whose offset wanders, or as one is
/// smaller than what the forces leave beside noise.
/// `without(conclusion, member)` is the conclusion from the others.
Acceptance accept(Conclusion conclusion, Trials& trials, const std::vector<InverseDynamics>& inverse,
                  const Improver& improver, const LoadOptions& load, size_t catalogue,
                  const std::function<Conclusion(const Conclusion&, size_t)>& without);

}  // namespace loopwright::diagnosis
