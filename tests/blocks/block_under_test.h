/// One block on a test bench: read from the registry as by a diagram, run by hand, without plan or solver.
///
///   BlockUnderTest gain("Gain", R"({"gain": 3})");
///   gain.input("u") = 2;
///   gain.evaluate();
///   EXPECT_EQ(gain.output("y"), 6);
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include "engine/block.h"

namespace loopwright {

class BlockUnderTest {
 public:
  /// Reads, checks, prepares and starts the block. Throws std::invalid_argument for a type that is not
  /// registered. If the settings have errors, nothing is prepared: see `problems()`.
  explicit BlockUnderTest(std::string_view type, std::string_view settings = "{}", double sample_time = 0);
  /// The same with a seed, run number and block key; `setup.sample_time` in s.
  BlockUnderTest(std::string_view type, std::string_view settings, const Setup& setup);
  ~BlockUnderTest();
  BlockUnderTest(const BlockUnderTest&) = delete;
  BlockUnderTest& operator=(const BlockUnderTest&) = delete;

  /// With the ports of this instance.
  const BlockInfo& info() const { return own_type_ ? own_type_->info : type_.info; }
  const Problems& problems() const { return problems_; }

  // Wires. An input that was never set reads its default, or 0. An unknown name throws std::invalid_argument.
  double& input(std::string_view name) { return inputs(name).at(0); }
  /// The numbers on a vector port, or one for each wire of a port that accepts several: assign to connect.
  std::vector<double>& inputs(std::string_view name);
  double output(std::string_view name) const { return outputs(name).at(0); }
  const std::vector<double>& outputs(std::string_view name) const;

  // States, by the name of the output that shows the state, or by index.
  double& state(std::string_view output) { return states_.at(state_of(output)); }
  double rate(std::string_view output) const { return rates_.at(state_of(output)); }
  std::vector<double>& states() { return states_; }
  const std::vector<double>& rates() const { return rates_; }
  double crossing(std::string_view name) const;

  // Methods of the block, as the engine calls them. Methods that the block does not have do nothing.
  /// Decides the modes, then computes all outputs.
  void evaluate(double time = 0, int64_t tick = 0);
  /// All outputs with the modes held, as inside a solver step.
  void evaluate_held(double time);
  void decide();
  void derivatives();
  void update();
  void accept();
  /// True if a state changed.
  bool jump();
  void crossings();
  double next_stop(double now) const;
  double shortest_period() const;
  /// The reason of the first fault since the start, or nothing.
  std::string_view fault() const { return fault_.reason; }

  /// Restarts with the present parameters.
  void restart();
  /// Sets a tunable number, "harmonics.0.amplitude", and restarts. Throws std::invalid_argument if there is
  /// none.
  void tune(std::string_view path, double value);

  /// One step of the classical Runge-Kutta method, inputs and modes held, then the step is accepted.
  void step(double duration);
  /// Many equal steps.
  void advance(double duration, int steps);
  /// One sample: outputs at this tick, then the update. The next call is one sample time later.
  double sample(std::string_view input, double value, std::string_view output);

  double time() const { return now_.time; }

  /// Every mutable number, as in a checkpoint of a run.
  struct Snapshot {
    std::vector<double> states;
    std::vector<std::byte> memory, mode;
    std::vector<std::vector<double>> buffers;
    bool operator==(const Snapshot&) const;  ///< bit for bit
  };
  Snapshot snapshot() const;
  void restore(const Snapshot& snapshot);

 private:
  void build(std::string_view settings);
  void connect();
  void compute_outputs();
  void call(Step<double> method);
  size_t input_of(std::string_view name) const;
  size_t output_of(std::string_view name) const;
  size_t state_of(std::string_view output) const;

  const BlockType& type_;
  std::shared_ptr<const BlockType> own_type_;  // null: it has no ports of its own
  Setup setup_;
  Problems problems_;
  std::unique_ptr<std::byte[]> storage_;  // over-allocated, so that block_ can be aligned inside
  void* block_ = nullptr;
  std::vector<std::vector<double>> inputs_, outputs_, buffers_;
  std::vector<std::vector<const double*>> many_;
  std::vector<Port<double>> in_, out_, buffer_wires_;
  std::vector<double> states_, rates_, crossings_;
  std::vector<std::max_align_t> memory_, mode_;
  Instant now_;
  FaultReport fault_;
  Call<double> call_;
};

}  // namespace loopwright
