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

using Move = TrackingFigures::Move;

/// "stage.position follows reference.position (guessed …)": named once, in front of what is said about it.
std::string subject(const TrackingFigures& t) { return t.followed.signal; }

std::string event(Move::Kind kind) {
  return kind == Move::Kind::jump   ? "the reference jumps"
         : kind == Move::Kind::stop ? "the reference stops"
                                    : "the start";
}

std::string stay_sentence(const Move& move, const std::string& band) {
  if (!move.settling) return "; it is not within ±" + band + " at the end of the run.";
  if (*move.settling > 0)
    return fmt::format("; it is within ±{} from {} on.", band, shown(move.end + *move.settling, "s"));
  return "; it stays within ±" + band + " throughout.";
}

std::string move_sentence(const Move& move, const std::string& unit) {
  const std::string band = shown(move.band, unit), after = event(move.kind);
  if (move.kind == Move::Kind::stay) return stay_sentence(move, band);
  std::string text =
      move.settling ? fmt::format("; it settles within ±{} {} after {}", band,
                                  *move.settling > 0 ? shown(*move.settling, "s") : "at once", after)
                    : fmt::format("; it has not settled within ±{} by the end of the run, after {}{}", band,
                                  after, move.kind == Move::Kind::start ? "" : " at " + shown(move.end, "s"));
  text += move.overshoot > 0 ? fmt::format(", overshoot {} ({} of the move)", shown(move.overshoot, unit),
                                           percent(move.overshoot / std::abs(move.size)))
                             : ", without overshoot";
  return text + ".";
}

std::string tracking_sentence(const TrackingFigures& t) {
  const std::string& unit = t.followed.unit;
  std::string text = fmt::format("{} follows {}{} with an error of {} rms, at most {} at {}", subject(t),
                                 t.followed.reference, t.is_constant ? ", which is constant," : "",
                                 shown(t.rms, unit), shown(t.greatest, unit), shown(t.at, "s"));
  if (t.move) return text + move_sentence(*t.move, unit);
  return text + (t.is_constant ? "." : "; the reference never comes to rest.");
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
                     share.block, percent(share.share()), percent(share.high), percent(share.low));
}

/// What stands at its limits longest comes first.
std::vector<TimeAtLimit> longest_first(const RunFigures& figures, double worth_telling) {
  std::vector<TimeAtLimit> told;
  for (const TimeAtLimit& share : figures.limits)
    if (share.share() > worth_telling) told.push_back(share);
  std::ranges::stable_sort(told, std::greater(), &TimeAtLimit::share);
  return told;
}

/// One sentence for each; of a long list, what the last ones have in common.
std::vector<std::string> limit_sentences(const RunFigures& figures, double worth_telling) {
  constexpr size_t most = 8;
  std::vector<std::string> sentences;
  const std::vector<TimeAtLimit> told = longest_first(figures, worth_telling);
  for (size_t i = 0; i < std::min(most, told.size()); ++i) sentences.push_back(limit_sentence(told[i]));
  if (told.size() > most)
    sentences.push_back(
        fmt::format("{} further blocks are at their limits, each for no more than {} of the time.",
                    told.size() - most, percent(told[most].share())));
  return sentences;
}

/// Empty if all were watched.
std::string not_watched_sentence(const RunFigures& figures) {
  if (figures.limits_not_watched == 0) return "";
  return fmt::format(
      "Blocks with limits that were not watched: {}. Whether they were at a limit is not known.",
      figures.limits_not_watched);
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
  for (std::string& sentence : limit_sentences(figures, worth_a_warning))
    notices.push_back({Severity::warning, std::move(sentence)});
  if (std::string sentence = not_watched_sentence(figures); !sentence.empty())
    notices.push_back({Severity::note, std::move(sentence)});
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
    const std::string band = "within ±" + shown(t.move->band, t.followed.unit);
    if (t.move->settling)
      add("Settling", *t.move->settling, "s", band);
    else
      key.numbers.push_back({"Settling", "not by the end", "", band});
    if (t.move->kind != Move::Kind::stay)
      add("Overshoot", 100 * t.move->overshoot / std::abs(t.move->size), "%",
          shown(t.move->overshoot, t.followed.unit));
  }
  for (const TimeAtLimit& share : longest_first(figures, -1))
    if (key.numbers.size() < 8) add("At a limit", 100 * share.share(), "%", share.block + ", of the time");
  return key;
}

std::string figures_text(const RunFigures& figures) {
  std::string text;
  for (const TrackingFigures& t : figures.tracking)
    text += fmt::format("  {}{}{}\n", t.grows ? growth_sentence(t) : "", tracking_sentence(t),
                        t.followed.is_guess ? " (a guess from the wires)" : "");
  for (const std::string& name : figures.swinging)
    text += fmt::format("  {} swings more and more: perhaps unstable\n", name);
  for (const std::string& sentence : limit_sentences(figures, 0)) text += "  " + sentence + "\n";
  if (const std::string sentence = not_watched_sentence(figures); !sentence.empty())
    text += "  " + sentence + "\n";
  return text;
}

}  // namespace loopwright
