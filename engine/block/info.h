/// The properties of a block type, independent of the scalar.
#pragma once
#include "engine/block/instance_ports.h"
#include "engine/block/instance_units.h"
#include "engine/block/kernels.h"
#include "engine/block/memory_layout.h"

namespace loopwright {

struct PortInfo {
  /// named: as many scalar ports as the instance declares
  enum class Shape { scalar, vector, many, named };
  std::string_view name, unit, sentence;
  Shape shape = Shape::scalar;
  uint64_t fed_by = 0;       ///< outputs: mask of the inputs that feed through
  int group = -1;            ///< outputs: the call that computes it; -1: it is a state
  int state = -1;            ///< outputs that are states: which state
  int length_of_input = -1;  ///< vector outputs: as long as this input
  bool is_optional = false, joins_vectors = false;
  double otherwise_value = 0;
};
struct CrossingInfo {
  std::string_view name;
  Crossing direction;
};

struct BlockInfo {
  std::string type, sentence, room;  ///< room: the folder of its source, "control"
  std::string source;                ///< path of its source file from the repository root
  std::vector<PortInfo> inputs, outputs;
  std::vector<ParameterInfo> parameters;
  std::vector<CrossingInfo> crossings;
  int buffers = 0, groups = 0, state_vectors = 0, fixed_states = 0;
  bool uses_time = false;  ///< its outputs depend on time
  bool outputs_read_mode = false;
  bool decision_reads_inputs = false;
  bool decides_anew = false;        ///< its decision does not depend on the one before
  bool is_sampled = false;          ///< has discrete memory: requires a sample time
  bool is_continuous = false;       ///< has states, or modes of its own: must not have a sample time
  std::vector<int> memory_numbers;  ///< words of Memory, 8 bytes each, that are numbers; others are indices
  bool lane_wise = true;            ///< a template on the scalar: runs on SIMD lanes
  bool has_side_effects = false;    ///< acts on the external world: never several runs at a time
  void (*read)(void* block, const Value& settings, const std::string& path, Problems&);
  void (*check)(void* block, const Checker&);
  int (*input_length)(const void* block, int input);    ///< -1: any
  int (*output_length)(const void* block, int output);  ///< -1: by length_of_input
  int (*buffer_length)(const void* block, int buffer);
  int (*state_length)(const void* block);  ///< all states, fixed and sized
  bool (*may_cross)(const void* block);    ///< whether its crossings must be monitored; null: always
  double (*next_stop)(const void* block,
                      double now);  ///< the next time at which it is not smooth; null: always smooth
  double (*shortest_period)(const void* block);  ///< s, of a signal that it generates; null: none
  // Units, each null if the description is complete.
  std::vector<UnitClaim> (*unit_claims)(const void* block);
  /// The output is the product of the wires of the first input, each raised to this power.
  double (*unit_power)(const void* block, int wire);
  FormulaUnit (*formula_unit)(const void* block, std::span<const Unit> of_wires);
  // Ports of an instance, each null if there are none.
  std::vector<InstancePort> (*input_ports)(const void* block);
  std::vector<InstancePort> (*output_ports)(const void* block);
};

template <class Entry> constexpr PortInfo::Shape shape_of() {
  using T = typename Entry::Type;
  if constexpr (requires(T t) { t.wire; })
    return PortInfo::Shape::many;
  else if constexpr (requires(T t) { t.port; })
    return PortInfo::Shape::named;
  else if constexpr (requires(T t) { t.data(); })
    return PortInfo::Shape::vector;
  else
    return PortInfo::Shape::scalar;
}
template <class B, class L> int length_of(const B& block, const L& length) {
  if constexpr (std::is_invocable_v<L, const B&>)
    return int(std::invoke(length, block));
  else
    return -1;
}

/// Whether a method of a block has a parameter of this type.
template <class T, class A, class B, class... P> constexpr bool takes(A (B::*)(P...) const) {
  return (std::is_same_v<std::remove_cvref_t<P>, T> || ...);
}

/// B is the scalar block: B<double> or a plain struct.
template <class B> BlockInfo info_of(std::string_view type) {
  BlockInfo info{};
  info.type = type;
  info.sentence = B::describe().sentence;
  State<B> state;
  for_each<B, is_input>([&](auto, const auto& entry) {
    using Entry = std::remove_cvref_t<decltype(entry)>;
    PortInfo port{entry.name, entry.unit, entry.sentence, shape_of<Entry>()};
    port.is_optional = entry.is_optional, port.joins_vectors = entry.joins_vectors,
    port.otherwise_value = entry.otherwise_value;
    info.inputs.push_back(port);
  });
  for_each<B, is_output>([&](auto o, const auto& entry) {
    using Entry = std::remove_cvref_t<decltype(entry)>;
    PortInfo port{entry.name,        entry.unit,        entry.sentence,
                  shape_of<Entry>(), feedthrough<B>[o], group_of_output<B>[o]};
    if constexpr (group_of_output<B>[o] < 0)
      port.state = int((reinterpret_cast<char*>(&(state.*entry.member)) - reinterpret_cast<char*>(&state)) /
                       ptrdiff_t(sizeof(double)));
    for_each<B, is_input>([&](auto i, const auto& in) {
      if (same_member(entry.size, in.member)) port.length_of_input = int(i());
    });
    info.outputs.push_back(port);
  });
  for_each<B, is_crossing>([&](auto, const auto& entry) {
    info.crossings.push_back({entry.name, entry.direction});
  });
  info.parameters = parameters_of<B>();
  info.buffers = int(count_of<B, is_buffer>), info.groups = group_count<B>;
  info.state_vectors = int(count_of<B, is_state_vector>);
  info.fixed_states =
      std::is_same_v<State<B>, None> || info.state_vectors ? 0 : int(sizeof(State<B>) / sizeof(double));
  if constexpr (requires { &B::outputs; }) {
    info.uses_time = takes<Instant>(&B::outputs);
    info.outputs_read_mode = takes<Mode<B>>(&B::outputs);
  }
  if constexpr (requires { &B::decide; }) {
    info.uses_time |= takes<Instant>(&B::decide);
    info.decision_reads_inputs = takes<In<B>>(&B::decide);
  }
  info.is_sampled = requires { &B::update; };
  if constexpr (!std::is_same_v<Memory<B>, None>) info.memory_numbers = number_words<Memory<B>>();
  info.is_continuous = requires { &B::derivatives; }
  || requires { &B::accept; };
  info.decides_anew = decides_anew<B>;
  if constexpr (requires { B::has_side_effects; }) info.has_side_effects = B::has_side_effects;
  info.read = [](void* p, const Value& settings, const std::string& path, Problems& problems) {
    read_fields(*static_cast<B*>(p), settings, path, problems);
  };
  info.check = [](void* p, const Checker& checker) {
    if constexpr (requires(B b) { b.check(checker); }) static_cast<B*>(p)->check(checker);
  };
  info.input_length = [](const void* p, int index) {
    int n = -1;
    for_each<B, is_input>([&](auto i, const auto& e) {
      if (int(i()) == index) n = length_of(*static_cast<const B*>(p), e.size);
    });
    return n;
  };
  info.output_length = [](const void* p, int index) {
    int n = -1;
    for_each<B, is_output>([&](auto o, const auto& e) {
      if (int(o()) == index) n = length_of(*static_cast<const B*>(p), e.size);
    });
    return n;
  };
  info.buffer_length = [](const void* p, int index) {
    int n = 0;
    for_each<B, is_buffer>([&](auto i, const auto& e) {
      if (int(i()) == index) n = int(std::invoke(e.length, *static_cast<const B*>(p)));
    });
    return n;
  };
  info.state_length = [](const void* p) {
    int n = 0;
    for_each<B, is_state_vector>(
        [&](auto, const auto& e) { n += int(std::invoke(e.length, *static_cast<const B*>(p))); });
    if (count_of<B, is_state_vector> == 0 && !std::is_same_v<State<B>, None>)
      n = int(sizeof(State<B>) / sizeof(double));
    return n;
  };
  if constexpr (requires(const B b) { b.may_cross(); })
    info.may_cross = [](const void* p) { return static_cast<const B*>(p)->may_cross(); };
  if constexpr (requires(const B b) { b.next_stop(0.0); })
    info.next_stop = [](const void* p, double now) { return static_cast<const B*>(p)->next_stop(now); };
  if constexpr (requires(const B b) { b.shortest_period(); })
    info.shortest_period = [](const void* p) { return static_cast<const B*>(p)->shortest_period(); };
  if constexpr (requires(const B b) { b.unit_claims(); })
    info.unit_claims = [](const void* p) { return static_cast<const B*>(p)->unit_claims(); };
  if constexpr (requires(const B b) { b.unit_power(0); })
    info.unit_power = [](const void* p, int wire) {
      return double(static_cast<const B*>(p)->unit_power(wire));
    };
  if constexpr (requires(const B b) { b.formula_unit(std::span<const Unit>()); })
    info.formula_unit = [](const void* p, std::span<const Unit> of_wires) {
      return static_cast<const B*>(p)->formula_unit(of_wires);
    };
  if constexpr (requires(const B b) { b.input_ports(); })
    info.input_ports = [](const void* p) { return static_cast<const B*>(p)->input_ports(); };
  if constexpr (requires(const B b) { b.output_ports(); })
    info.output_ports = [](const void* p) { return static_cast<const B*>(p)->output_ports(); };
  return info;
}

}  // namespace loopwright
