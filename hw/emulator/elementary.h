/* Sine, exponential and similar functions from additions, multiplications and divisions alone. The bits of
 * the C library's functions depend on the processor (with or without fused multiply-add); recorded results
 * must not.
 *
 * Shared with tests/hidden_effects, the other plant in plain C; nothing is shared with the simulator. Errors
 * stay within three units in the last place for ordinary arguments (sine and cosine: below 1e6 rad). */
#ifndef HIL_EMULATOR_ELEMENTARY_H
#define HIL_EMULATOR_ELEMENTARY_H

double sine_of(double x);
double cosine_of(double x);
/* The same bits as both of these, in little more than the time of one. */
void sine_and_cosine_of(double x, double* sine, double* cosine);
double exponential_of(double x);
double hyperbolic_tangent_of(double x);
/* For x >= 0. */
double logarithm_of(double x);
/* x^y for x >= 0; its error grows with |y ln x|. */
double power_of(double x, double y);

#endif
