/// The user's diagram as the general predictor steps it: states from one time stamp to the next, recorded
/// inputs in between, and terms that are added at its sites inside the right-hand side. Where records have
/// values of their own, "set", each is stepped by the diagram with its values.
#pragma once
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>
#include "tools/diagnose/predict/flow_slopes.h"
#include "tools/diagnose/predict/front.h"
#include "tools/diagnose/predict/model_parameter.h"
#include "tools/diagnose/predict/site.h"
#include "tools/diagnose/predict/work.h"
#include "tools/diagnose/record/signal_record.h"
#include "tools/diagnose/search/shape.h"

namespace loopwright {
template <class Real> class Run;
}

namespace loopwright::diagnosis {

/// A signal of the diagram on which a term may depend, or the difference of two states of one unit.
struct SiteVariable {
  std::string name;
  Number number = -1, minus = -1;  ///< minus: the state that is subtracted; -1: none
  std::optional<Unit> unit;
  Quantity quantity = Quantity::other;
  bool is_state = false;
  bool is_of_sensor = false;  ///< only its sensor can depend on it

  double at(const double* numbers) const {
    return minus < 0 ? numbers[number] : numbers[number] - numbers[minus];
  }
};

/// How a variable relates to a site.
enum class Nearness { unusable, far, near };

/// An effect at a site: Σ coefficient · column(variable; nonlinear).
struct SiteTerm {
  const TermShape* shape = nullptr;
  int site = -1;
  int variable = -1;  ///< -1: a constant
  std::array<double, most_columns> coefficient{};
  std::array<double, most_nonlinear> nonlinear{};
  std::array<double, most_nonlinear> low{}, high{};  ///< limits of the shape's own parameters
  std::array<double, most_columns> unit{};           ///< a coefficient of notable effect, for differences

  void columns(double signal, double* to) const { shape->evaluate(signal, nonlinear.data(), to); }
  double value(double signal) const {
    if (shape->value) return shape->value(signal, nonlinear.data(), coefficient.data());
    double column[most_columns], sum = 0;
    columns(signal, column);
    for (int i = 0; i < shape->columns; ++i) sum += coefficient[size_t(i)] * column[i];
    return sum;
  }
};

/// What the term's block of a site adds: read by its block inside every evaluation.
struct SiteSignal {
  double held = 0;                         ///< over a sample
  double ramp = 0, begin = 0, length = 1;  ///< from -ramp to ramp within [begin, begin + length] s
  std::vector<std::pair<SiteTerm, SiteVariable>> terms;
  const double* numbers = nullptr;  ///< of the run
  int remembering = -1;             ///< the law with a memory, of which a site has one at most
  double memory = 0, since = 0;     ///< what it remembers at this time in s
  double signal = 0;                ///< of that law, at the same time

  double value(double time) const {
    double sum = held;
    if (ramp != 0) sum += ramp * (2 * (time - begin) / length - 1);
    for (size_t t = 0; t < terms.size(); ++t) {
      const auto& [term, variable] = terms[t];
      sum += int(t) == remembering ? term.coefficient[0] * remembered(time)
                                   : term.value(term.variable < 0 ? 0 : variable.at(numbers));
    }
    return sum;
  }
  /// What its law remembers at this time, if its signal has changed evenly.
  double remembered(double time) const {
    const auto& [term, variable] = terms[size_t(remembering)];
    const double now = variable.at(numbers), passed = time - since;
    return passed > 0 ? term.shape->remembered(memory, signal, now, passed, term.nonlinear.data()) : memory;
  }
  /// From here on it changes evenly again. Turns within a step count: they are where the force changes most.
  void go_on(double time) {
    if (remembering < 0) return;
    memory = remembered(time), since = time;
    signal = terms[size_t(remembering)].second.at(numbers);
  }
};

class SiteModel {
 public:
  /// Throws InputError with every problem of diagram and experiments, which drive and compare the same ports.
  SiteModel(const std::string& diagram, const std::vector<std::string>& experiments,
            const LoadOptions& options);
  ~SiteModel();
  /// Another one that supposes the same, for another thread. What it computes is counted by itself.
  std::unique_ptr<SiteModel> another() const;
  /// How often something else was supposed about an input: one that was copied before supposes less.
  size_t suppositions() const { return suppositions_; }

  const SignalRecord& record() const { return record_; }
  const Plan& plan() const { return *plan_; }
  const std::vector<Site>& sites() const { return sites_; }
  const std::vector<SiteVariable>& variables() const { return variables_; }
  const std::vector<ModelParameter>& parameters() const { return parameters_; }
  Nearness nearness(int site, int variable) const {
    return nearness_[size_t(site) * variables_.size() + size_t(variable)];
  }
  /// The variable that is the site's own signal; -1 at a Sum.
  int own_variable(int site) const { return own_[size_t(site)]; }
  /// Whether a term at the site accelerates a state directly: noise acts there.
  bool drives_state(int site) const { return drives_state_[size_t(site)]; }
  int states() const;
  int numbers() const;  ///< signals and states
  std::string state_name(int state) const;
  /// The state that is measured by the output; -1: a function of states.
  int measured_state(size_t output) const { return measured_state_[output]; }
  /// The recorded input that acts at the site; -1: none.
  int input_of(int site) const;
  /// What a delay or a lag of a recorded input adds to it.
  InputLines change_of_input(const SiteTerm& term) const;
  /// The output that the site is the sensor of; -1: none.
  int output_of_sensor(int site) const;
  /// Whether a term changes what the output measures.
  bool is_distorted(size_t output) const { return !signals_[sensor_sites_[output]].terms.empty(); }
  /// What was computed along the record.
  Work& work() { return work_; }

  /// What a recorded input does between its rows, in the place of what the experiment states.
  void suppose_between_rows(size_t input, BetweenRows between);

  /// Other values of a recorded input in the place of those of the experiment.
  void suppose_input(size_t input, std::vector<double> values);

  /// Steps of the integration in a sample.
  int substeps() const { return substeps_; }
  void set_substeps(int count) { substeps_ = count; }

  /// Values as factors of the diagram's own, and terms. Takes effect at once; the initial states are those of
  /// the diagram.
  void use(std::span<const double> factors, std::span<const SiteTerm> terms);
  /// Of the record that the row belongs to.
  std::vector<double> initial_states(size_t row);

  /// The states at the next time stamp; false if they become non-finite or a block stops. `middle`: also
  /// those in the middle of the sample. `slopes`: also what small changes lead to, unless a state jumps, a
  /// term has a memory, or a front is on its way.
  bool flow(size_t row, const double* from, double* to, double* middle = nullptr,
            FlowSlopes* slopes = nullptr);
  /// Modes of blocks, such as the state of a relay, change with every flow, look and outputs, and so does
  /// what laws remember: who only tries a way keeps them before and puts them back. In bytes.
  size_t mode_bytes() const { return mode_bytes_; }
  void keep_modes(size_t row, char* to);
  void put_modes_back(size_t row, const char* from);
  /// What is added at a site, over every flow until it is set again.
  void hold(int site, double value);
  double held(int site) const { return signals_[size_t(site)].held; }
  /// What rises there from -ramp to ramp over the sample; 0: nothing.
  void set_ramp(int site, size_t row, double ramp);
  /// All numbers at given states, with the inputs of this row.
  bool look(size_t row, double time, const double* states, double* numbers);
  /// The outputs at these states, with the inputs of this row.
  bool outputs(size_t row, const double* states, double* to);

 private:
  using Experiments = std::vector<std::shared_ptr<const Experiment>>;
  struct Input {
    double *value, *slope, *since;
  };
  struct FrontOfTerm {
    Front front;
    size_t site, term;
  };
  /// The diagram with the values of one record, or of all records alike. A copy has no run yet.
  struct OwnRun {
    explicit OwnRun(std::shared_ptr<const Plan> of);
    OwnRun(const OwnRun& other);
    OwnRun(OwnRun&&) noexcept;
    ~OwnRun();

    std::shared_ptr<const Plan> plan;
    std::unique_ptr<Run<double>> run;
    double* numbers = nullptr;   // the arena's
    std::vector<Input> inputs;   // of the record
    ModelParameters parameters;  // as this record has them
    std::vector<std::span<char>> modes;
  };

  SiteModel(const SiteModel&);  // another() completes it
  void build(const std::string& diagram, const LoadOptions& options, const Experiments& experiments,
             Problems& problems);
  void read_records(const std::vector<std::shared_ptr<const Plan>>& plans, const Experiments& experiments,
                    Problems& problems);
  void add_sensors(const Plan& plan);
  void complete_units(const Plan& stated);
  std::shared_ptr<const Plan> with_site_blocks(const Plan& compiled) const;
  void find_inputs_and_outputs(const Plan& plan, Problems& problems);
  void start(OwnRun& own);
  void share_parameters(const Experiments& experiments);
  void find_variables();
  void find_differences();
  void find_nearness();
  void find_variable_of_sensor(size_t output);
  /// The run of the record that the row belongs to, which the terms at the sites then read.
  OwnRun& run_of(size_t row);
  /// The same, with the inputs of the row.
  OwnRun& driven_at(size_t row);
  void draw_all_lines();
  /// Sites at which nothing is added cost nothing.
  void leave_idle_sites_out();
  /// Of a step of this length, after its slope at the begin (0), the first (1) and the second (2) in its
  /// middle.
  double longest_step(double length, int stage);
  /// One step of the method of Runge and Kutta, shorter where a front is on its way. Its length; 0 if the
  /// model is not finite.
  double step(Run<double>& run, double t, double most, bool ends_at_fronts, double* states);
  /// The derivatives of the right-hand side in the middle of the last step, which began at this time with
  /// these states.
  void linearize_step(Run<double>& run, double t, double length, const double* begin, FlowSlopes& slopes);

  SignalRecord record_;
  std::shared_ptr<const Plan> plan_;  // of the first record; its numbers are those of every one
  std::vector<OwnRun> runs_;          // one, or one for each record
  std::vector<Site> sites_;
  const OwnRun* is_read_ = nullptr;  // by the signals
  std::vector<SiteSignal> signals_;  // one for each site; its blocks point to it
  std::vector<int> site_blocks_;     // in the plan; -1: a sensor
  std::vector<bool> is_idle_;        // sites whose blocks are left out
  std::vector<FrontOfTerm> fronts_;  // of the terms in use
  std::vector<SiteVariable> variables_;
  std::vector<ModelParameter> parameters_;  // as the first record has them
  std::vector<Nearness> nearness_;
  std::vector<int> own_;
  std::vector<bool> drives_state_;
  std::vector<size_t> sensor_sites_;  // of the outputs
  std::vector<InputLines> lines_;     // of the inputs, as they act
  bool has_memory_ = false;           // whether a term in use has one
  bool is_late_ = false;              // whether one of them is not as recorded
  std::vector<Number> outputs_;
  std::vector<int> measured_state_;
  bool has_decisions_ = false, all_are_states_ = true;
  int substeps_ = 2;
  size_t suppositions_ = 0;
  Work work_;
  std::vector<double> slope_[4], stage_, begin_, changed_;
  size_t mode_bytes_ = 0;
};

}  // namespace loopwright::diagnosis
