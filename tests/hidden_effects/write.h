#ifndef HIDDEN_EFFECTS_WRITE_H
#define HIDDEN_EFFECTS_WRITE_H

#include "scenario.h"

/// Writes the scenario's folder: diagrams of the nominal loop, records, experiments, and what is true.
///   axis.json, controller.json, nominal.json        what the user believes
///   train.csv, train.experiment.json                the record to diagnose
///   held_out.csv, held_out.experiment.json          another motion, new noise: the axis driven by the
///   recorded force closed_loop.experiment.json                     the same record, the whole loop driven by
///   the reference floor.csv, floor.experiment.json                the same noise on an axis that hides
///   nothing, of the true mass truth.json                                      for the judge alone
/// Returns false with a message on stderr when a file cannot be written.
bool scenario_write(const Scenario* scenario, const char* folder);

#endif
