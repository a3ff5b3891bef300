/// A diagram advanced from Python, for tests, hardware in the loop and learning.
#include <fmt/format.h>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include "engine/run/fault_text.h"
#include "engine/run/run.h"
#include "models/real/whole.h"
#include "tools/python/diagram.h"
#include "tools/python/interruptible.h"
#include "tools/python/module.h"

namespace loopwright::python {
namespace {

namespace py = pybind11;

/// All mutable numbers at an instant; belongs to the plan of its stepper.
struct Snapshot {
  std::shared_ptr<const Plan> plan;
  Instant now;
  std::vector<char> arena;
};

/// Lets Ctrl-C end a long loop in the thread that runs it: steps are too short for a thread of their own.
class SignalWatch {
 public:
  /// Throws what the signal's handler raised. Called without the interpreter's lock.
  void look() {
    if (++calls_ % calls_between_clocks != 0) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < signal_period) return;
    last_ = now;
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  static constexpr unsigned calls_between_clocks = 256;  // reading the clock costs as much as a small step
  unsigned calls_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Parts of the step as in engine/run/run.h. A stepper stands at a tick after part 3 (signals computed,
/// memory accepted), so that its numbers are those of a row of the recording; the next advance begins with
/// part 4.
class DiagramStepper {
 public:
  DiagramStepper(LoadedDiagram diagram, int64_t number) : diagram_(std::move(diagram)), number_(number) {
    start();
  }

  /// Parameters are structure for some blocks and enter others when these are prepared: the diagram is loaded
  /// again, as for `--set`. Only at the start, because a change on the way would be half a change.
  void set(const std::string& path, const std::string& value) {
    if (run_->now().tick != diagram_.plan->start_tick)
      throw py::value_error(
          "set(\"" + path +
          "\") comes after the first advance; parameters are set at the start: use reset()");
    LoadOptions options = diagram_.options;
    options.set.emplace_back(path, value);
    diagram_ = load(diagram_.path, std::move(options));
    start();
  }
  void reset() { start(); }

  /// Advances by the steps of a run to the tick at this time [s]. Throws std::invalid_argument for a time
  /// between ticks or inside a step, which would need another step than the run's; it then stands at the end
  /// of the step before.
  void advance_to(double time) {
    const int64_t target = tick_at(time);
    const py::gil_scoped_release release;
    SignalWatch signals;
    while (run_->now().tick < target) {
      signals.look();
      const int64_t next = next_tick(target);
      if (next > target)
        throw std::invalid_argument(
            fmt::format("t = {:g} s is inside a step of the solver, from {:g} s to {:g} s", time,
                        run_->now().time, diagram_.plan->clock.time(next)));
      run_->update(due_);
      run_->integrate(next - run_->now().tick);
      compute();
    }
  }
  double time() const { return run_->now().time; }
  void advance(double duration) { advance_to(time() + duration); }

  std::vector<double> numbers(const std::string& port) const {
    const auto found = diagram_.plan->find(port);
    if (found.empty()) throw py::key_error(no_port(port));
    std::vector<double> values;
    for (const Number number : found) values.push_back(run_->number(number));
    return values;
  }
  std::string unit(const std::string& port) const {
    const auto found = diagram_.plan->find(port);
    if (found.empty()) throw py::key_error(no_port(port));
    const auto unit = diagram_.plan->unit_of(found[0]);
    return unit ? to_string(*unit) : "";
  }

  Snapshot snapshot() {
    const auto arena = run_->arena();
    return {diagram_.plan, run_->now(), {arena.begin(), arena.end()}};
  }
  void restore(const Snapshot& snapshot) {
    if (snapshot.plan != diagram_.plan)
      throw py::value_error("the snapshot is of another diagram, or of other parameters");
    std::memcpy(run_->arena().data(), snapshot.arena.data(), snapshot.arena.size());
    run_->restored(snapshot.now);
    due_ = run_->due();
  }

 private:
  void start() {
    const Plan& plan = *diagram_.plan;
    if (plan.states > 0 && !is_fixed_step(plan.method))
      throw py::value_error(std::string("a stepper needs a fixed-step method, and the diagram has ") +
                            std::string(to_name(plan.method)) +
                            ": set solver.method to \"rk4\" and solver.step");
    run_.emplace(plan);
    run_->reset({plan.seed, number_});
    compute();
  }
  /// Parts 1 to 3 at the present tick.
  void compute() {
    due_ = run_->due();
    run_->evaluate(due_, true);
    run_->accept();
    if (run_->failed()) throw std::runtime_error(fault_text(*diagram_.plan, run_->fault(), run_->now().time));
  }
  /// The end of the next step, with the present rows already updated.
  int64_t next_tick(int64_t target) {
    const Plan& plan = *diagram_.plan;
    const int64_t next = plan.steps_between_samples ? run_->now().tick + plan.step_ticks : target;
    return plan.rates.empty() ? next : std::min(next, run_->next_due());
  }
  int64_t tick_at(double time) const {
    const Fraction base = diagram_.plan->clock.base;
    const double ticks = time * double(base.denominator) / double(base.numerator),
                 nearest = std::round(ticks);
    constexpr double least_share = 1e-6,
                     relative_rounding = 1e-14;  // [ticks] of decimal times, and of their sums
    constexpr int64_t most_ticks = int64_t{1} << 53;
    if (!(std::fabs(ticks - nearest) < least_share + relative_rounding * std::fabs(ticks)))
      throw std::invalid_argument(
          fmt::format("t = {:g} s is between the ticks of {:g} s", time, diagram_.plan->clock.time(1)));
    if (nearest < double(run_->now().tick))
      throw std::invalid_argument(
          fmt::format("t = {:g} s is in the past: the stepper is at {:g} s", time, run_->now().time));
    if (nearest > double(most_ticks))
      throw std::invalid_argument(fmt::format("t = {:g} s is further than ticks of {:g} s can be counted",
                                              time, diagram_.plan->clock.time(1)));
    return whole_between<int64_t>(nearest, run_->now().tick, most_ticks);
  }
  std::string no_port(const std::string& port) const {
    std::vector<std::string> names;
    for (const Plan::Port& known : diagram_.plan->ports) names.emplace_back(known.name);
    const std::string nearest = nearest_name(port, names);
    return "there is no port " + port + (nearest.empty() ? "" : "; did you mean " + nearest + "?");
  }

  LoadedDiagram diagram_;
  int64_t number_;
  std::optional<Run<double>> run_;
  uint64_t due_ = 0;
};

}  // namespace

void add_stepper(py::module_& module) {
  py::class_<Snapshot>(module, "Snapshot").def_property_readonly("time", [](const Snapshot& s) {
    return s.now.time;
  });
  py::class_<DiagramStepper>(module, "Stepper")
      .def(py::init<LoadedDiagram, int64_t>(), py::arg("diagram"), py::arg("run"))
      .def_property_readonly("time", &DiagramStepper::time)
      .def("set", &DiagramStepper::set)
      .def("reset", &DiagramStepper::reset)
      .def("advance", &DiagramStepper::advance)
      .def("advance_to", &DiagramStepper::advance_to)
      .def("numbers", &DiagramStepper::numbers)
      .def("unit", &DiagramStepper::unit)
      .def("snapshot", &DiagramStepper::snapshot)
      .def("restore", &DiagramStepper::restore);
}

}  // namespace loopwright::python
