#include "tools/diagnose/verdict/common_factor.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// What is stated times this is what was found.
struct Factor {
  double value = 1, half_width = 0;  ///< half the 95 % interval
  bool is_moved = false;

  bool is(const Factor& other) const {
    const double moved = std::abs(value - 1);
    return std::abs(value - other.value) <=
           std::max(criteria::same_factor * moved,
                    std::min(half_width + other.half_width, criteria::vague_factor * moved));
  }
};

/// `stated`: the effect adds its first parameter to it.
Factor factor_of(const Diagnosis& d, std::string_view effect, double stated) {
  const auto found = std::ranges::find(d.effects, effect, &DiagnosedEffect::name);
  if (found == d.effects.end() || found->parameters.empty() || !(stated > 0)) return {};
  const DiagnosedParameter& p = found->parameters.front();
  return {1 + p.value / stated, (p.high - p.low) / 2 / stated, true};
}

/// Whether the force that the diagram needs along the record is more than that of its mass and its damping.
bool has_other_forces(const Trials& trials, const std::vector<InverseDynamics>& inverse) {
  double others = 0, all = 0;
  for (size_t t = 0; t < inverse.size(); ++t) {
    const AxisModel& model = *trials.list[t].model;
    const MeasuredMotion& m = inverse[t].motion;
    for (size_t k = 0; k < m.rows(); ++k) {
      if (!m.counts[k]) continue;
      // The net force is that of the input less those of the diagram.
      const double resists = m.force[k] - inverse[t].net_force[k],
                   other = resists - model.nominal_damping() * m.velocity[k];
      others += other * other;
      all += std::pow(resists, 2) + std::pow(model.nominal_inertia() * m.acceleration[k], 2);
    }
  }
  return others > std::pow(criteria::least_other_force, 2) * all;
}

void declare(Diagnosis& result, std::vector<std::string> in_place_of, std::vector<std::string> effects) {
  const auto is_told = [&](const OtherExplanation& other) {
    return other.in_place_of == in_place_of && other.effects == effects;
  };
  if (std::ranges::none_of(result.other_explanations, is_told))
    result.other_explanations.push_back({std::move(in_place_of), std::move(effects)});
}

}  // namespace

void tell_common_factor(const Trials& trials, const std::vector<InverseDynamics>& inverse,
                        Diagnosis& result) {
  const AxisModel& model = *trials.list.front().model;
  const Factor input = factor_of(result, "force_gain", 1),
               mass = factor_of(result, "inertia", model.nominal_inertia()),
               damping = factor_of(result, "viscous_friction", model.nominal_damping());
  const bool is_damped = model.nominal_damping() > 0, has_others = has_other_forces(trials, inverse);
  const bool is_one = mass.is_moved && (damping.is_moved || !is_damped) && (!is_damped || mass.is(damping));
  const auto tell = [&](std::string what, std::string_view same_law, double factor) {
    result.findings.push_back({std::move(what), fmt::format(fmt::runtime(same_law), 1 / factor)});
  };
  if (has_others && input.is_moved && is_one && input.is(mass)) {
    tell(fmt::format("input, mass and damping are {:.3g} times what is stated, all three", input.value),
         "the same law of motion has all of them as stated, and what else the diagram has {:.3g} times "
         "as strong: its friction, drag or spring may be stated wrongly",
         input.value);
  } else if (!has_others && !input.is_moved && is_damped && is_one) {
    declare(result, {"inertia", "viscous_friction"}, {"force_gain"});
    tell(fmt::format("mass and damping are {:.4g} times what is stated, both", mass.value),
         "the same law of motion has both as stated, and the input and all else that is named {:.4g} "
         "times as large: see the unit of the input and its gain",
         mass.value);
  } else if (!has_others && input.is_moved && is_damped && !mass.is_moved && !damping.is_moved) {
    declare(result, {"force_gain"}, {"inertia", "viscous_friction"});
    constexpr double least_of_unit = 0.2;  // off by less, no unit is another one
    const bool may_be_unit = std::abs(input.value - 1) > least_of_unit;
    const std::string same_law =
        "the same law of motion has it as stated, and mass, damping and all else that is named {:.4g} times "
        "as "
        "large: see ";
    tell(fmt::format("the input acts {:.4g} times as strongly as stated", input.value),
         same_law + (may_be_unit ? "its unit, and the gain between input and force"
                                 : "the gain between input and force, and the scale of the sensor"),
         input.value);
  }
}

}  // namespace loopwright::diagnosis
