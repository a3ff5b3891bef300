#include "write.h"

#include "program.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { SUBSTEPS = 10 };

static bool write_record(const char* folder, const char* name, const Record* record,
                         const Record* true_model) {
  FILE* file = create(folder, name);
  if (!file) return false;
  fprintf(file, "time_s,reference_m,feedforward_N,force_N,position_m%s\n",
          true_model ? ",true_model_position_m" : "");
  for (int k = 0; k < record->count; ++k) {
    fprintf(file, "%.3f,%.9f,%.9g,%.10g,%.9f", record->time_s[k], record->reference_m[k],
            record->feedforward_n[k], record->force_n[k], record->position_m[k]);
    if (true_model) fprintf(file, ",%.9f", true_model->position_m[k]);
    fputc('\n', file);
  }
  return done(file);
}

static bool write_axis(const char* folder, const Physics* nominal) {
  FILE* file = create(folder, "axis.json");
  if (!file) return false;
  const Periodic cogging = nominal->nominal_cogging;
  const bool has_cogging = cogging.amplitude != 0;
  fputs(
      "{\n"
      "  \"loopwright\": 1,\n"
      "  \"title\": \"Axis, as believed\",\n"
      "  \"parameters\": {\n",
      file);
  fprintf(file, "    \"mass\": {\"value\": %.9g, \"unit\": \"kg\"},\n", nominal->mass_kg);
  fprintf(file, "    \"damping\": {\"value\": %.9g, \"unit\": \"N*s/m\"}\n", nominal->damping_n_s_per_m);
  fputs(
      "  },\n"
      "  \"inputs\": {\"force\": {\"unit\": \"N\"}},\n"
      "  \"outputs\": {\n"
      "    \"position\": {\"source\": \"mass.position\", \"unit\": \"m\"},\n"
      "    \"velocity\": {\"source\": \"mass.velocity\", \"unit\": \"m/s\"},\n"
      "    \"net_force\": {\"source\": \"net_force.sum\", \"unit\": \"N\"}\n"
      "  },\n"
      "  \"blocks\": {\n"
      "    \"viscous\": {\"type\": \"ViscousFriction\", \"damping\": \"=damping\", \"in\": {\"velocity\": "
      "\"mass.velocity\"}},\n",
      file);
  if (has_cogging)
    fprintf(file,
            "    \"cogging\": {\"type\": \"CoggingForce\", \"pole_pitch\": %.9g,\n"
            "                \"harmonics\": [{\"order\": 1, \"amplitude\": %.9g, \"phase\": %.9g}],\n"
            "                \"in\": {\"position\": \"mass.position\"}},\n",
            cogging.pitch_m, cogging.amplitude, cogging.phase_rad);
  fprintf(file,
          "    \"net_force\": {\"type\": \"Sum\", \"signs\": \"+-%s\", \"in\": {\"terms\": [\"force\", "
          "\"viscous.force\"%s]}},\n"
          "    \"mass\": {\"type\": \"Mass\", \"mass\": \"=mass\", \"in\": {\"force\": \"net_force.sum\"}}\n"
          "  }\n"
          "}\n",
          has_cogging ? "-" : "", has_cogging ? ", \"cogging.force\"" : "");
  return done(file);
}

/// Each in `unit`.
static void write_coefficients(FILE* file, const double* values, const char* unit) {
  int last = FILTER_ORDER;
  while (last > 0 && values[last] == 0) --last;
  for (int i = 0; i <= last; ++i)
    fprintf(file, "%s{\"value\": %.17g, \"unit\": \"%s\"}", i ? ", " : "[", values[i], unit);
  fputc(']', file);
}

/// `unit`: of the output over that of the input.
static void write_filter(FILE* file, const char* name, const Filter* filter, const char* unit,
                         const char* source) {
  fprintf(file,
          "    \"%s\": {\"type\": \"DiscreteTransferFunction\", \"sample_time\": %g, "
          "\"numerator\": ",
          name, sample_time_s);
  write_coefficients(file, filter->numerator, unit);
  fputs(", \"denominator\": ", file);
  write_coefficients(file, filter->denominator, "1");
  fprintf(file, ", \"in\": {\"u\": \"%s\"}},\n", source);
}

static void write_observer_loop(FILE* file, const Controller* c) {
  write_filter(file, "feedback", &c->feedback, "N/m", "error.sum");
  write_filter(file, "inverse", &c->observer_position, "N/m", "encoder.position");
  fprintf(
      file,
      "    \"previous\": {\"type\": \"UnitDelay\", \"sample_time\": %g, \"in\": {\"u\": \"force.sum\"}},\n",
      sample_time_s);
  write_filter(file, "commanded", &c->observer_command, "1", "previous.y");
  fputs(
      "    \"force\": {\"type\": \"Sum\", \"signs\": \"++-+\",\n"
      "              \"in\": {\"terms\": [\"feedback.y\", \"feedforward\", \"inverse.y\", "
      "\"commanded.y\"]}}\n",
      file);
}

static void write_cascade_loop(FILE* file, const Controller* c) {
  write_filter(file, "velocity", &c->velocity, "1/s", "encoder.position");
  fprintf(file,
          "    \"wanted_velocity\": {\"type\": \"Gain\", \"gain\": {\"value\": %.17g, \"unit\": \"1/s\"}, "
          "\"in\": {\"u\": \"error.sum\"}},\n",
          c->position_gain_per_s);
  fputs(
      "    \"velocity_error\": {\"type\": \"Sum\", \"signs\": \"+-\", \"in\": {\"terms\": "
      "[\"wanted_velocity.y\", \"velocity.y\"]}},\n",
      file);
  fprintf(file,
          "    \"force\": {\"type\": \"Gain\", \"gain\": {\"value\": %.17g, \"unit\": \"N*s/m\"}, "
          "\"in\": {\"u\": \"velocity_error.sum\"}}\n",
          c->velocity_gain_n_s_per_m);
}

static bool write_controller(const char* folder, const Scenario* scenario) {
  FILE* file = create(folder, "controller.json");
  if (!file) return false;
  const Physics* nominal = &scenario->stages[0];
  const Controller c =
      controller_make(scenario->controller, nominal->mass_kg, nominal->damping_n_s_per_m, sample_time_s);
  const bool cascade = scenario->controller == CASCADE;
  fprintf(file,
          "{\n"
          "  \"loopwright\": 1,\n"
          "  \"title\": \"%s\",\n"
          "  \"inputs\": {\"reference\": {\"unit\": \"m\"}%s, \"position\": {\"unit\": \"m\"}},\n"
          "  \"outputs\": {\"force\": {\"source\": \"force.%s\", \"unit\": \"N\"}, \"measured\": "
          "{\"source\": \"encoder.position\", \"unit\": \"m\"}},\n"
          "  \"blocks\": {\n",
          cascade ? "Cascade: position P, velocity P" : "PD, feedforward, disturbance observer",
          cascade ? "" : ", \"feedforward\": {\"unit\": \"N\"}", cascade ? "y" : "sum");
  fprintf(file,
          "    \"encoder\": {\"type\": \"Encoder\", \"sample_time\": %g, \"resolution\": %g, \"in\": "
          "{\"position\": \"position\"}},\n",
          sample_time_s, scenario->noise.resolution_m);
  fputs(
      "    \"error\": {\"type\": \"Sum\", \"signs\": \"+-\", \"in\": {\"terms\": [\"reference\", "
      "\"encoder.position\"]}},\n",
      file);
  (cascade ? write_cascade_loop : write_observer_loop)(file, &c);
  fputs("  }\n}\n", file);
  return done(file);
}

static bool write_nominal(const char* folder, const Scenario* scenario) {
  FILE* file = create(folder, "nominal.json");
  if (!file) return false;
  const bool cascade = scenario->controller == CASCADE;
  fprintf(file,
          "{\n"
          "  \"loopwright\": 1,\n"
          "  \"title\": \"The loop, as believed\",\n"
          "  \"solver\": {\"method\": \"rk4\", \"step\": 0.0001, \"stop\": %.9g, \"record_step\": %g},\n"
          "  \"blocks\": {\n"
          "    \"reference\": {\"type\": \"RecordedColumn\", \"file\": \"train.csv\", \"time\": \"time_s\", "
          "\"column\": \"reference_m\", \"unit\": \"m\", \"sample_time\": %g},\n",
          scenario->motion.stop_s, sample_time_s, sample_time_s);
  if (!cascade)
    fprintf(file,
            "    \"feedforward\": {\"type\": \"RecordedColumn\", \"file\": \"train.csv\", \"time\": "
            "\"time_s\", \"column\": \"feedforward_N\", \"unit\": \"N\", \"sample_time\": %g},\n",
            sample_time_s);
  fprintf(
      file,
      "    \"controller\": {\"diagram\": \"controller.json\",\n"
      "                   \"in\": {\"reference\": \"reference.value\"%s, \"position\": \"axis.position\"}},\n"
      "    \"axis\": {\"diagram\": \"axis.json\", \"in\": {\"force\": \"controller.force\"}}\n"
      "  },\n"
      "  \"log\": [\"reference.value\", \"axis.position\", \"axis.velocity\", \"controller.force\"]\n"
      "}\n",
      cascade ? "" : ", \"feedforward\": \"feedforward.value\"");
  return done(file);
}

/// The axis alone, driven by the recorded force.
static bool write_axis_experiment(const char* folder, const char* record, double resolution_m,
                                  double held_out) {
  char name[256];
  snprintf(name, sizeof name, "%s.experiment.json", record);
  FILE* file = create(folder, name);
  if (!file) return false;
  fprintf(file,
          "{\n"
          "  \"loopwright\": 1,\n"
          "  \"title\": \"The axis driven by the recorded force\",\n"
          "  \"data\": \"%s.csv\", \"time\": \"time_s\",\n"
          "  \"drive\": {\"axis.force\": {\"column\": \"force_N\", \"unit\": \"N\", \"interpolation\": "
          "\"hold\"}},\n"
          "  \"compare\": {\"axis.position\": {\"column\": \"position_m\", \"unit\": \"m\", \"resolution\": "
          "%g}},\n"
          "  \"roles\": {\"position\": \"axis.position\", \"velocity\": \"axis.velocity\", \"force\": "
          "\"axis.net_force\", \"input\": \"axis.force\"}",
          record, resolution_m);
  if (held_out > 0) fprintf(file, ",\n  \"hold_out\": {\"fraction\": %g}", held_out);
  fputs("\n}\n", file);
  return done(file);
}

static bool write_loop_experiment(const char* folder, const Scenario* scenario) {
  FILE* file = create(folder, "closed_loop.experiment.json");
  if (!file) return false;
  const char* feedforward =
      ",\n            \"controller.feedforward\": {\"column\": \"feedforward_N\", \"unit\": \"N\", "
      "\"interpolation\": \"hold\"}";
  fprintf(file,
          "{\n"
          "  \"loopwright\": 1,\n"
          "  \"title\": \"The whole loop driven by the recorded reference\",\n"
          "  \"data\": \"held_out.csv\", \"time\": \"time_s\",\n"
          "  \"drive\": {\"controller.reference\": {\"column\": \"reference_m\", \"unit\": \"m\", "
          "\"interpolation\": \"hold\"}%s},\n"
          "  \"compare\": {\"controller.measured\": {\"column\": \"position_m\", \"unit\": \"m\", "
          "\"resolution\": %g}},\n"
          "  \"roles\": {\"position\": \"axis.position\", \"velocity\": \"axis.velocity\", \"force\": "
          "\"axis.net_force\", \"input\": \"axis.force\"}\n"
          "}\n",
          scenario->controller == CASCADE ? "" : feedforward, scenario->noise.resolution_m);
  return done(file);
}

static double rms_difference(const double* one, const double* other, int count) {
  double sum = 0;
  for (int k = 0; k < count; ++k) sum += (one[k] - other[k]) * (one[k] - other[k]);
  return sqrt(sum / count);
}

static bool write_truth(const char* folder, const Scenario* scenario, double true_model_rmse_m,
                        double nominal_rmse_m) {
  FILE* file = create(folder, "truth.json");
  if (!file) return false;
  const Noise* noise = &scenario->noise;
  fprintf(file,
          "{\n  \"seed\": %llu,\n  \"kind\": \"%s\",\n  \"trajectory\": \"%s\",\n  \"controller\": \"%s\",\n",
          (unsigned long long)scenario->seed, kind_names[scenario->kind],
          trajectory_names[scenario->trajectory], controller_names[scenario->controller]);
  fprintf(file, "  \"duration_s\": %.9g,\n  \"nominal_cogging\": %s,\n  \"effects\": [",
          scenario->motion.stop_s, scenario->stages[0].nominal_cogging.amplitude != 0 ? "true" : "false");
  const char* separator = "";
  for (int i = 0; i < scenario->effect_count; ++i) {
    const Effect effect = scenario->effects[i];
    fprintf(file, "%s\n    {\"effect\": \"%s\", \"own_force_rms_N\": %.6g, ", separator, effect_names[effect],
            scenario->effect_force_n[i]);
    if (effect >= CATALOGUE) fprintf(file, "\"variables\": %s, ", effect_variables(effect));
    fputs("\"parameters\": ", file);
    effect_write(file, effect, scenario_truth(scenario));
    fputc('}', file);
    separator = ",";
  }
  fprintf(file,
          "%s],\n"
          "  \"noise\": {\"white_N\": %.6g, \"coloured_N\": %.6g, \"coloured_s\": %g, \"encoder_m\": %g, "
          "\"resolution_m\": %g},\n"
          "  \"mass_kg\": %.9g,\n"
          "  \"closed_loop_rmse_m\": {\"true_model\": %.6g, \"nominal\": %.6g}\n"
          "}\n",
          scenario->effect_count ? "\n  " : "", noise->white_n, noise->coloured_n, noise->coloured_s,
          noise->encoder_m, noise->resolution_m,
          scenario->stages[0].mass_kg + scenario_truth(scenario)->added_mass_kg, true_model_rmse_m,
          nominal_rmse_m);
  return done(file);
}

static bool write_diagrams(const char* folder, const Scenario* scenario) {
  const double resolution = scenario->noise.resolution_m;
  return write_axis(folder, &scenario->stages[0]) && write_controller(folder, scenario) &&
         write_nominal(folder, scenario) && write_axis_experiment(folder, "train", resolution, 0.25) &&
         write_axis_experiment(folder, "held_out", resolution, 0) &&
         write_axis_experiment(folder, "floor", resolution, 0) && write_loop_experiment(folder, scenario);
}

static bool write_records(const char* folder, const Scenario* scenario) {
  const Physics *truth = scenario_truth(scenario), *nominal = &scenario->stages[0];
  const Noise* noise = &scenario->noise;
  const double resolution = noise->resolution_m;
  Physics heavier = *nominal;
  heavier.added_mass_kg = truth->added_mass_kg;
  Record train = record_make(scenario, truth, &scenario->motion, noise, resolution, "train", SUBSTEPS);
  Record held_out =
      record_make(scenario, truth, &scenario->held_out, noise, resolution, "held out", SUBSTEPS);
  Record true_model = record_make(scenario, truth, &scenario->held_out, NULL, resolution, "none", SUBSTEPS);
  Record believed = record_make(scenario, nominal, &scenario->held_out, NULL, resolution, "none", SUBSTEPS);
  Record bare = record_make(scenario, &heavier, &scenario->held_out, noise, resolution, "held out", SUBSTEPS);
  const double true_model_rmse = rms_difference(held_out.position_m, true_model.position_m, held_out.count);
  const double nominal_rmse = rms_difference(held_out.position_m, believed.position_m, held_out.count);
  const bool good = write_record(folder, "train.csv", &train, NULL) &&
                    write_record(folder, "held_out.csv", &held_out, &true_model) &&
                    write_record(folder, "floor.csv", &bare, NULL) &&
                    write_truth(folder, scenario, true_model_rmse, nominal_rmse);
  Record* records[] = {&train, &held_out, &true_model, &believed, &bare};
  for (int i = 0; i < 5; ++i) record_free(records[i]);
  return good;
}

bool scenario_write(const Scenario* scenario, const char* folder) {
  if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
    fprintf(stderr, "%s: %s\n", folder, strerror(errno));
    return false;
  }
  return write_diagrams(folder, scenario) && write_records(folder, scenario);
}
