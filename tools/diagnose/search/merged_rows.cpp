#include "tools/diagnose/search/merged_rows.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

bool is_late_within(const Trials& trials, const Member& member, double rows) {
  const AxisRecord& record = trials.list.front().model->record();
  return record.is_thinned && is_late_member(member) && member.nonlinear[0] <= rows * record.sample_time;
}

}  // namespace

bool is_blurred(const Trials& trials, const Member& member) {
  return is_late_within(trials, member, criteria::rows_that_blur);
}

bool is_feigned_within_rows(const Trials& trials, const Estimate& estimate, size_t member,
                            const Weight& weight) {
  return weight.force_rms < estimate.noise.white &&
         is_late_within(trials, estimate.members[member], criteria::rows_of_an_answer);
}

}  // namespace loopwright::diagnosis
