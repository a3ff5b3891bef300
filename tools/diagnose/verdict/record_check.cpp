/// Faults of records and missing excitation, with their consequences.
#include <fmt/format.h>
#include <algorithm>
#include <iterator>
#include "tools/compare/excitation.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/record/dead_sensor.h"
#include "tools/diagnose/record/two_sensors.h"
#include "tools/diagnose/search/leaps_of_input.h"
#include "tools/diagnose/search/one_direction.h"
#include "tools/diagnose/verdict/verdict.h"
#include "tools/diagnose/wording.h"

namespace loopwright::diagnosis {

std::optional<RecordFinding> too_few_rows(const Trials& trials) {
  const size_t rows = fitted_numbers(trials) / trials.ports();
  if (trials.has_map() || double(rows) >= criteria::least_rows) return {};
  size_t all = 0;
  for (const Trial& trial : trials.list) all += trial.held_out_from;
  return RecordFinding{
      fmt::format("of {} rows that may be fitted, {} count", all, rows),
      fmt::format("no verdict rests on fewer than {}: record faster, longer, or with longer ways between "
                  "reversals; rows at rest and just after a rest or a reversal do not count",
                  criteria::least_rows),
      true};
}

std::optional<RecordFinding> friction_along_the_way(const Trials& trials, const Estimate& estimate) {
  const auto is_of_position = [](const Member& member) {
    return member.candidate->law_of == LawOf::position && !member.candidate->is_unknown;
  };
  const auto member = std::ranges::find_if(estimate.members, is_of_position);
  if (member == estimate.members.end() || trials.has_map() || !goes_one_way(trials, estimate)) return {};
  return RecordFinding{
      "all motion goes one way",
      fmt::format("{} may also be friction that changes along the way: go back over the same way",
                  shown_name(*member->candidate)),
      false, false};
}

RecordFinding readings_are_false(size_t count, std::string consequence) {
  const char* const text = count == 1
                               ? "1 reading is not that of its row: it repeats the one before while the "
                                 "signal moves on, or leaps out and back"
                               : "{} readings are not those of their rows: they repeat the one before "
                                 "while the signal moves on, or leap out and back";
  return {fmt::format(fmt::runtime(text), count), std::move(consequence)};
}

RecordFinding inputs_are_not_felt(size_t count) {
  return {count == 1
              ? "1 value of a recorded input is out of line, and the machine does not feel it"
              : fmt::format("{} values of recorded inputs are out of line, and the machine does not feel "
                            "them",
                            count),
          "what the neighbours say was taken instead"};
}

RecordFinding input_is_logged_late(size_t rows) {
  const char* const plural = rows == 1 ? "" : "s";
  return {
      fmt::format("the machine answers to its recorded input {} row{} before the record has it: the log "
                  "wrote each value {} row{} late, or the diagram delays the input by so much",
                  rows, plural, rows, plural),
      fmt::format("it was read {} of the rows that are used earlier for this diagnosis: state \"rows_late\" "
                  "of its column in \"columns\" of the experiment, in rows of the file, so that compare and "
                  "fit read it so too",
                  rows)};
}

RecordFinding angle_leaps(std::string_view angle, size_t count) {
  return {fmt::format("the measured {} leaps by a turn in {} row{}", angle, count, count == 1 ? "" : "s"),
          "the sensor begins anew at each turn: add up its turns in the column", true};
}

RecordFinding noise_is_loud(double share_of_drive, double shortest_pitch, const MachineUnits& units) {
  return {
      fmt::format("white noise of the force is {:.0f} % of what drives", 100 * share_of_drive),
      fmt::format("what repeats within {}, or changes from row to row, would look like it: move slower, or "
                  "record faster",
                  shown(shortest_pitch, units.position))};
}

RecordFinding too_few_simulations(const FreeRun& run) {
  return {fmt::format("the rows that are simulated hold {} stretches of {}, each without a missing row",
                      run.squares.size(), shown(run.horizon_s, "s")),
          "whether the diagram simulates better with what was found is not known: hold out more, or record "
          "longer"};
}

RecordFinding ended_at_limit(double most_work) {
  return {
      "the search ended at its limit of " + told_operations(most_work),
      "effects that had not been tried are not named, and alternatives may be missing: hold out more, record "
      "less, or state in the diagram what is known"};
}

RecordFinding input_is_noisy(const Trials& trials, const InputCorrection& noise) {
  const double around_s = noise.rows * trials.list.front().model->record().sample_time;
  return {fmt::format("the recorded input has noise that the machine does not feel: without {:.0f} % of its "
                      "changes within {:.3g} ms it explains the motion better than with any delay",
                      100 * noise.share, 1e3 * around_s),
          "they were taken away for this diagnosis: if the command of the controller is known, record that"};
}

namespace {

size_t false_readings(const Trials& trials) {
  size_t count = 0;
  for (const Trial& trial : trials.list) count += trial.model->record().false_readings;
  return count;
}

/// A short time is enough for a fast motion.
bool shows_enough(const Trials& trials, const std::vector<RecordContent>& contents) {
  int reversals = 0;
  for (const RecordContent& content : contents) reversals += content.reversals;
  const double rows = double(fitted_numbers(trials)) / double(trials.ports());
  return rows >= criteria::plenty_of_rows || reversals >= criteria::plenty_of_reversals;
}

/// Faults that the balance of forces shows.
std::vector<RecordFinding> faults_in_balance(const Trials& trials,
                                             const std::vector<InverseDynamics>& inverse) {
  std::vector<ForceResidual> residuals(trials.list.size());
  std::vector<RecordContent> contents;
  std::vector<RecordView> records;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const AxisModel& model = *trials.list[t].model;
    Machine machine;
    machine.motion = inverse[t].motion, machine.mass = model.nominal_inertia();
    residuals[t].value = residual_with(trials.list[t], inverse[t], {});
    const MeasuredPort* position = model.record().find("position");
    contents.push_back(content_of(machine, residuals[t], position ? position->resolution : 0));
  }
  for (size_t t = 0; t < trials.list.size(); ++t)
    records.push_back({inverse[t].motion, residuals[t], contents[t]});
  std::vector<RecordFinding> findings;
  for (const RecordFault& fault : faults_of(records)) {
    if (trials.has_map() && fault.name != "one_direction") continue;  // a map has no times and no speeds
    if (fault.name == "too_short" && shows_enough(trials, contents))
      findings.push_back({fault.text, "shares and noise floor are rough"});
    else
      findings.push_back({fault.text, fault.cost, fault.is_fatal, fault.may_be_physics});
  }
  return findings;
}

/// "the measured angle of third.experiment.json leaps": of several records each has its name.
std::string of_record(const Trials& trials, const Trial& trial) {
  return trials.list.size() > 1 ? " of " + trial.model->record().path : std::string();
}

/// What is wrong with the sensors of one record.
std::vector<RecordFinding> faults_of_sensors(const Trials& trials, const Trial& trial) {
  const AxisRecord& record = trial.model->record();
  const std::string of = of_record(trials, trial);
  std::vector<RecordFinding> findings;
  if (!record.left_out.empty())
    findings.push_back({fmt::format("the {}{} is read less often than what else is measured of the axis",
                                    record.left_out, of),
                        "it was left out: readings of two rates do not count together here"});
  if (const MeasuredPort* position = record.find("position");
      position && !record.is_map && is_noise_alone(position->value))
    findings.push_back(
        {"the measured position" + of + " changes from row to row as much as over the whole record",
         "the sensor shows noise and no motion, and no effect can be named: see that it is "
         "connected, and that its column belongs to this record",
         true});
  if (record.leaps_by_a_turn > 0) findings.push_back(angle_leaps("angle" + of, record.leaps_by_a_turn));
  if (const std::optional<double> ratio = velocity_over_rate(record))
    findings.push_back(
        {fmt::format("the measured velocity{} is {:.4g} times the rate of the measured position", of, *ratio),
         "one of the two has another scale or unit than is stated, or is filtered: what is "
         "named may stand for that",
         true});
  return findings;
}

/// Rows that were put together hide what happens within them.
RecordFinding rows_are_merged(const AxisRecord& record) {
  const double shortest_s = criteria::rows_of_an_answer * record.sample_time;
  return {fmt::format("{} rows of the record became one of {}", record.rows_in_one,
                      shown(record.sample_time, "s")),
          fmt::format("a command that comes late by less than {} is not told, unless its force is above the "
                      "noise: diagnose a part of at most {:.0f} rows",
                      shown(shortest_s, "s"), criteria::most_rows)};
}

}  // namespace

std::vector<RecordFinding> look_at_records(const Trials& trials,
                                           const std::vector<InverseDynamics>& inverse) {
  std::vector<RecordFinding> findings;
  if (const size_t count = false_readings(trials); count > 0)
    findings.push_back(readings_are_false(count, "what their neighbours say was taken instead"));
  if (trials.list.front().model->record().leaps != InputLeaps::felt)
    findings.push_back(inputs_are_not_felt(input_leaps(trials)));
  const AxisRecord& first = trials.list.front().model->record();
  if (first.rows_late > 0) findings.push_back(input_is_logged_late(first.rows_late));
  if (first.rows_in_one > 1) findings.push_back(rows_are_merged(first));
  for (const Trial& trial : trials.list)
    std::ranges::move(faults_of_sensors(trials, trial), std::back_inserter(findings));
  const auto is_driven = [](const Trial& trial) {
    return trial.model->record().is_map || std::ranges::any_of(trial.input, [](double u) { return u != 0; });
  };
  if (std::ranges::none_of(trials.list, is_driven))
    findings.push_back({"the recorded input is zero in every row",
                        "how large any force is cannot be known, and nothing is said about the machine: see "
                        "that its column is the right one, or begin the record with a push",
                        true});
  if (balances_forces(trials, inverse))
    std::ranges::move(faults_in_balance(trials, inverse), std::back_inserter(findings));
  else
    findings.push_back({"most of the motion is too short for the filter of the residual force",
                        "that force is not known, and neither direction, speed nor duration were checked"});
  return findings;
}

}  // namespace loopwright::diagnosis
