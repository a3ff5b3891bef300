#include "tools/diagnose/search/remembered_runs.h"
#include <algorithm>
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {
namespace {

/// Moves the entry to the end, as the one used last.
template <class Entries> auto& used(Entries& entries, typename Entries::iterator entry) {
  std::rotate(entry, entry + 1, entries.end());
  return entries.back();
}

/// [operations] For a row of the effect alone. A load in a gap decides at every row where it is.
double work_of(const Candidate& candidate) {
  return candidate.flies ? Work::of_a_flight : Work::of_an_effect;
}

}  // namespace

std::vector<uint64_t> RememberedRuns::identities(const Motion& motion) {
  std::vector<uint64_t> paths;
  for (const auto& path : motion.paths) paths.push_back(path->identity);
  return paths;
}

bool RememberedRuns::may_change(const std::vector<uint64_t>& paths) {
  return std::ranges::find(paths, uint64_t(0)) != paths.end();
}

RememberedRuns::Question RememberedRuns::question_of(const Trials& trials, const std::vector<Member>& members,
                                                     const Motion& motion, const Noise& noise) {
  Question question;
  for (const Member& member : members) {
    question.candidates.push_back(member.candidate);
    for (const auto* values : {&member.linear, &member.nonlinear})
      question.numbers.insert(question.numbers.end(), values->begin(), values->end());
  }
  question.numbers.insert(question.numbers.end(), {noise.white, noise.step, noise.memory});
  question.numbers.insert(question.numbers.end(), noise.measurement.begin(), noise.measurement.end());
  question.paths = identities(motion);
  for (const Trial& trial : trials.list) question.rows.push_back(trial.rows());
  question.rows.push_back(trials.follows_flights);
  return question;
}

Results RememberedRuns::run(Trials& trials, const std::vector<Member>& members, const Motion& motion,
                            const Noise& noise) {
  const auto anew = [&] {
    return std::make_shared<const std::vector<Fitted>>(run_members(trials, members, motion, noise));
  };
  Question question = question_of(trials, members, motion, noise);
  // Without a motion where the noise enters is not yet decided.
  if (question.paths.empty() || may_change(question.paths)) return anew();
  const auto known = std::ranges::find(runs_, question, &Run::question);
  if (known != runs_.end()) return used(runs_, known).results;
  double of_members = 0;
  for (const Member& member : members) of_members += work_of(*member.candidate);
  for (const Trial& trial : trials.list)
    trials.work->add(trial.rows(), Work::of_a_sample + of_members +
                                       double(trial.model->steps_a_sample() - 1) * Work::of_a_step);
  runs_.push_back({std::move(question), anew()});
  for (const Fitted& fitted : *runs_.back().results)
    if (fitted.flying) trials.work->add(fitted.prediction.path.samples(), Work::of_a_flight);
  if (runs_.size() > most_runs) runs_.pop_front();
  return runs_.back().results;
}

std::shared_ptr<const std::vector<Sensitivity>> RememberedRuns::sensitivities(
    const Trials& trials, const std::vector<Member>& members, const Motion& motion, const Results& results) {
  std::vector<FreeParameter> free = free_parameters(members);
  const auto known = std::ranges::find_if(
      sensitive_, [&](const Sensitive& s) { return s.results == results && s.free == free; });
  if (known != sensitive_.end()) return used(sensitive_, known).sensitivities;
  auto list = std::make_shared<std::vector<Sensitivity>>();
  for (size_t t = 0; t < trials.list.size(); ++t) {
    double of_responses = 0;
    for (const FreeParameter& p : free)
      of_responses += Work::of_a_response + work_of(*members[p.member].candidate);
    trials.work->add(trials.list[t].rows(), of_responses);
    const auto flies = [&](const FreeParameter& p) {
      return members[p.member].candidate == (*results)[t].flying;
    };
    trials.work->add(trials.list[t].rows(),
                     double(std::ranges::count_if(free, flies)) * Work::of_a_changed_flight);
    list->push_back(sensitivity(members, *motion.paths[t], (*results)[t], trials.list[t].input));
  }
  keep({results, std::move(free), list});
  return list;
}

Shapes RememberedRuns::shapes(const std::vector<const Candidate*>& candidates, const Motion& motion,
                              const std::function<std::vector<Shape>()>& anew) {
  std::vector<uint64_t> paths = identities(motion);
  const auto known = std::ranges::find_if(
      shaped_, [&](const Shaped& s) { return s.candidates == candidates && s.paths == paths; });
  if (known != shaped_.end() && !may_change(paths)) return used(shaped_, known).shapes;
  if (shaped_.size() == most_shaped)
    shaped_.pop_front();  // their columns are the largest of all that is kept
  shaped_.push_back({candidates, std::move(paths), std::make_shared<const std::vector<Shape>>(anew())});
  return shaped_.back().shapes;
}

size_t RememberedRuns::numbers_of(const Sensitive& sensitive) {
  size_t count = 0;
  for (const Sensitivity& s : *sensitive.sensitivities)
    for (const std::vector<double>& column : s.columns) count += column.size();
  return count;
}

void RememberedRuns::keep(Sensitive sensitive) {
  sensitive_.push_back(std::move(sensitive));
  size_t count = 0, kept = 0;
  while (kept < std::min(most_sensitivities, sensitive_.size())) {
    count += numbers_of(*(sensitive_.rbegin() + std::ptrdiff_t(kept)));
    if (kept > 0 && count > most_numbers) break;
    ++kept;
  }
  sensitive_.erase(sensitive_.begin(), sensitive_.end() - std::ptrdiff_t(kept));
}

}  // namespace loopwright::diagnosis
