#ifndef HIDDEN_EFFECTS_WRITE_H
#define HIDDEN_EFFECTS_WRITE_H

#include "scenario.h"

/// Writes the scenario's folder: diagrams of the nominal loop, records, experiments, and the truth.
///   axis.json, controller.json, nominal.json   the nominal model
///   train.csv, train.experiment.json           the record to diagnose
///   held_out.csv, held_out.experiment.json     another motion, new noise; the recorded force drives the axis
///   closed_loop.experiment.json                the same record, the whole loop driven by the reference
///   floor.csv, floor.experiment.json           the same noise on an axis of the true mass that hides nothing
///   truth.json                                 for the judge alone
/// Returns false with a message on stderr if a file cannot be written.
bool scenario_write(const Scenario* scenario, const char* folder);

#endif
