/// The constexpr description of a block: a list of entries that point at its members.
///
/// The JSON Schema, the reference page, error texts, unit checks, feedthrough and sweep axes are all derived
/// from this list.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include "engine/solve/ode.h"
#include "models/real/real.h"

namespace loopwright {

/// The time at which a method is called. At a tick it is tick · base period; inside a solver step it lies
/// between ticks.
struct Instant {
  double time = 0;   ///< s
  int64_t tick = 0;  ///< base periods since the start
};

/// A vector-valued port, state or memory: contiguous in the arena of the run.
template <class Real> using Vector = std::span<Real>;

/// An input port that takes any number of scalar wires, "terms": ["a.x", "b.y"].
template <class Real> struct Many {
  const Real* const* wire = nullptr;
  int count = 0;
  LW_INLINE int size() const { return count; }
  LW_INLINE const Real& operator[](int i) const { return *wire[i]; }
};

template <class Real> struct Port;

/// The inputs that an instance declares in its settings (engine/block/instance_ports.h), in their order.
template <class Real> struct NamedInputs {
  const Port<Real>* port = nullptr;
  LW_INLINE const Real& operator[](int i) const { return *port[i].data; }
};
/// The outputs that an instance declares in its settings.
template <class Real> struct NamedOutputs {
  const Port<Real>* port = nullptr;
  LW_INLINE Real& operator[](int i) const { return *port[i].data; }
};

/// The optional result of a method: `return fault_if(in.x <= 0.0, "the logarithm of …");` stops these lanes,
/// the others continue.
struct Fault {
  uint64_t lanes = 0;
  const char* reason = "";
};
LW_INLINE Fault fault_if(bool failed, const char* reason) { return {failed ? 1u : 0u, reason}; }
template <int N, int R> LW_INLINE Fault fault_if(const Mask<N, R>& failed, const char* reason) {
  Fault fault{0, reason};
  for (int i = 0; i < N * R; ++i) fault.lanes |= uint64_t(lane(failed, i)) << i;
  return fault;
}

/// Information for a block before a run starts; `prepare` takes this or only the sample time.
struct Setup {
  double sample_time = 0;  ///< s; 0: continuous
  uint64_t seed = 0;       ///< of the diagram
  int64_t run = 0;         ///< number of the run in a sweep (of the first lane)
  uint64_t block_key = 0;  ///< hash of the block's path: independent random streams
};

inline constexpr double infinity = std::numeric_limits<double>::infinity();
struct None {};

/// The unit of an input that accepts any unit, each wire its own: factors of a product, arguments of an
/// expression.
inline constexpr std::string_view any_unit = "?";

/// A number, flag, text or table from the file. The default is the initializer of the member in the block.
template <class Owner, class T> struct ParameterEntry {
  using Type = T;
  T Owner::*member;
  std::string_view name, unit, sentence;
  double low = -infinity, high = infinity;
  bool low_is_open = false, has_default = false, is_file = false;
  bool is_difference = false, plain_when_bare = false;
  constexpr ParameterEntry positive() const {
    auto p = *this;
    p.low = 0;
    p.low_is_open = true;
    return p;
  }
  constexpr ParameterEntry not_negative() const { return at_least(0); }
  constexpr ParameterEntry at_least(double a) const {
    auto p = *this;
    p.low = a;
    return p;
  }
  constexpr ParameterEntry between(double a, double b) const {
    auto p = *this;
    p.low = a;
    p.high = b;
    return p;
  }
  constexpr ParameterEntry optional() const {
    auto p = *this;
    p.has_default = true;
    return p;
  }
  /// A text that names a file, relative to the file in which it stands; or a list of such texts.
  constexpr ParameterEntry file() const {
    auto p = *this;
    p.is_file = true;
    return p;
  }
  /// For an amplitude, a resolution, a width: of temperatures it accepts K and rejects degC.
  constexpr ParameterEntry difference() const {
    auto p = *this;
    p.is_difference = true;
    return p;
  }
  /// A bare number is dimensionless, so that a bare gain keeps the unit of its input. Without this, a bare
  /// number has the unit that the wires require.
  constexpr ParameterEntry factor() const {
    auto p = *this;
    p.plain_when_bare = true;
    return p;
  }
};

/// An input of the block. An optional input that is not wired reads `otherwise`.
template <class Owner, class T, class Length = None> struct InputEntry {
  using Type = T;
  T Owner::*member;
  std::string_view name, unit, sentence;
  Length size{};
  bool is_optional = false, joins_vectors = false;
  double otherwise_value = 0;
  constexpr InputEntry otherwise(double value) const {
    auto p = *this;
    p.is_optional = true;
    p.otherwise_value = value;
    return p;
  }
  /// Vector wires of a Many port are concatenated. Without this, the block is repeated for each element.
  constexpr InputEntry joins() const {
    auto p = *this;
    p.joins_vectors = true;
    return p;
  }
  template <class L> constexpr auto length(L l) const {
    return InputEntry<Owner, T, L>{member, name,        unit,          sentence,
                                   l,      is_optional, joins_vectors, otherwise_value};
  }
};

/// An output of the block. Every input feeds through to it, unless `.from(…)` lists the inputs.
template <class Owner, class T, class From = void, class Length = None> struct OutputEntry {
  using Type = T;
  T Owner::*member;
  std::string_view name, unit, sentence;
  From fed_by;
  Length size{};
  template <class L> constexpr auto length(L l) const {
    return OutputEntry<Owner, T, From, L>{member, name, unit, sentence, fed_by, l};
  }
};
template <class Owner, class T, class Length> struct OutputEntry<Owner, T, void, Length> {
  using Type = T;
  T Owner::*member;
  std::string_view name, unit, sentence;
  Length size{};
  template <class... I> constexpr auto from(I... inputs) const {
    return OutputEntry<Owner, T, std::tuple<I...>, Length>{
        member, name, unit, sentence, std::tuple<I...>(inputs...), size};
  }
  /// No direct feedthrough: read from state, memory or time.
  constexpr auto from_memory() const { return from(); }
  template <class L> constexpr auto length(L l) const {
    return OutputEntry<Owner, T, void, L>{member, name, unit, sentence, l};
  }
};

/// A part of Memory or State with a given length: a member or a member function of the block.
template <class Owner, class T, class Length> struct Buffer {
  T Owner::*member;
  Length length;
};
template <class Owner, class T, class Length> struct StateVector {
  T Owner::*member;
  Length length;
};

/// A function whose zero crossing is an event.
template <class Owner, class T> struct CrossingEntry {
  T Owner::*member;
  std::string_view name;
  Crossing direction;
};

template <class O, class T>
constexpr ParameterEntry<O, T> parameter(T O::*m, std::string_view name, std::string_view unit,
                                         std::string_view sentence) {
  return {m, name, unit, sentence};
}
template <class O, class T>
constexpr InputEntry<O, T> input(T O::*m, std::string_view name, std::string_view unit,
                                 std::string_view sentence) {
  return {m, name, unit, sentence};
}
template <class O, class T>
constexpr OutputEntry<O, T> output(T O::*m, std::string_view name, std::string_view unit,
                                   std::string_view sentence) {
  return {m, name, unit, sentence};
}
template <class O, class T, class L> constexpr Buffer<O, T, L> buffer(T O::*m, L length) {
  return {m, length};
}
template <class O, class T, class L> constexpr StateVector<O, T, L> state_vector(T O::*m, L length) {
  return {m, length};
}
template <class O, class T>
constexpr CrossingEntry<O, T> crossing(T O::*m, std::string_view name,
                                       Crossing direction = Crossing::either) {
  return {m, name, direction};
}

template <class... E> struct Description {
  std::string_view sentence;
  std::tuple<E...> entries;
};
/// The result of `describe()` of a block.
template <class... E> constexpr Description<E...> block(std::string_view sentence, E... entries) {
  return {sentence, std::tuple<E...>(entries...)};
}
/// The result of `describe()` of a struct inside a parameter.
template <class... E> constexpr Description<E...> fields(E... entries) {
  return {"", std::tuple<E...>(entries...)};
}

template <class> struct is_parameter : std::false_type {};
template <class O, class T> struct is_parameter<ParameterEntry<O, T>> : std::true_type {};
template <class> struct is_input : std::false_type {};
template <class O, class T, class L> struct is_input<InputEntry<O, T, L>> : std::true_type {};
template <class> struct is_output : std::false_type {};
template <class O, class T, class F, class L> struct is_output<OutputEntry<O, T, F, L>> : std::true_type {};
template <class> struct is_buffer : std::false_type {};
template <class O, class T, class L> struct is_buffer<Buffer<O, T, L>> : std::true_type {};
template <class> struct is_state_vector : std::false_type {};
template <class O, class T, class L> struct is_state_vector<StateVector<O, T, L>> : std::true_type {};
template <class> struct is_crossing : std::false_type {};
template <class O, class T> struct is_crossing<CrossingEntry<O, T>> : std::true_type {};

template <class B> inline constexpr auto description = B::describe();

/// f(index among entries of its kind as an integral_constant, entry), for each entry of one kind.
template <class B, template <class> class Is, class F> LW_INLINE constexpr void for_each(F&& f) {
  using Tuple = std::remove_cvref_t<decltype(description<B>.entries)>;
  [&]<size_t... I>(std::index_sequence<I...>) {
    constexpr auto rank = [](size_t i) {
      size_t n = 0, k = 0;
      ((k++ < i && Is<std::remove_cvref_t<std::tuple_element_t<I, Tuple>>>::value ? ++n : n), ...);
      return n;
    };
    (
        [&] {
          if constexpr (Is<std::remove_cvref_t<std::tuple_element_t<I, Tuple>>>::value)
            f(std::integral_constant<size_t, rank(I)>{}, std::get<I>(description<B>.entries));
        }(),
        ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Tuple>>{});
}
template <class B, template <class> class Is>
inline constexpr size_t count_of = [] {
  size_t n = 0;
  for_each<B, Is>([&](auto, auto&) { ++n; });
  return n;
}();

// The nested structs of a block; None if it has none.
template <class B> struct in_of { using type = None; };
template <class B>
requires requires { typename B::In; }
struct in_of<B> {
  using type = typename B::In;
};
template <class B> struct out_of { using type = None; };
template <class B>
requires requires { typename B::Out; }
struct out_of<B> {
  using type = typename B::Out;
};
template <class B> struct state_of { using type = None; };
template <class B>
requires requires { typename B::State; }
struct state_of<B> {
  using type = typename B::State;
};
template <class B> struct memory_of { using type = None; };
template <class B>
requires requires { typename B::Memory; }
struct memory_of<B> {
  using type = typename B::Memory;
};
template <class B> struct mode_of { using type = None; };
template <class B>
requires requires { typename B::Mode; }
struct mode_of<B> {
  using type = typename B::Mode;
};
template <class B> struct crossings_of { using type = None; };
template <class B>
requires requires { typename B::Crossings; }
struct crossings_of<B> {
  using type = typename B::Crossings;
};
template <class B> using In = typename in_of<B>::type;
template <class B> using Out = typename out_of<B>::type;
template <class B> using State = typename state_of<B>::type;
template <class B> using Memory = typename memory_of<B>::type;
template <class B> using Mode = typename mode_of<B>::type;
template <class B> using Crossings = typename crossings_of<B>::type;

/// The scalar twin of a block: B<double> for a template block, itself for a plain struct.
template <class B> struct scalar { using type = B; };
template <template <class> class B, class R> struct scalar<B<R>> { using type = B<double>; };
template <class B> using scalar_of = typename scalar<B>::type;

// Feedthrough: a mask of inputs for each output. Outputs with equal masks form a group with one call.
template <class A, class B> constexpr bool same_member(A a, B b) {
  if constexpr (std::is_same_v<A, B>)
    return a == b;
  else
    return false;
}
template <class B>
inline constexpr auto feedthrough = [] {
  std::array<uint64_t, count_of<B, is_output> + 1> mask{};
  for_each<B, is_output>([&](auto o, const auto& out) {
    if constexpr (requires { out.fed_by; })
      for_each<B, is_input>([&](auto i, const auto& in) {
        std::apply(
            [&](auto... from) { ((same_member(from, in.member) ? mask[o] |= uint64_t(1) << i : 0), ...); },
            out.fed_by);
      });
    else
      mask[o] = (uint64_t(1) << count_of<B, is_input>)-1;
  });
  return mask;
}();
/// -1: an output bound to a state is that state and is never computed.
template <class B>
inline constexpr auto group_of_output = [] {
  std::array<int, count_of<B, is_output> + 1> group{};
  int groups = 0;
  for_each<B, is_output>([&](auto o, const auto& out) {
    if constexpr (requires(State<B> s) { s.*out.member; }) {
      group[o] = -1;
      return;
    }
    for (size_t p = 0; p < o; ++p)
      if (group[p] >= 0 && feedthrough<B>[p] == feedthrough<B>[o]) {
        group[o] = group[p];
        return;
      }
    group[o] = groups++;
  });
  return group;
}();
template <class B>
inline constexpr int group_count = [] {
  int n = 0;
  for (size_t o = 0; o < count_of<B, is_output>; ++o)
    n = group_of_output<B>[o] >= n ? group_of_output<B>[o] + 1 : n;
  return n;
}();
template <class B> constexpr uint64_t mask_of_group(int group) {
  for (size_t o = 0; o < count_of<B, is_output>; ++o)
    if (group_of_output<B>[o] == group) return feedthrough<B>[o];
  return 0;
}

}  // namespace loopwright
