/// Those numbers of criteria.h that decide in a diagram of any kind, without roles.
#pragma once
#include <cstddef>

namespace loopwright::diagnosis::criteria {

// Any diagram.

/// [rms of an output] What it does within the rows of a mean: 12 means a period of a sine. With fewer,
/// straight lines between the means of an input are too coarse.
constexpr double most_averaged_away = 0.15;
/// [readings] A mean needs all of its rows: if more means than these would be missing, none are made.
constexpr double most_missing_of_means = 0.2;
/// n Σ ρ² over 40 lags is near 40 when nothing is left: χ² of 40 degrees of freedom exceeds this once in five
/// thousand outputs. A heat exchanger whose wall is missing, told as four laws, leaves 85.
constexpr double most_portmanteau_of_any_diagram = 80;
/// [resolution / √12] What counts and a little noise leave of predictions and simulations.
constexpr double most_error_of_counts = 1.1;
/// Of a term to the signal at its site, root mean squares. Interpolation between the rows, and steps of the
/// integration, leave this much on a record without noise.
constexpr double least_share_of_site = 1e-3;
/// Of a function without a name to a named law of its signal there, which is smooth as machines may not be.
constexpr double least_share_of_law = 0.02;
/// [of a term to the signal at its site] A smaller one is written into the diagram on request.
constexpr double material_share_of_site = 5e-3;
/// Of a simulated error to the spread of its signal: a record without noise, of another solver or with other
/// steps, agrees as closely as this with the right diagram.
constexpr double error_of_arithmetic = 1e-5;
/// [simulated rms error of the nominal diagram] A simulation with the terms that is worse contradicts them.
constexpr double worse_simulation_of_any_diagram = 1.05;
/// [simulations] Begun anew from the filtered states, over the rows that are judged.
constexpr size_t simulations_of_any_diagram = 10;
/// [of the record] The start, in which the filter settles: 1/20 of it.
constexpr size_t settling_part = 20;
/// [terms] Of one answer.
constexpr size_t most_terms = 5;
/// [criterion] What an added term and an exchange must gain, and within what a rival is declared: chance
/// gains as much once among the some hundred terms that are tried.
constexpr double least_improvement = 10, least_exchange = 3, rival_within = 10;
/// [-2 ln L] What the second of two terms that are ranked together must gain: pairs are many.
constexpr double least_gain_of_second = 40;
/// [-2 ln L] What a late input must gain beyond all parameters, before it is taken by itself.
constexpr double least_gain_over_parameters = 25;
/// [its energy] What must be left of a column after projection: less is the rounding of the responses.
constexpr double least_energy = 2e-3;
/// [of a delay's gain] An input that is held gains as much as the delay, which then is none.
constexpr double share_of_held = 0.9;
/// [nats, beside those of the shape] A variable far from its site, derived from a state, a difference, a sum
/// of what other sites add, an error of a sensor: each is less usual than a state beside its site.
constexpr double of_far = 6, of_derived = 3, of_difference = 2, of_indirect_sum = 3, of_sensor = 3;
/// [signal at its site, rms] Noise held over a sample, as the best predictions ask for. More of it may stand
/// for a missing effect. Machines, heat and tanks have a hundredth.
constexpr double most_process_noise = 0.05;
/// [signal at its site, rms] Slow disturbance that is taken for noise. More of it may stand for a missing
/// effect: those that matter begin at a twentieth.
constexpr double most_slow_disturbance = 0.03;
/// [-2 ln L] Of such a disturbance, which has two numbers.
constexpr double least_gain_of_disturbance = 20;
/// [longest record] The longest time of slow noise.
constexpr double longest_slow_part = 0.1;
/// [sites] Of slow disturbances beside what was found; and beside nothing but parameters, where a missing
/// effect would be taken for several of them.
constexpr size_t most_slow_disturbances = 3, most_first_disturbances = 1;
/// [-2 ln L, and for each reading] By which an input must suit the record better, if it does something else
/// between its rows, before the experiment's statement is questioned: as much as a term must gain.
constexpr double least_gain_of_other_input = 25, least_gain_of_other_input_per_reading = 0.02;
/// [residual force of the nominal diagram] Above it the balance speaks against effects of which none is
/// necessary. Moments of blows that are known roughly made 1.11 of a right one.
constexpr double worse_balance = 1.2;
/// [rows] An input that the log holds late is so by whole rows: 0.04 to 0.11 off where it is, 1 where not.
constexpr double most_beside_a_row = 0.2;
/// [rms error of simulation] An answer by simulation stands only if it leaves at most this of the other's,
/// also over the held-out rows; without them chance has a larger part.
constexpr double better_simulation_held_out = 0.9, better_simulation_without_hold_out = 0.8;
/// [for each term and parameter more] The errors of a simulation are slow: a record of ten of their stretches
/// gives a number a twentieth of them by chance.
constexpr double better_simulation_per_change = 0.95;
/// [of the strongest] Directions of a fit that are weaker are left out.
constexpr double weakest_direction = 1e-7;
/// [of the parameter] Standard deviation of what a diagram states, as a prior of its parameters: they are not
/// off by more than about themselves. Directions that the record does not determine, such as a common scale
/// of mass, damping and gain, then stay where they were stated.
constexpr double deviation_of_stated_parameter = 1;
/// [standard errors] A parameter that is closer to what is stated has not moved: its interval contains it.
constexpr double within_interval = 1.96;
/// [-2 ln L] What a parameter that moved must gain: five standard errors.
constexpr double least_gain_of_parameter = 25;
/// [criterion] An answer that simulates better, but predicts worse by more than this than one that explains
/// all there is, is another motion, not another cause: twice what a term must gain.
constexpr double most_lost_by_simulation = 50;
/// [of the size of a state] By which one of its size grows along the record at most where a free simulation
/// tells anything. An integrator makes hundreds of it; what is chaotic or unstable any number.
constexpr double most_growth = 1e3;
/// [-2 ln L, and for each reading] What a function without a name must gain against a named term.
constexpr double least_gain_of_unknown = 60, least_gain_of_unknown_per_reading = 0.005;
/// [of what unusual names gain] A function without a name that gains this much is what they stand for.
constexpr double least_share_of_function = 0.95;
/// [rms error of the nominal diagram] A simulation that misses by more, and by more than the spread,
/// diverges.
constexpr double diverging_simulation = 10;
/// [rms error] A second opinion whose simulation misses by so much more questions nothing.
constexpr double much_worse_opinion = 5;
/// [noise of the sensor] A simulation that misses its signal by more is driven by something else than what
/// was found; and as many terms and parameters as this together, of which none need be the cause.
constexpr double far_simulation = 5;
constexpr size_t many_changes = 5;
/// So many name nothing, however well they follow the record.
constexpr size_t too_many_changes = 6;
/// [noise of the sensor] A simulation that misses its signal by more needs noise in the states: it is told.
/// What explains all of a record without such noise misses it by 1.0 to 1.1.
constexpr double notable_simulation = 1.3;
/// [variance that noise in the states makes likely] A mean square of ten simulations that is larger is an
/// effect: it comes by chance once in a thousand times (χ² of ten degrees of freedom), and once in a hundred
/// where noise is so slow that few of them are independent.
constexpr double most_noise_of_simulations = 3;
/// [spread of the signal] A diagram that misses a signal by more is no plant that can be simulated by itself.
constexpr double runaway_simulation = 10;
/// [variances] Squares by which a term changes the predictions of held-out rows: from so many on, chance lets
/// these speak against a term that is there once in seven hundred.
constexpr double least_change_of_held_out = 36;
/// [cosine between responses] Beyond it no shape of the catalogue tells two sites apart.
constexpr double alike_responses = 0.98;
/// [rows] A trial term keeps its value as long: effects change about as fast.
constexpr size_t trial_hold = 20;
/// [-2 ln L] By which an answer with fewer numbers, and all parameters as stated, may be behind and is
/// declared: twice what a term must gain to be named.
constexpr double most_lost_by_fewer_changes = 50;
/// [of the parameter] A smaller change is within what data sheets and weighing leave open, and within what an
/// effect without a name does to the parameters that resemble it.
constexpr double small_change_of_parameter = 0.02;

/// [of its mean square] What a function of one signal predicts of a slow disturbance that is an effect, and
/// its levels. Of noise no function does over stretches of a record to which it was not fitted.
constexpr double least_share_of_disturbance = 0.3;
constexpr size_t levels_of_disturbance = 12;

// Which candidates of any diagram are fitted.

/// [of the best gain] By which a candidate may be behind: after its first steps, in which a law that is
/// linear in its coefficients is fitted but for the parameters it bends, and after all. And in -2 ln L: less
/// decides only with the noise of each.
constexpr double behind_after_first_steps = 0.5, behind_after_all_steps = 0.15, least_behind = 30;
/// [of the gain of the term that it would replace] Linearized about the same hypothesis, a smaller gain is
/// one that no fit makes up for.
constexpr double least_share_of_replaced = 0.5;
/// [of a gain] Two that differ less respond alike. [nats] By which the dearer of two such laws is no rival.
constexpr double same_gain = 1e-4, dearer = 5;
/// [of the gain that a term needs] Others do not make up for so much after the first steps without it.
constexpr double far_from_idle = 20;
/// [-2 ln L] A single parameter so far behind the best set, by the quadratic form, is not fitted.
constexpr double hopeless_parameter = 500;

// What else does the same in any diagram.

/// [-2 ln L, and for each reading] What a term must gain.
constexpr double least_gain_of_term = 25, least_gain_of_term_per_reading = 0.002;
/// [of the range of its signal] So close to an end a level up to which a law is zero is a name for a constant
/// and a proportion.
constexpr double edge_of_level = 0.1;
/// [cosine between responses] From it on, a parameter is tried in the place of a term or of parameters: a
/// change of 10 % to 50 % bends its response so much.
constexpr double same_response = 0.9;
/// [of its response] What must be left of that of a parameter beside all that stays.
constexpr double least_own_response = 0.02;
/// [rms about the mean, of the sum] Names of one signal at one site that are so much larger cancel: laws of
/// machines that oppose each other, as Stribeck's and a damping, reach half of it.
constexpr double most_cancelling = 3;

// Dry friction, integrated through its front.

/// [widths] Beyond it the hyperbolic tangent is constant within a thousandth.
constexpr double reach_of_front = 4;
/// [widths] Parts in which a step goes through it.
constexpr double part_of_front = 2;
/// [steps of a sample] A front needs six; one that holds a state needs any number.
constexpr int most_parts_of_fronts = 16;

}  // namespace loopwright::diagnosis::criteria
