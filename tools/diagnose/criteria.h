/// Every number that decides something in the diagnosis, with its unit and its reason. Times are in seconds,
/// or in multiples of a time constant of the predictor (the model's poles under the record's noise); none is
/// a number of rows of the record, so that the same motion recorded faster or slower gets the same answer.
#pragma once
#include <cstddef>
#include "tools/diagnose/criteria_of_sites.h"

namespace loopwright::diagnosis::criteria {

// Rows that count.

/// [s] After the start of a record, or the correction below if that is longer: the first velocity is guessed.
constexpr double settling_s = 0.1;
/// [time constants of the predictor's motion] After a reversal, or an impact. Dry friction changes its sign
/// within a sample or two of it; after five time constants a hundredth of that error is left.
constexpr double correction = 5;
/// [s; rows] Nor less: the controller's answer to the error is over, and three states have been measured.
constexpr double correction_s = 15e-3;
constexpr int least_correction = 3;
/// [s] Memory of a slow force of amplifiers and cables, as the predictor assumes it.
constexpr double slow_memory_s = 0.03;
/// [slow_memory_s] After a rest, at which the slow force is forgotten: e^(-5/3) = 19 % of it is missing then.
constexpr double after_rest = 5.0 / 3;
/// [time constants of the predictor's motion] Nor less than this: at breakaway the velocity is wrong too.
constexpr double correction_after_rest = 10;
/// [rows] The waits above are kept if they leave so many, or a second of motion at a higher rate; otherwise,
/// as in a fast oscillation, each is shortened by the factor until they do.
constexpr double plenty_of_rows = 1000, shorter_wait = 0.7;
/// [top speed] Slower counts as at rest: the sign of friction is not certain there.
constexpr double rest_speed = 0.005;
/// [rows that are used] Of which so many move in the smoothed motion, or that is not the motion of the axis.
constexpr double least_share_in_balance = 0.5;
/// [rows] Fewer fitted rows support no verdict: 40 lags and three noises are estimated from them.
constexpr double least_rows = 200;
/// [rows] Of a longer record, sampled faster than necessary, several rows become one of at most this length
/// [s]: the search runs hundreds of shapes along all of them.
constexpr double most_rows = 120000, thinned_sample_s = 2e-3;
/// [variance] Mean square of the changes from row to row, 2 for noise alone, above which a measured position
/// shows no motion: one of fewer than five rows a period.
constexpr double changes_of_noise = 1.6;
/// [rows] On both sides of a change of sign, where the sign of dry friction is not certain.
constexpr size_t rows_of_a_turn = 1;
/// [mean square] Of rows after reversals that a law explains: hundreds where it sticks or its sensor is loud.
constexpr double most_mean_square_at_reversals = 2;
/// [rest_speed] Friction that falls within fewer of them is not seen after reversals.
constexpr double rest_speeds_of_a_fall = 4;
/// [criterion] Over all rows together, by which another law must do better than the present one.
constexpr double least_gain_at_reversals = 50;
/// [fitted rows] Left out after reversals: a law that differs only there may be the true one.
constexpr double most_hidden_at_turns = 0.3;
/// [reversals] Of a record of less than two seconds, which support a verdict even without plenty_of_rows.
constexpr int plenty_of_reversals = 20;
/// [gain of a late input] By which the other shape may be behind where only a velocity is measured.
constexpr double share_of_controller = 0.15;
/// [rows that stand for several] A delay or a lag of fewer may be the other one; below the second and the
/// noise, a controller's answer within a row: it looks like 0.2 to 1.1 of one.
constexpr double rows_that_blur = 20, rows_of_an_answer = 1.5;

// Steps.
/// [poles of a sample] Sizes after a whole step and after two halves that differ by less: it is short enough.
constexpr double same_pole = 1e-4;
/// [steps in a sample] A pole that would need more has settled within a sample anyway.
constexpr int most_steps_a_sample = 64;
/// [driving force, rms] It changes less from a whole step to two halves unless a fast pole makes it grow.
constexpr double same_driving_force = 0.1;

/// [mean force of the input] By which it changes at least: a share of a force that is all but constant would
/// be smaller than the error of any model.
constexpr double least_change = 0.05;

// Noise.

/// [force of the input, rms] A fiftieth of the smallest material force. If the sensor's counts are the only
/// noise, the force noise would go to zero, and with it every tolerance of the model.
constexpr double least_white_noise = 1e-4;
/// [force of the input, rms] The first guess, and its range during the search: small, so that a missing
/// effect is not taken for noise.
constexpr double usual_white_noise = 0.01, least_search_noise = 0.005, most_search_noise = 0.02;
/// [force of the input, rms] Noise as loud as this is admitted if the errors of the nominal diagram, beside a
/// force that walks at random as missing effects do, are as white: then it is noise. In a louder one a name
/// explains nothing unless the diagram simulates better with it.
constexpr double loud_noise = 0.1, most_portmanteau_of_noise_seen = 120, noise_that_hides = 0.3;
/// [white force] Slow force of an amplifier.
constexpr double usual_slow_noise = 0.3;
/// [white force; density of the white force at zero frequency] A slow force that exceeds both is not noise
/// but something that the model lacks. The second counts where a sample is a large part of its memory: noise
/// of an amplifier has about 5. [s] From one to twice this memory on, with the white force of judged_row_s.
constexpr double most_slow_noise = 0.8, most_slow_density = 15, longest_memory_of_amplifier_s = 0.05;
/// [sample times] A force that is forgotten sooner is noise, however large: the ripple of an amplifier. What
/// a model lacks lasts as long as the motion, of which a record shows more samples.
constexpr double quick_noise = 3;
/// [white force] The slow force that remains when it is counted as white.
constexpr double next_to_no_slow_noise = 0.01;
/// [-2 ln L] What a slow force that counts as white may lose: two parameters that chance fits.
constexpr double most_lost_as_white = 25;
constexpr double noise_reach = 30;  ///< [factor] The likelihood looks for each noise within it of its start.
/// [rows] In a pitch at the top speed: what repeats sooner leaps over the rows, and is noise. Slower parts of
/// the motion show it better.
constexpr double rows_of_shortest_pitch = 1.5;
/// [rows] In a fine pitch at the top speed. It must matter, because many of them fit any noise.
constexpr double rows_of_fine_pitch = 4;
/// [cosine] Input and force push the states in the same direction: noise of one is noise of the other.
constexpr double same_push = 0.99;
constexpr double least_sensor_noise = 1e-9;  ///< [greatest position] Numbers of a record have nine digits.
/// [gain of a late input] Of which an input that is early by as much, or smoothed beside a small one, has
/// more if it has noise that any mean reduces. One that is truly late loses by either.
constexpr double least_gain_of_early_input = 0.5;
/// [its fast changes] Of the input that is taken for noise that the machine does not feel. Less takes nothing
/// away, and something else looks like an input that is early and late.
constexpr double least_unfelt_share = 0.02;

// A sensor whose offset wanders: see search/wandering_sensor.h.

/// [samples] In which it is forgotten: quicker is noise.
constexpr double least_memory_of_offset = 30;
/// [noise of the sensor] Its size, and where the search for it begins.
constexpr double least_offset = 0.1, most_offset = 1e4, first_offsets[] = {3, 50};
/// [-2 ln L] By which it must explain more than a load that moves by itself: the offset has two numbers, a
/// load two or three, so that neither pays for more.
constexpr double least_gain_of_offset = 0;
/// [-2 ln L] The same of errors that nothing explains: many shapes of missing effects use it a little.
constexpr double least_gain_of_offset_alone = 50;

// Whiteness of the prediction errors.

/// [lags] n Σ ρ² over them is near their number if the errors are white.
constexpr size_t portmanteau_lags = 40;
constexpr double portmanteau_lag_s = 1e-3;  ///< errors that are closer are added up first
/// Above it the errors are not white. Counts at a steady speed give up to 170 if no resolution is stated.
constexpr double most_portmanteau = 200;
/// The same while effects are looked for: small ones that are still to come color the errors.
constexpr double most_portmanteau_of_search = 300;
/// The same where nothing is named and the counts are computed from the resolution that is stated, and their
/// part is taken off: beside noise of the force clean records stay below 130. Without such noise they reach
/// 171, and small errors of the law of a large effect give 206.
constexpr double most_portmanteau_of_counted = 150;
/// [of its χ²] A member that owes less than that to counts of the sensor is not feigned by them: a true load
/// beside counts that beat owes 0.2 %.
constexpr double least_feigned_by_counts = 0.01;
/// [rows] Above it a fifth of the squared errors, beside noise, repeats as a vibration does, and is none.
constexpr double most_portmanteau_per_row = 1;
/// The same of the squares of the errors, [rows] and at least: rattling loads have 0.5 to 1.8 a row, right
/// answers 0.42 at most.
constexpr double most_bursts_per_row = 0.45, least_bursts = 500;
/// [portmanteau] That counts alone would make, of a record in which nothing is named: from so much on they
/// may have made all of it, if the force that remains is not material.
constexpr double least_share_of_counts = 0.33;
/// [noise force] That coarse counts leave of what they feign.
constexpr double calmer_force = 0.1;
/// [what counts add] A line of their beat that is a fifth stronger adds half as much again.
constexpr double reach_of_counts = 1.5;
/// [force of the input: rms, or what it exceeds in all but this share of the motion if that is less] Less
/// that remains, below 80 Hz, does not matter: without noise a model's error cannot be judged.
constexpr double negligible_force = 1e-3, usual_share = 0.9;

// Effects.

/// Of the force of an effect, as far as the balance of forces along the smooth motion shows it: 1 if it is
/// there, 0 if it is not, with a bias where a controller answers to noise.
constexpr double least_force_share = 0.3;
/// [force of a load on a spring] Of which the balance, below its 80 Hz, shows enough to speak for or against.
constexpr double least_seen_of_load = 0.5, least_opposed_of_load = 0.05;
/// [standard deviations] By which the share must be below.
constexpr double sure_deviations = 2;
/// [of 80 Hz, or of a tenth of the sampling rate] The slow balance of forces, in which the noise of a sensor
/// is smaller by the square of it. Inputs that are late had shares of 0.8 to 1.2 there, of -0.1 to 4 in
/// faster ones.
constexpr double slower_balance = 16;
/// [force of the input, rms] What is as small in the errors of the predictor may be one of the model.
constexpr double error_of_model = 2.5e-4;
/// [χ² a row] An effect as loud as this is no answer of a controller to noise; and [residual that the noise
/// leaves] its force up to which the motion that it follows may be driven by the noise.
constexpr double loud_wald_per_row = 0.3, noise_that_drives = 2;
/// [residual force] Two sets within this factor balance the forces alike.
constexpr double same_balance = 1.02;
/// [s] Errors further apart are independent.
constexpr double independent_block_s = 0.5;

// Sets of effects, compared by twice the negative log-likelihood with the price of their parameters.

/// [χ²] Five standard deviations; and shares of the rows, below which a model is not exact enough to tell: of
/// certainty, and of a size that needs no large force, because a delay acts only for moments.
constexpr double least_wald = 25, least_wald_per_row = 0.001, plain_wald_per_row = 0.01;
/// [simulation error without it] With an input that is late for sure, beside a controller that answers to
/// noise: such answers made it 1.07 and 1.18.
constexpr double most_worse_by_answers = 1.5;
/// [simulation error without the effect] By which it must fall with each effect where counts color the
/// errors, and with each optional one beside a load that flies.
constexpr double least_help = 0.02;
/// [χ² that errors of counts alone would give] An effect must stand out of it: twice in amplitude.
constexpr double clear_of_counts = 4;
/// [s] Rows that are closer count as parts of one for these shares, and beside the noise of as long a mean: a
/// small error of the model gains with the time of the record, not with its rate.
constexpr double judged_row_s = 1e-3;
/// [force of the input, rms] Of a material effect; and of the part of it that no other effect could replace.
constexpr double least_force = 0.005, least_unique_force = 0.001;
/// [white force] Of a material effect; but beside loud noise one of this share of the driving force [force of
/// the input, rms] matters however small it is beside the noise, if it is certain.
constexpr double least_force_to_noise = 0.25, force_that_matters = 0.01;
/// [thresholds above] A member within this of one of them must do better than noise fitted without it.
constexpr double barely_material = 2;
/// [criterion] What an effect must save, absolutely and for each row: within it sets are alternatives.
constexpr double least_gain = 10, least_gain_per_row = 0.002;
/// [criterion] The same for a function without a name, which adapts itself to small errors of an effect.
constexpr double least_gain_without_name = 20, least_gain_without_name_per_row = 0.1;
/// [criterion] The same where several names depend on the velocity alone, as a wrong law of friction shows.
constexpr double least_gain_over_stacked_names_per_row = 0.02;
/// [-2 ln L] What a function without a name must gain with each level to be fitted with noise of its own, as
/// Akaike's criterion asks; [noise of the force] which it must leave less of: half of the square.
constexpr double least_gain_of_level = 2, most_noise_left = 0.7;
/// [criterion] A set is clearly better; two sets that state the same law of motion differ by the noise alone.
constexpr double clearly_better = 3, same_law = 20;
/// [criterion] Laws of one variable that are promised to lose more than this together are not tried.
constexpr double most_promised_loss_of_laws = 20;
/// [-2 ln L] What a set that contains another one must explain beyond it to be an alternative.
constexpr double least_gain_of_larger_set = 4;
/// [reach of an alternative] Two statements of one law of motion lie closer together: the arithmetic and the
/// noise that each lets through tell them apart, not the law. The one with fewer members stands.
constexpr double reach_of_same_law = 4;
/// [reach of an alternative] A promising set may lose so much on its own motion.
constexpr double most_promised_loss = 20;
constexpr double much_left = 8;  ///< [mean square] The search starts again from functions without a name.
/// [mean square] Below it the shapes that were found are the right ones.
constexpr double well_explained = 1.2;
/// [force of dry friction] A free constant of another member contains it up to this share: what it does as it
/// builds up over a distance, where most rows of a stroke lie behind that.
constexpr double share_beside_constant = 0.05;
/// A delay or a lag replaces a step from 0 to its shape; the step that the errors ask for must be near 1.
constexpr double least_step_to_shape = 0.6, most_step_to_shape = 1.7;
/// An effect is also tried with a shape that differs by more than this factor, beyond what a fit reaches.
constexpr double other_shape = 1.5;
/// [twice the log-likelihood] A smaller gain ends the iterations of a fit.
constexpr double least_step_gain = 0.01;
/// [ln(mean square)] Two models that differ less have the same motion.
constexpr double same_motion = 0.01;
/// [twice the log-likelihood] By which a load on a spring must explain more along the motion that it predicts
/// itself: less are other roundings of the same.
constexpr double least_gain_of_own_motion = 1;
constexpr double most_held_out = 1.5;  ///< [mean square of the fitted rows] the others show something else
/// [range, in logarithms; range] Of a parameter, next to its ends: a fit that is pressed against the end of a
/// logarithmic scale creeps towards it, and an amplitude is cut off there.
constexpr double share_of_end = 1e-3, share_of_linear_end = 1e-6;
/// [probability] Of an effect that ranks among the certain ones.
constexpr double sure = 0.9;

/// [turns] That an angle moves within a row: more may be a turn that its sensor does not count.
constexpr double most_way_within_row = 0.25;

/// [deviation from 1] Two factors that differ by less are one, or by less than this within their intervals.
constexpr double same_factor = 0.03, vague_factor = 0.2;
/// [rms of the forces of the diagram] That mass and damping do not need: less is the error of the smoothed
/// motion.
constexpr double least_other_force = 0.03;

// Two sensors of one axis: see record/two_sensors.h.

/// [s] A stretch whose way both tell: longer than what a tachometer's filter delays, shorter than most
/// strokes.
constexpr double way_s = 0.05;
/// [stretches] Fewer tell nothing.
constexpr size_t least_ways = 20;
/// [of 1; standard errors] By which the velocity must differ from the rate of the position: sensors are
/// better.
constexpr double least_ratio_of_sensors = 0.01, sure_ratio = 6;

// Work: see predict/work.h.

/// [operations] A record of 56 s with one or two effects needs a twentieth of it, one with a load that flies
/// half. Half a minute to a minute of processor time.
constexpr double most_work = 45e9;
/// [operations] The same without roles: one to two minutes. Of a record with three effects in a stiff
/// circuit, the first search needs 37e9.
constexpr double most_work_at_sites = 70e9;
/// [most_work] Used up, the search accepts no further effect; no further rival is compared; from no answer it
/// goes on, which adds the last at most. What was found is fitted, weighed and simulated in any case.
constexpr double work_of_search = 0.6, work_with_rivals = 0.8, work_to_go_on = 1.2, work_going_on = 0.3;
/// [most_work_at_sites] Used up, there is no second search, with all parameters free from its beginning.
constexpr double work_of_first_search = 0.4;

// Rest.

/// [mean square in motion] Errors that the set does not explain occur at rest too.
constexpr double worse_at_rest = 8;
/// [s] Shorter rests contradict no answer: an axis that turns seems to rest, the longer the coarser its
/// counts.
constexpr double least_rest_s = 0.1;
/// [motion of a free axis under noise] Control reduces it; more is motion.
constexpr double least_freedom = 0.4, most_freedom = 3;
/// [s] Enough for a deviation, too little to correct all of it; and enough to average the encoder's steps.
constexpr double deviation_s = 6e-3, glance_s = 36e-3;
/// [counts] That the slowest motion makes within the rows that tell it from a rest: one of them more or less
/// is the sensor's.
constexpr double counts_of_a_rest = 4;

// Impacts of a load that flies through a gap.

/// [of it] What is left of a velocity error after the time of correction.
constexpr double kept_velocity_error = 0.2;
/// [standard deviations] Of the velocity errors that are tried.
constexpr double velocity_errors = 2;
/// [white force] A row at which the force changes by more, because of them, is doubtful.
constexpr double most_doubt = 2;
/// [moving rows] A shape that leaves fewer of them without doubt explains nothing.
constexpr double least_without_doubt = 0.2;
/// [s] Each gives another velocity error.
constexpr double doubt_shifts_s[] = {1, 2};

// Pitches of a rotary axis.

/// [periods] A pitch that drifts further from a whole part of a turn, over the whole record, is another one.
constexpr double most_drift = 0.2;
/// [turns] On less, the next whole number is about as close, and the likelihood decides.
constexpr double nearly_a_turn = 0.9;

// Acceptance by simulation.

/// [time constants of the predictor's motion] Length of a window that is simulated freely. The predictor
/// leaves an error of the measurement after one of them; over fifty, a force that moves nothing else than
/// the noise within one has moved the axis by hundreds of its deviations.
constexpr double horizon = 50;
/// [rows] Nor fewer: an offset and a slope are estimated in each window.
constexpr double least_horizon_rows = 20;
/// [windows] The horizon is shorter if fewer fit into a record: their scatter decides. And too few.
constexpr double plenty_of_windows = 15, least_windows = 3;
/// [steps in a time constant] Of a lag at the input: with less than one in 2.8 the method diverges.
constexpr double steps_in_a_lag = 2;
/// [strokes] A larger error in a window is a divergence: no friction and no stop is that far off.
constexpr double most_strokes = 10;
/// [standard errors] Of the mean difference between windows: chance exceeds it once in a thousand records.
constexpr double worse_deviations = 3;
/// [mean square error] A smaller worsening has no consequence: the parameters' own uncertainty makes as much.
constexpr double least_worsening = 0.01;
/// [noise floor of compare; that of the estimated noise, and the same beside impacts] Above it the residual
/// force is no noise. Impacts that are predicted a moment too late leave up to 5 times the noise; a load with
/// dry friction of its own, which a load of the catalogue has not, 6 to 12 times.
constexpr double most_over_floor = 1.25, far_over_noise = 5, far_over_noise_beside_impacts = 6;
constexpr double most_held_out_force = 1.4;  ///< [residual force of the fitted rows, or noise floor]
/// [input, rms] Of which something must be left: laws that take away nearly all of it follow a machine that
/// does not answer, because its sensor is dead, its drive off, or its time has another unit.
constexpr double least_input_left = 0.02;
/// [input, rms] The same for saturations and dead bands, which beside a smaller mass stand for anything at
/// one speed. A drive that saturates that much follows nothing.
constexpr double least_input_left_by_law = 0.3;
/// [force that is missing, rms] An effect of a set makes no more, unless others cancel it: right ones up
/// to 1.7.
constexpr double most_cancelled = 3;
/// [numbers] Smooth functions of the motion and lines, as compare fits them, have so many levels. They follow
/// that share of the noise of a record that has one independent value in each memory of the slow force.
constexpr double levels_of_smooth_functions = 134;
/// [independent values] A larger share of them leaves no floor to compare with.
constexpr double most_levels = 0.5;
/// [periods of the residual's cut-off frequency] Around a reversal or a rest, where the filter smears the
/// leap of dry friction: a tenth of it is left after one.
constexpr double blur = 1;
/// [force of the input, rms] Excess over it that is material, as an effect of this size is.
constexpr double least_excess = least_force;

// The staircase of effects.

/// [residual force] Of two stages within this factor the one with fewer parameters is shown.
constexpr double same_step = 1.05;
/// [residual force] A correction of the nominal mass or damping that leaves more than this share only trades
/// with effects that are still to come, as damping does with eddy-current drag.
constexpr double least_benefit_of_a_correction = 0.99;
/// [criterion for each row] And one that saves less.
constexpr double least_gain_of_a_correction_per_row = 0.02;
/// [decrease of the error by all effects] Effects at the end that decrease it by less are optional.
constexpr double knee = 0.05;
/// [error of all effects] Unless without it more is left.
constexpr double most_left_by_optional = 2;
/// [decrease of the simulation error by all effects] One that decreases it by more is never optional.
constexpr double most_optional_simulation = 0.5;

// The variables on which the remainder depends.

/// [force that noise alone would leave] Forces that balance better contradict it: an event inflated it.
constexpr double least_residual_of_noise = 0.5;
/// [squared errors of a record] So much within so small a part of its rows is an event.
constexpr double most_of_remainder = 0.8, short_part_of_record = 0.25;
/// [mean square of the remainder] What a function of a variable explains, on blocks to which it was not
/// fitted; and what the direction must explain beyond the position alone.
constexpr double least_dependence = 0.05;
/// [means] Of the remainder; fewer support no function with 40 levels.
constexpr size_t least_remainder = 200;
/// [levels] Of a function of position or time, of velocity, and of acceleration or input, which vary less.
constexpr size_t levels_along = 40, levels_of_velocity = 20, levels_of_acceleration = 12;
/// [parts] Of the blocks, each tested with a function that the others determine.
constexpr size_t folds = 5;

// Sizes of the motion.

/// [s] Speeds and accelerations are differences over such times.
constexpr double speed_span_s = 10e-3, acceleration_span_s = 40e-3;
/// [force that accelerates the mass most] An axis whose driving force is smaller (rms) coasts: the force that
/// slows it down is the size of forces then.
constexpr double least_driving_share = 0.1;
/// [s] The remainder is averaged over such times, and its dependence tested on blocks of the second length.
constexpr double remainder_mean_s = 10e-3, remainder_block_s = 1.25;

}  // namespace loopwright::diagnosis::criteria
