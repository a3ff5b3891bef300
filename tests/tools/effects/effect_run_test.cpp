#include "tools/effects/effect_run.h"
#include <gtest/gtest.h>
#include <cmath>
#include <set>
#include "tests/engine/written_diagram.h"
#include "tests/tools/effects/axis_sizes.h"

namespace loopwright::effect_run_test {

namespace {

/// A sine motion, sampled, with the force as input.
struct Sampled {
  std::vector<double> position, velocity, acceleration, input;
  Sampled() {
    const double w = 2 * M_PI * 1.3, dt = 1e-3;
    for (int k = 0; k < 3000; ++k) {
      const double t = k * dt;
      position.push_back(0.3 - 0.1 * std::cos(w * t));
      velocity.push_back(0.1 * w * std::sin(w * t));
      acceleration.push_back(0.1 * w * w * std::cos(w * t));
      input.push_back(std::round(20 * std::sin(1.7 * w * t)) / 20);
    }
  }
  RoleSignals signals(bool looks_ahead = false) const {
    return {position, velocity, acceleration, input, input, looks_ahead};
  }
};

std::shared_ptr<const EffectPlan> compiled(const Effect& effect) {
  Problems problems;
  auto plan = compile_effect(effect, {}, axis_sizes(), problems);
  EXPECT_EQ(problems.text(), "");
  return plan;
}

std::vector<double> run(const std::string& name, const std::vector<double>& fitted,
                        const RoleSignals& signals) {
  EffectRun effect(compiled(effect_named(name)));
  for (size_t i = 0; i < fitted.size(); ++i) effect.set(i, fitted[i]);
  std::vector<double> values(signals.rows());
  effect.run(signals, values);
  return values;
}

}  // namespace

TEST(EffectRun, GivesTheMeanForceOverEachSample) {
  const Sampled s;
  const auto force = run("viscous_friction", {2.0}, s.signals(true));
  for (size_t k = 0; k + 1 < force.size(); ++k)
    EXPECT_NEAR(force[k], 2.0 * 0.5 * (s.velocity[k] + s.velocity[k + 1]), 1e-12) << k;
}

/// Within a sample of 20 ms the axis goes 8 mm, faster in the middle than on a straight line of the velocity.
TEST(EffectRun, FollowsAMotionThatIsCurvedWithinASample) {
  RecordSizes sizes = axis_sizes();
  sizes.sample_time = 0.02;
  Problems problems;
  EffectRun cogging(compile_effect(effect_named("cogging"), {}, sizes, problems));
  ASSERT_EQ(problems.text(), "");
  constexpr double pitch = 0.03, x = 0.1, v = 0.4, a = 3, bow = 0.05, T = 0.02;
  cogging.set(0, pitch), cogging.set(1, 1), cogging.set(2, 0);
  const std::vector<double> position{x}, velocity{v}, acceleration{a}, input{0}, bows{bow};
  RoleSignals signals{position, velocity, acceleration, input, input};
  signals.velocity_bow = bows;
  std::vector<double> force(1);
  cogging.run(signals, force);
  double mean = 0;
  constexpr int parts = 1000;
  for (int i = 0; i < parts; ++i) {
    const double u = (i + 0.5) / parts;
    const double way = T * (v * u + a * T * u * u / 2 + bow * u * u * (3 - 2 * u));
    mean += std::sin(2 * M_PI * (x + way) / pitch) / parts;
  }
  EXPECT_NEAR(force[0], mean, 2e-4);
}

TEST(EffectRun, WithoutLookingAheadARowDoesNotKnowTheNext) {
  const Sampled whole;
  for (const Effect& effect : whole_catalogue()) {
    Sampled cut = whole;
    for (auto* column : {&cut.position, &cut.velocity, &cut.acceleration, &cut.input})
      for (size_t k = 1500; k < column->size(); ++k) (*column)[k] += 0.01;
    EffectRun one(compiled(effect)), other(compiled(effect));
    std::vector<double> a(3000), b(3000);
    one.run(whole.signals(), a), other.run(cut.signals(), b);
    EXPECT_TRUE(std::equal(a.begin(), a.begin() + 1500, b.begin())) << effect.name << " " << effect.form;
  }
}

TEST(EffectRun, SetsSideBySideGiveTheBitsOfEachAlone) {
  const Sampled s;
  const RoleSignals signals = s.signals(false);
  const size_t rows = signals.rows();
  for (const char* name : {"presliding_hysteresis", "stribeck_friction", "flexible_mode"}) {
    const auto plan = compiled(effect_named(name));
    EffectRun together(plan, 8), alone(plan);
    const int lanes = std::min(together.lanes(), 8);
    const double start = alone.get(1);
    for (int lane = 0; lane < lanes; ++lane) together.set(1, start * (1 + 0.1 * lane), lane);
    std::vector<double> all(size_t(lanes) * rows), one(rows);
    together.run(signals, rows, all);
    for (int lane = 0; lane < lanes; ++lane) {
      alone.set(1, start * (1 + 0.1 * lane));
      alone.run(signals, one);
      for (size_t k = 0; k < rows; ++k) ASSERT_EQ(all[size_t(lane) * rows + k], one[k]) << name << " " << k;
    }
  }
}

TEST(EffectRun, IsProportionalToItsLinearParameters) {
  const Sampled s;
  for (const Effect& effect : whole_catalogue()) {
    const auto plan = compiled(effect);
    EffectRun effect_run(plan);
    size_t i = 0;
    std::vector<double> sum(s.position.size()), whole(s.position.size()), column(s.position.size());
    for (const EffectParameter& p : effect.parameters) {
      if (!p.is_fitted) continue;
      if (p.is_linear) {
        effect_run.column(s.signals(), i, column);
        for (size_t k = 0; k < sum.size(); ++k) sum[k] += effect_run.get(i) * column[k];
      }
      ++i;
    }
    if (std::ranges::none_of(effect.parameters, &EffectParameter::is_linear)) continue;
    effect_run.run(s.signals(), whole);
    double size = 0;
    for (double v : whole) size = std::max(size, std::abs(v));
    for (size_t k = 0; k < sum.size(); ++k)
      ASSERT_NEAR(whole[k], sum[k], 1e-9 * size + 1e-15) << effect.name << " " << effect.form << " row " << k;
  }
}

TEST(EffectRun, LinearEffectsAreRecognizedAndSuperposeWhatTheyWouldIntegrate) {
  const Sampled s;
  std::set<std::string> linear;
  for (const Effect& effect : whole_catalogue()) {
    const auto plan = compiled(effect);
    if (!plan->is_linear) continue;
    linear.insert(effect.name);
    auto integrated = std::make_shared<EffectPlan>(*plan);
    integrated->is_linear = false;
    std::vector<EffectRun::Output> fast(2), slow(2);
    EffectRun(plan, 2).run(s.signals(), s.position.size(), fast);
    EffectRun one(integrated, 2);
    one.run(s.signals(), s.position.size(), std::span(slow).first(1));
    for (auto part : {&EffectRun::Output::mean, &EffectRun::Output::slope}) {
      double size = 0;
      for (float v : slow[0].*part) size = std::max(size, double(std::abs(v)));
      for (size_t k = 0; k < (slow[0].*part).size(); ++k)
        for (const EffectRun::Output& lane : fast)
          ASSERT_NEAR((lane.*part)[k], (slow[0].*part)[k], 1e-6 * size) << effect.name << " row " << k;
    }
  }
  EXPECT_EQ(linear, (std::set<std::string>{"actuator_lag", "flexible_mode"}));
}

TEST(EffectRun, ALagHasTheExactMeanOfAStaircase) {
  const Sampled s;
  const double time_constant = 2e-3;
  const auto added = run("actuator_lag", {time_constant}, s.signals());
  double force = 0;
  const double left = std::exp(-1e-3 / time_constant);
  for (size_t k = 0; k < added.size(); ++k) {
    const double mean = s.input[k] + (force - s.input[k]) * (1 - left) * time_constant / 1e-3;
    EXPECT_NEAR(added[k], mean - s.input[k], 1e-5) << k;
    force = s.input[k] + (force - s.input[k]) * left;
  }
}

TEST(EffectRun, ADelayAddsWhatComesLateLessWhatIsAsked) {
  const Sampled s;
  const auto added = run("input_delay", {2.25e-3}, s.signals());
  for (size_t k = 3; k < added.size(); ++k)
    EXPECT_NEAR(added[k], 0.75 * s.input[k - 2] + 0.25 * s.input[k - 3] - s.input[k], 1e-12) << k;
}

TEST(EffectRun, AFlexibleLoadIsThatOfTwoMasses) {
  const Sampled s;  // the motor follows the sine; the load swings: x_l'' = w0² (x - x_l) + 2 z w0 (v - v_l)
  const double mass = 0.1, frequency = 12, damping = 0.05;
  const auto force = run("flexible_mode", {mass, frequency, damping}, s.signals(true));
  const double w0 = 2 * M_PI * frequency, w = 2 * M_PI * 1.3;
  double x = s.position[0], v = 0;
  const int fine = 50;
  for (size_t k = 0; k + 1 < force.size(); ++k) {
    double mean = 0;
    for (int i = 0; i < fine; ++i) {
      const double h = 1e-3 / fine, t = double(k) * 1e-3 + i * h;
      const auto pull = [&](double at, double xl, double vl) {
        return w0 * w0 * (0.3 - 0.1 * std::cos(w * at) - xl) +
               2 * damping * w0 * (0.1 * w * std::sin(w * at) - vl);
      };
      const double a = pull(t, x, v), xm = x + 0.5 * h * v, vm = v + 0.5 * h * a,
                   am = pull(t + 0.5 * h, xm, vm);
      mean += (mass * am - mass * 0.1 * w * w * std::cos(w * (t + 0.5 * h))) / fine;
      x += h * vm, v += h * am;
    }
    ASSERT_NEAR(force[k], mean, 2e-5) << k;
  }
}

TEST(EffectRun, RefusesToRunWithoutWhatItReads) {
  const Sampled s;
  EffectRun effect(compiled(effect_named("cogging")));
  std::vector<double> values(10);
  EXPECT_THROW(effect.run({{}, s.velocity, {}, {}, {}, false}, values), std::invalid_argument);
}

/// One more file adds an effect to the catalogue: here a bump at one position of the track.
TEST(EffectFile, AFurtherEffectIsOneMoreFile) {
  DiagramFolder folder;
  folder.with("bump.json", R"json({
    "loopwright": 1, "effect": "bump", "title": "A bump on the track", "physics": "Dirt or a joint between two rails.",
    "parameters": {
      "height": {"unit": "$force", "linear": true, "range": ["=-3*force_level", "=3*force_level"], "start": "=0.1*force_level"},
      "place":  {"unit": "$position", "range": ["=lowest_position", "=highest_position"], "start": "=lowest_position + 0.5*stroke"},
      "width":  {"unit": "$position", "scale": "logarithmic", "range": ["=0.002*stroke", "=0.2*stroke"], "start": "=0.02*stroke"}},
    "blocks": {
      "centre": {"type": "Constant", "value": "=place"},
      "offset": {"type": "Sum", "signs": "+-", "in": {"terms": ["position", "centre.y"]}},
      "scaled": {"type": "Gain", "gain": "=1/width", "in": {"u": "offset.sum"}},
      "shape":  {"type": "Expression", "formula": "exp(-s^2/2)", "names": ["s"], "in": {"arguments": ["scaled.y"]}},
      "force":  {"type": "Gain", "gain": "=height", "in": {"u": "shape.y"}}},
    "attach": [{"to": "force", "from": "force.y"}],
    "needs": {"text": "motion over the place"}})json");
  Problems problems;
  const auto effects = load_catalogue({catalogue_folder(), folder.path("")}, problems);
  const auto bump = std::ranges::find(effects, "bump", &Effect::name);
  ASSERT_NE(bump, effects.end()) << problems.text();
  EffectRun effect(compiled(*bump));
  effect.set(0, 2), effect.set(1, 0.35), effect.set(2, 0.01);
  const Sampled s;
  std::vector<double> force(s.position.size());
  effect.run(s.signals(true), force);
  for (size_t k = 1; k + 1 < force.size(); ++k) {
    const double middle = 0.5 * (s.position[k] + s.position[k + 1]), d = (middle - 0.35) / 0.01;
    EXPECT_NEAR(force[k], 2 * std::exp(-d * d / 2), 2e-3) << k;
  }
}

TEST(EffectFile, EveryMistakeIsToldAtItsPlace) {
  DiagramFolder folder;
  folder.with("wrong.json", R"({
  "loopwright": 1, "effect": "wrong", "title": "Wrong", "physics": "Nothing.",
  "parameters": {
    "level": {"unit": "$force", "linear": true, "range": [0, "=3*stroke"], "start": 0.1},
    "speed": {"unit": "$position/s", "range": ["=0.1*top_sped", 2], "start": 1},
    "width": {"unit": "$position", "range": [2, 1], "start": 1}
  },
  "blocks": {"drag": {"type": "QuadraticDrag", "drag": "=level", "in": {"velocity": "velocty"}}},
  "attach": [{"to": "forse", "from": "drag.force"}, {"to": "force", "from": "darg.force"},
             {"to": "input", "stage": "comand", "from": "drag.force"},
             {"to": "force", "from": "drag.force", "slope": "drga.slope"}],
  "needs": {"text": "", "direction": 2},
  "extra": 1
})");
  Problems problems;
  EXPECT_TRUE(load_effect(folder.path("wrong.json"), problems).empty());
  const std::string text = problems.text();
  for (const char* part :
       {"4:62: error: the expression has another unit", "there is no size \"top_sped\"",
        "did you mean \"top_speed\"?", "the range is empty", "did you mean \"velocity\"?",
        "did you mean \"force\"?", "did you mean \"drag\"?", "did you mean \"directions\"?",
        "did you mean \"command\"?", "\"drga.slope\" is no output", "/extra", "10 errors"})
    EXPECT_TRUE(has(text, part)) << part << "\n" << text;
}

TEST(EffectFile, EveryKeyOfAnAttachmentHasAMeaningThere) {
  DiagramFolder folder;
  folder.with("wrong.json", R"({
  "loopwright": 1, "effect": "wrong", "title": "Wrong", "physics": "Nothing.",
  "parameters": {"level": {"unit": "$force", "value": true}},
  "blocks": {"drag": {"type": "QuadraticDrag", "drag": 1, "in": {"velocity": "velocity"}}},
  "attach": [{"to": "force", "from": "drag.force", "add": "=level"}],
  "needs": {"text": ""}
})");
  Problems problems;
  EXPECT_TRUE(load_effect(folder.path("wrong.json"), problems).empty());
  EXPECT_TRUE(has(problems.text(), "an attachment to the force has no key \"add\"")) << problems.text();
  EXPECT_TRUE(has(problems.text(), "\"value\" is of the wrong kind")) << problems.text();
}

/// For an effect file that can be read, but does not compile.
std::string compile_problems(const std::string& path) {
  Problems problems;
  const auto effects = load_effect(path, problems);
  EXPECT_EQ(effects.size(), 1u) << problems.text();
  for (const Effect& effect : effects) EXPECT_FALSE(compile_effect(effect, {}, axis_sizes(), problems));
  return problems.text();
}

TEST(EffectFile, BlocksAreCheckedAsThoseOfADiagram) {
  DiagramFolder folder;
  folder.with("wrong.json", R"({
  "loopwright": 1, "effect": "wrong", "title": "Wrong", "physics": "Nothing.",
  "parameters": {"level": {"unit": "$force", "linear": true, "range": [0, 1], "start": 0.1}},
  "blocks": {"drag": {"type": "QuadraticDarg", "drag": "=level", "in": {"velocity": "velocity"}}},
  "attach": [{"to": "force", "from": "drag.force"}], "needs": {"text": ""}
})");
  const std::string text = compile_problems(folder.path("wrong.json"));
  EXPECT_TRUE(has(text, "wrong.json:4:31")) << text;
  EXPECT_TRUE(has(text, "did you mean \"QuadraticDrag\"?")) << text;
}

TEST(EffectFile, ASlopeIsAnOutputThatIsThere) {
  DiagramFolder folder;
  folder.with("late.json", R"({
  "loopwright": 1, "effect": "late", "title": "Late", "physics": "A detour.",
  "parameters": {"delay": {"unit": "s", "range": [0, "=3*sample_time"], "start": "=sample_time"}},
  "blocks": {"late": {"type": "FractionalDelay", "delay": "=delay", "sample_time": "=sample_time", "in": {"u": "input"}}},
  "attach": [{"to": "input", "from": "late.y", "slope": "late.slop"}], "needs": {"text": ""}
})");
  const std::string text = compile_problems(folder.path("late.json"));
  EXPECT_TRUE(has(text, "late.json:5:14")) << text;
  EXPECT_TRUE(has(text, "\"late.slop\"")) << text;
}

TEST(EffectFile, AFixedPitchIsNoLongerFitted) {
  Effect cogging = effect_named("cogging");
  fix(cogging, "pitch", 0.0225);
  const auto plan = compiled(cogging);
  EXPECT_EQ(plan->fitted, (std::vector<std::string>{"sine", "cosine"}));
}

/// 12 ∫ (u - ½) f(u) du: the slope of the straight line with the same first moment.
template <class F> double slope_of(F&& f) {
  double sum = 0;
  for (int i = 0; i < 1000; ++i) sum += ((i + 0.5) / 1000 - 0.5) * f((i + 0.5) / 1000);
  return 12 * sum / 1000;
}

TEST(EffectRun, GivesTheSlopeOfAForceThatSwingsWithinASample) {
  EffectRun cogging(compiled(effect_named("cogging")));
  const double pitch = 0.005, speed = 1, step = 1e-3 * speed / pitch * 2 * M_PI;  // rad a sample
  cogging.set(0, pitch), cogging.set(1, 0.3), cogging.set(2, 0);
  std::vector<double> position, velocity(200, speed), none(200, 0.0);
  for (int k = 0; k < 200; ++k) position.push_back(0.1 + 1e-3 * speed * k);
  EffectRun::Output output;
  cogging.run({position, velocity, none, none, none}, 200, {&output, 1});
  for (int k = 0; k < 200; ++k) {
    const double start = 2 * M_PI * position[size_t(k)] / pitch;
    const double slope = slope_of([&](double u) { return 0.3 * std::sin(start + step * u); });
    EXPECT_NEAR(double(output.slope[size_t(k)]), slope, 0.05 * 0.3 * step) << k;
  }
}

/// It is read at an instant: what it is within the sample moves nothing.
TEST(EffectRun, AnErrorOfTheSensorHasNoSlope) {
  EffectRun error(compiled(effect_named("encoder_periodic_error")));
  error.set(0, 0.005), error.set(1, 1e-6), error.set(2, 1e-6);
  const Sampled s;
  EffectRun::Output output;
  error.run(s.signals(true), s.position.size(), {&output, 1});
  EXPECT_GT(std::ranges::max(output.mean), 1e-6F);
  EXPECT_EQ(std::ranges::max(output.slope), 0);
  EXPECT_EQ(std::ranges::min(output.slope), 0);
}

TEST(EffectRun, AnEffectWithStatesHasItsSlopeFromTheIntegral) {
  EffectRun lag(compiled(effect_named("actuator_lag")));
  const double time_constant = 0.002, step = 1e-3 / time_constant;
  lag.set(0, time_constant);
  std::vector<double> input(50, 0.0), none(50, 0.0);
  for (size_t k = 20; k < 50; ++k) input[k] = 2;
  EffectRun::Output output;
  lag.run({none, none, none, input, input}, 50, {&output, 1});
  for (int k = 20; k < 50; ++k) {
    const double missing = -2 * std::exp(-step * (k - 20));
    const double slope = slope_of([&](double u) { return missing * std::exp(-step * u); });
    EXPECT_NEAR(double(output.slope[size_t(k)]), slope, 0.08 * slope) << k;
  }
  EXPECT_EQ(output.slope[19], 0);
}

TEST(EffectRun, ADelayByPartOfASampleHasTheSlopeOfItsLateStaircase) {
  EffectRun delay(compiled(effect_named("input_delay")));
  delay.set(0, 0.00225);
  std::vector<double> input(50, 0.0), none(50, 0.0);
  for (size_t k = 20; k < 50; ++k) input[k] = 2;
  EffectRun::Output output;
  delay.run({none, none, none, input, input}, 50, {&output, 1});
  for (size_t k = 0; k < 50; ++k) {
    const double slope = k == 22 ? slope_of([](double u) { return u < 0.25 ? 0.0 : 2.0; }) : 0;
    EXPECT_NEAR(double(output.slope[k]), slope, 1e-5) << k;
  }
}

}  // namespace loopwright::effect_run_test
