#include "tools/run/verdict.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include "tools/report/typography.h"

namespace loopwright {
namespace {

using report::Notice;
using Severity = Notice::Severity;

std::string shown(double value, const std::string& unit) { return report::shown(value, unit, 3); }
std::string percent(double share) { return fmt::format("{:.3g} %", 100 * share); }

/// "stage.position follows reference.position (guessed …)": named once, in front of what is said about it.
std::string subject(const TrackingFigures& t) { return t.followed.signal; }

std::string tracking_sentence(const TrackingFigures& t) {
  const std::string& unit = t.followed.unit;
  std::string text =
      fmt::format("{} follows {} with an error of {} rms, at most {} at {}", subject(t), t.followed.reference,
                  shown(t.rms, unit), shown(t.greatest, unit), shown(t.at, "s"));
  if (!t.move) return text + "; the reference never comes to rest.";
  const auto& move = *t.move;
  text += move.settling
              ? fmt::format("; it settles within ±{} {} after the reference {}", shown(move.band, unit),
                            *move.settling > 0 ? shown(*move.settling, "s") : "at once",
                            move.is_jump ? "jumps" : "stops")
              : fmt::format("; it does not settle within ±{} after the reference {} at {}",
                            shown(move.band, unit), move.is_jump ? "jumps" : "stops", shown(move.end, "s"));
  text += move.overshoot > 0 ? fmt::format(", overshoot {} ({} of the move)", shown(move.overshoot, unit),
                                           percent(move.overshoot / std::abs(move.size)))
                             : ", without overshoot";
  return text + ".";
}

Severity severity(const TrackingFigures& t) {
  if (t.grows) return Severity::error;
  if (t.move && !t.move->settling) return Severity::warning;
  return t.move ? Severity::good : Severity::note;
}

std::string growth_sentence(const TrackingFigures& t) {
  return fmt::format("Unstable: the error of {} grows throughout; it is {} at the end. ", subject(t),
                     shown(std::abs(t.last), t.followed.unit));
}

/// How the run ended, if not at its stop time.
std::optional<Notice> early_end(const RunResult& result) {
  switch (result.status) {
    case RunStatus::finished:
      return std::nullopt;
    case RunStatus::interrupted:
      return Notice{Severity::warning,
                    "The run was " + result.message + "; what was computed until then is shown."};
    case RunStatus::failed:
      break;
  }
  return Notice{Severity::error,
                "The run failed: " + result.message + ". What was computed until then is shown."};
}

std::string guess_sentence(const RunFigures& figures) {
  for (const TrackingFigures& t : figures.tracking)
    if (t.followed.is_guess)
      return " That it is to follow this reference is a guess from the wires; \"figures\" in the diagram "
             "states it.";
  return "";
}

std::string limit_sentence(const TimeAtLimit& share) {
  return fmt::format("{} is at its limits for {} of the time ({} at the upper, {} at the lower one).",
                     share.block, percent(share.low + share.high), percent(share.high), percent(share.low));
}

}  // namespace

RunFigures run_figures(const std::vector<FollowedSignal>& followed, const Recording& recording,
                       std::vector<TimeAtLimit> limits) {
  RunFigures figures;
  figures.limits = std::move(limits);
  for (const FollowedSignal& pair : followed)
    if (auto tracking = tracking_figures(pair, recording)) figures.tracking.push_back(std::move(*tracking));
  if (figures.tracking.empty())
    for (size_t c = 1; c < recording.columns.size(); ++c)
      if (swings_up(recording.columns[c].values)) figures.swinging.push_back(recording.columns[c].name);
  return figures;
}

std::vector<Notice> verdict(const Plan& plan, const RunResult& result, const RunFigures& figures) {
  std::vector<Notice> notices;
  if (auto end = early_end(result)) notices.push_back(std::move(*end));
  std::vector<const TrackingFigures*> by_weight;
  for (const TrackingFigures& t : figures.tracking) by_weight.push_back(&t);
  std::ranges::stable_sort(by_weight, std::greater(),
                           [](const TrackingFigures* t) { return int(severity(*t)); });
  for (const TrackingFigures* t : by_weight)
    notices.push_back({severity(*t), (t->grows ? growth_sentence(*t) : "") + tracking_sentence(*t) +
                                         (t == by_weight.back() ? guess_sentence(figures) : "")});
  if (!figures.swinging.empty()) {
    std::string names;
    for (const std::string& name : figures.swinging) names += (names.empty() ? "" : ", ") + name;
    notices.push_back({Severity::warning, "Perhaps unstable: the swings of " + names +
                                              " grow from quarter to quarter of the run, and do not end."});
  }
  constexpr double worth_a_warning = 0.01;  // of the time
  for (const TimeAtLimit& share : figures.limits)
    if (share.low + share.high > worth_a_warning)
      notices.push_back({Severity::warning, limit_sentence(share)});
  if (figures.tracking.empty() && result.status == RunStatus::finished)
    notices.push_back(
        {Severity::note,
         fmt::format("The run reached its stop time, {:g} s. Which signal is to follow which is not "
                     "known: \"figures\" in the diagram states it, and the run is judged.",
                     plan.clock.time(plan.stop_tick))});
  return notices;
}

report::KeyNumbers key_numbers(const RunFigures& figures) {
  report::KeyNumbers key;
  const auto add = [&](std::string label, double value, const std::string& unit, std::string note) {
    const report::Quantity q = report::engineering(value, unit, 3);
    key.numbers.push_back({std::move(label), q.value, q.unit, std::move(note)});
  };
  constexpr size_t most_pairs = 2;
  for (size_t i = 0; i < std::min(most_pairs, figures.tracking.size()); ++i) {
    const TrackingFigures& t = figures.tracking[i];
    add("Error, rms", t.rms, t.followed.unit, t.followed.signal);
    add("Greatest error", t.greatest, t.followed.unit, "at " + shown(t.at, "s"));
    if (!t.move) continue;
    if (t.move->settling)
      add("Settling", *t.move->settling, "s", "within ±" + shown(t.move->band, t.followed.unit));
    else
      key.numbers.push_back({"Settling", "never", "", "within ±" + shown(t.move->band, t.followed.unit)});
    add("Overshoot", 100 * t.move->overshoot / std::abs(t.move->size), "%",
        shown(t.move->overshoot, t.followed.unit));
  }
  for (const TimeAtLimit& share : figures.limits)
    if (key.numbers.size() < 8)
      add("At a limit", 100 * (share.low + share.high), "%", share.block + ", of the time");
  return key;
}

std::string figures_text(const RunFigures& figures) {
  std::string text;
  for (const TrackingFigures& t : figures.tracking)
    text += fmt::format("  {}{}{}\n", t.grows ? growth_sentence(t) : "", tracking_sentence(t),
                        t.followed.is_guess ? " (a guess from the wires)" : "");
  for (const std::string& name : figures.swinging)
    text += fmt::format("  {} swings more and more: perhaps unstable\n", name);
  for (const TimeAtLimit& share : figures.limits)
    if (share.low + share.high > 0) text += "  " + limit_sentence(share) + "\n";
  return text;
}

}  // namespace loopwright
