#include "tools/diagnose/search/drifting_position.h"
#include <cmath>
#include "tools/diagnose/search/remaining_force.h"

namespace loopwright::diagnosis {
namespace {

/// [position] So far off that the forces of the diagram would be those that a member adds, over all records;
/// `alike`: the part of its square that they explain.
struct Shift {
  double distance = 0, alike = 0;
};
Shift shift_for(const Trials& trials, const Member& member, double tried) {
  double products = 0, slopes = 0, squares = 0;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Trial& trial = trials.list[t];
    const InverseDynamics& inverse = (*trials.inverse)[t];
    std::vector<double> place = inverse.path.position;
    for (double& x : place) x += tried;
    const std::vector<double> shifted =
        trial.model->net_forces(place, inverse.path.velocity, inverse.path.input, AxisModel::At::mean);
    const Columns columns = member.candidate->columns(inverse.path, member.nonlinear);
    for (size_t k = 0; k < trial.held_out_from; ++k) {
      if (!inverse.motion.counts[k]) continue;
      double added = 0;  // what it consumes is lacking
      for (size_t c = 0; c < columns.size(); ++c) added -= member.linear[c] * double((*columns[c].mean)[k]);
      const double slope = (shifted[k] - inverse.net_force[k]) / tried;
      products += added * slope, slopes += slope * slope, squares += added * added;
    }
  }
  if (!(slopes > 0) || !(squares > 0)) return {};
  return {products / slopes, products * products / (slopes * squares)};
}

}  // namespace

bool is_feigned_by_drift(const Trials& trials, const std::vector<Member>& members, const Noise& noise,
                         size_t member) {
  constexpr double least_alike = 0.8;  // of the square of its force: a finding has a phase of its own
  constexpr double most_deviations = 3;
  const AxisRecord& record = trials.list.front().model->record();
  const bool is_integrated = !trials.has_map() && !record.find("position") && record.find("velocity");
  if (!trials.inverse || !is_integrated || members[member].candidate->acts != Acts::force) return false;
  double rows = 0;
  for (const Trial& trial : trials.list) rows = std::max(rows, double(trial.model->record().rows()));
  const double wanders = most_deviations * noise.measurement.front() * record.sample_time * std::sqrt(rows);
  if (!(wanders > 0)) return false;
  const Shift shift = shift_for(trials, members[member], wanders);
  return shift.alike >= least_alike && std::abs(shift.distance) <= wanders;
}

}  // namespace loopwright::diagnosis
