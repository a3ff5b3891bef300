/// A flat diagram: the methods of the blocks with their times and numbers. Immutable; shared by runs and
/// threads.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "engine/block/registry.h"
#include "engine/diagram/diagram.h"
#include "engine/plan/identity.h"
#include "engine/plan/ticks.h"
#include "engine/plan/wires_without_unit.h"
#include "engine/solve/method.h"

namespace loopwright {

/// The index of one number in the arena of a run: signals first, then continuous states.
using Number = int32_t;

/// How often a call is made: constants once, continuous at every stage, otherwise every `period` ticks from
/// `offset` on.
struct Rate {
  enum class Kind : uint8_t { constant, sampled, continuous };
  Kind kind = Kind::constant;
  int64_t period = 0, offset = 0;
  bool operator==(const Rate&) const = default;
  /// For a sampled rate: whether the tick is a sample.
  bool is_due(int64_t tick) const { return tick >= offset && (tick - offset) % period == 0; }
};

struct Plan {
  /// Storage for blocks and ports, as contiguous lists: thousands of small vectors would be scattered over
  /// memory.
  struct Lists {
    std::vector<Number> inputs, outputs;               ///< of all blocks
    std::vector<std::span<const Number>> input_ports;  ///< of all blocks, pointing into the inputs
    std::vector<int> output_lengths, buffer_lengths;   ///< of all blocks
    std::vector<std::optional<Unit>> output_units;     ///< of all blocks
    std::string port_names;
    std::vector<Number> port_numbers;
    std::vector<std::shared_ptr<const BlockType>> instance_types;  ///< of blocks with ports of their own
  };

  /// Decides when the blocks of a subdiagram run.
  struct Gate {
    int block = -1;             ///< the Enable block
    Number on = -1;             ///< above one half: they run
    int parent = -1;            ///< the gate of the diagram around it; -1: none
    bool is_triggered = false;  ///< they run at single samples: its own, or those of a gate around it
    bool is_edge = false;       ///< it is triggered itself
    std::vector<int> restarts;  ///< blocks that start anew when it is switched on
    std::string key;            ///< "enabled_by" or "triggered_by"
    Place place;                ///< of the key
  };

  /// One block on scalars; a block wired with vectors of n elements occurs n times.
  struct Block {
    std::string path;  ///< "stage.friction", "gain[2]"
    const BlockType* type = nullptr;
    std::shared_ptr<const void> value;                ///< the scalar block with the parameters of the file
    Place place;                                      ///< of its name in the file
    int64_t period = 0, offset = 0;                   ///< ticks; period 0: not sampled
    double sample_time = 0;                           ///< s; 0: not sampled
    std::span<const std::span<const Number>> inputs;  ///< one span for each port
    std::span<const Number> outputs;                  ///< the first number of each port
    std::span<const int> output_lengths;
    std::span<const std::optional<Unit>> output_units;  ///< nothing: could not be determined
    int first_state = 0, states = 0;
    int first_crossing = 0;
    int first_buffer = 0;  ///< as an offset from the start of the buffers
    std::span<const int> buffer_lengths;
    int gate = -1;  ///< that decides when it runs; -1: always
  };

  /// One entry of the order: a group of outputs of a block, its decision, or an algebraic loop to be solved.
  struct Entry {
    enum class Kind : uint8_t { outputs, decide, algebraic_loop };
    Kind kind = Kind::outputs;
    int block = -1;  ///< or the algebraic loop
    int group = 0;
    Rate rate;
    bool in_stages = false;   ///< a derivative needs it
    bool for_events = false;  ///< a crossing function needs it
  };

  /// An algebraic loop (a cycle of blocks with direct feedthrough), solved by Newton's method for the tear
  /// numbers.
  struct AlgebraicLoop {
    std::vector<Entry> entries;  ///< in order, with known tears
    std::vector<Number> tears;
    std::string text;  ///< the loop port by port, for messages
  };

  struct Crossing {
    int block;
    std::string_view name;
    loopwright::Crossing direction;
  };

  struct Logged {
    std::string name;  ///< column name
    Unit unit;
    bool unit_is_known = false;
    Number number;
    Rate rate;
  };

  /// A port of a block or a subdiagram with its full path.
  struct Port {
    std::string_view name;
    std::span<const Number> numbers;
  };

  std::string title;
  std::shared_ptr<const Lists> lists;  ///< shared by copies of the plan
  std::vector<Block> blocks;
  std::vector<Gate> gates;
  std::vector<Entry> order;  ///< every output and decision in order of evaluation
  std::vector<AlgebraicLoop> algebraic_loops;
  std::vector<Rate> rates;  ///< the distinct sampled rates
  std::vector<Crossing> crossings;
  std::vector<Logged> log;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< effective values: path → value with unit
  std::vector<std::pair<Number, double>> unwired;               ///< unwired optional inputs and their values

  TickClock clock;
  int64_t start_tick = 0, stop_tick = 0;
  int64_t step_ticks = 0;    ///< of a fixed-step method
  double typical_step = 0;   ///< s; the step, or a suitable fixed step: the reference for short and long
  int64_t record_ticks = 0;  ///< ticks between rows of the recording
  Method method = Method::rk4;
  double relative_tolerance = 1e-6, absolute_tolerance = 1e-9, maximum_step = infinity;
  uint64_t seed = 1;
  Place solver_place;  ///< of "solver" in the file, or of the diagram: for problems of a whole run

  int signals = 0, states = 0, buffer_numbers = 0;
  /// Whether the computation between samples depends on the solver steps: there are states, decisions,
  /// accepted memories or algebraic loops without a sample time.
  bool steps_between_samples = false;
  std::vector<int> block_of_state;
  std::vector<Problem> warnings;
  WiresWithoutUnit without_unit;
  Identity identity;
  std::string hash;  ///< of the identity

  /// The numbers of a port, "stage.position" or "gain.y[2]", also of inputs; empty if there is none.
  std::vector<Number> find(std::string_view port) const;
  /// The unit of the port that computes a number; nothing if it is not known.
  std::optional<Unit> unit_of(Number number) const;
  /// The output that computes a number, as "stage.position".
  std::string name_of(Number number) const;
  /// The block and output that compute a number; {-1, -1} for a constant.
  std::pair<int, int> source_of(Number number) const;
  std::vector<std::pair<int, int>> sources;  ///< block and output of every number
  std::vector<Port> ports;                   ///< sorted by name
};

/// Compiles a loaded diagram. Null when there are errors (all of them are in `problems`).
std::shared_ptr<const Plan> compile(const Diagram& diagram, Problems& problems);

/// Checks a subdiagram on its own: everything that does not depend on the wires into it.
WiresWithoutUnit check_part(const Diagram& diagram, Problems& problems);

/// Loads and compiles; throws InputError with every problem found. Warnings are stored in Plan::warnings.
std::shared_ptr<const Plan> load_plan(const std::string& path, const LoadOptions& options = {});

/// Order, rates, states and algebraic loops as text for the user.
std::string describe(const Plan& plan);

}  // namespace loopwright
