/// The methods of a block as a step calls them, generated from its description, for one scalar type.
#pragma once
#include <algorithm>
#include <cstring>
#include <new>
#include "engine/block/call.h"

namespace loopwright {

template <class R> LW_INLINE void attach(R& to, const Port<R>& w) { to = *w.data; }
template <class R> LW_INLINE void attach(Vector<const R>& to, const Port<R>& w) {
  to = {w.data, size_t(w.length)};
}
template <class R> LW_INLINE void attach(Vector<R>& to, const Port<R>& w) { to = {w.data, size_t(w.length)}; }
template <class R> LW_INLINE void attach(Many<R>& to, const Port<R>& w) { to = {w.many, w.length}; }
template <class R> LW_INLINE void attach(NamedInputs<R>& to, const Port<R>& w) { to = {&w}; }
template <class R> LW_INLINE void attach(NamedOutputs<R>& to, const Port<R>& w) { to = {&w}; }

/// The inputs in the mask; any other scalar reads NaN, so that an undeclared feedthrough is detected
/// immediately.
template <class B, class Real> LW_INLINE In<B> gather(const Call<Real>& c, auto mask) {
  In<B> in;
  for_each<B, is_input>([&](auto i, const auto& entry) {
    if constexpr ((mask() >> i) & 1)
      attach(in.*entry.member, c.in[i]);
    else if constexpr (std::is_same_v<std::remove_cvref_t<decltype(in.*entry.member)>, Real>)
      in.*entry.member = Real(std::numeric_limits<double>::quiet_NaN());
  });
  return in;
}
using AllInputs = std::integral_constant<uint64_t, ~uint64_t(0)>;

/// A view of the states at `data`: the struct itself if all members are Reals, spans if they are sized.
template <class B, class Real> LW_INLINE decltype(auto) view_state(const B& block, Real* data) {
  if constexpr (count_of < B, is_state_vector >> 0) {
    State<B> state;
    for_each<B, is_state_vector>([&](auto, const auto& entry) {
      const size_t n = size_t(std::invoke(entry.length, block));
      state.*entry.member = Vector<Real>(data, n);
      data += n;
    });
    return state;
  } else if constexpr (std::is_same_v<State<B>, None>) {
    return None{};
  } else {
    return *reinterpret_cast<State<B>*>(data);
  }
}
/// f(index, number) for every Real of a struct of Reals.
template <class Real, class T, class F> LW_INLINE void for_each_real(const T& reals, F&& f) {
  [&]<size_t... i>(std::index_sequence<i...>) __attribute__((always_inline)) {
    (f(i, reinterpret_cast<const Real*>(&reals)[i]), ...);
  }
  (std::make_index_sequence<sizeof(T) / sizeof(Real)>{});
}
template <class B, class Real> LW_INLINE Memory<B>& stored_memory(const Call<Real>& c) {
  return *static_cast<Memory<B>*>(c.memory);
}
template <class B, class Real> LW_INLINE Mode<B>& stored_mode(const Call<Real>& c) {
  return *static_cast<Mode<B>*>(c.mode);
}
/// f(memory): in place, or on a copy with its buffers attached, so that the arena never contains a pointer.
template <class B, class Real> LW_INLINE auto with_memory(const Call<Real>& c, bool writes, auto&& f) {
  if constexpr (count_of<B, is_buffer> == 0) {
    return f(stored_memory<B>(c));
  } else {
    Memory<B> memory = stored_memory<B>(c);
    for_each<B, is_buffer>([&](auto i, const auto& entry) { attach(memory.*entry.member, c.buffers[i]); });
    const uint64_t answer = f(memory);
    if (writes) {
      for_each<B, is_buffer>([&](auto, const auto& entry) { memory.*entry.member = {}; });
      stored_memory<B>(c) = memory;
    }
    return answer;
  }
}

/// The argument that a method requests by type: `const State&` is the present state, `State&` the result.
template <class Argument, class B, class Result>
LW_INLINE decltype(auto) pick(const Instant& now, const In<B>& in, const State<B>& state,
                              const Memory<B>& memory, const Mode<B>& mode, Result& result) {
  using T = std::remove_cvref_t<Argument>;
  if constexpr (std::is_same_v<T, Result> && !std::is_const_v<std::remove_reference_t<Argument>>)
    return (result);
  else if constexpr (std::is_same_v<T, Instant>)
    return (now);
  else if constexpr (std::is_same_v<T, In<B>>)
    return (in);
  else if constexpr (std::is_same_v<T, State<B>>)
    return (state);
  else if constexpr (std::is_same_v<T, Memory<B>>)
    return (memory);
  else if constexpr (std::is_same_v<T, Mode<B>>)
    return (mode);
  else
    static_assert(
        sizeof(T) == 0,
        "a method takes Instant, In, State, Memory, Mode by const reference and its result by reference");
}
template <class B, class Answer, class... Argument, class Result>
LW_INLINE Fault invoke(Answer (B::*method)(Argument...) const, const B& block, const Instant& now,
                       const In<B>& in, const State<B>& state, const Memory<B>& memory, const Mode<B>& mode,
                       Result& result) {
  if constexpr (std::is_void_v<Answer>) {
    (block.*method)(pick<Argument, B>(now, in, state, memory, mode, result)...);
    return {};
  } else {
    return (block.*method)(pick<Argument, B>(now, in, state, memory, mode, result)...);
  }
}
[[gnu::cold, gnu::noinline]] inline uint64_t report_fault(FaultReport* reports, int block,
                                                          const Fault& fault) {
  for (uint64_t left = fault.lanes; left; left &= left - 1)
    if (FaultReport& report = reports[__builtin_ctzll(left)]; report.block < 0)
      report = {block, fault.reason};
  return fault.lanes;
}

/// f(block): reports faults and returns the lanes that faulted.
template <class B, class Real> LW_INLINE uint64_t guard(const Call<Real>& c, auto&& f) {
  Fault fault = f(*static_cast<const B*>(c.block));
  if (!fault.lanes) [[likely]]
    return 0;
  fault.lanes <<= c.first_lane;
  return report_fault(c.report, c.index, fault);
}

/// Flattened: otherwise functions called by the method are not inlined, and inputs and outputs pass through
/// memory.
template <class B, class Real, int group> [[gnu::flatten]] uint64_t step_outputs(const Call<Real>& c) {
  return guard<B>(
      c, [&](const B& block) __attribute__((always_inline)) {
        const auto in = gather<B>(c, std::integral_constant<uint64_t, mask_of_group<B>(group)>{});
        const auto& state = view_state(block, c.state);
        Fault fault;
        Out<B> out;
        for_each<B, is_output>([&](auto o, const auto& entry) {
          if constexpr (group_of_output<B>[o] >= 0)
            if constexpr (!std::is_same_v<std::remove_cvref_t<decltype(out.*entry.member)>, Real>)
              attach(out.*entry.member, c.out[o]);
        });
        with_memory<B>(
            c, false, [&](const Memory<B>& memory) __attribute__((always_inline)) {
              fault = invoke(&B::outputs, block, *c.now, in, state, memory, stored_mode<B>(c), out);
              return uint64_t(0);
            });
        for_each<B, is_output>([&](auto o, const auto& entry) {
          if constexpr (group_of_output<B>[o] == group)
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(out.*entry.member)>, Real>)
              *c.out[o].data = out.*entry.member;
        });
        return fault;
      });
}
template <class B, class Real, class After> [[gnu::flatten]] uint64_t step_derivatives(const Call<Real>& c) {
  return guard<B>(
      c, [&](const B& block) __attribute__((always_inline)) {
        const auto in = gather<B>(c, AllInputs{});
        const auto& state = view_state(block, c.state);
        Fault fault;
        const auto derive = [&](auto& rate) __attribute__((always_inline)) {
          with_memory<B>(
              c, false, [&](const Memory<B>& memory) __attribute__((always_inline)) {
                fault = invoke(&B::derivatives, block, *c.now, in, state, memory, stored_mode<B>(c), rate);
                return uint64_t(0);
              });
        };
        if constexpr (count_of<B, is_state_vector> == 0) {
          State<B> rate{};
          derive(rate);
          for_each_real<Real>(
              rate, [&](size_t i, const Real& slope)
                        __attribute__((always_inline)) { After::take(c, int(i), slope); });
        } else {
          auto rate = view_state(block, c.rate);
          derive(rate);
          for (int i = 0; i < c.states; ++i) After::take(c, i, c.rate[i]);
        }
        return fault;
      });
}
/// update and accept: the next memory, from frozen inputs.
template <class B, class Real, auto method> [[gnu::flatten]] uint64_t step_memory(const Call<Real>& c) {
  return guard<B>(
      c, [&](const B& block) __attribute__((always_inline)) {
        const auto in = gather<B>(c, AllInputs{});
        const auto& state = view_state(block, c.state);
        Fault fault;
        with_memory<B>(
            c, true, [&](Memory<B> & memory) __attribute__((always_inline)) {
              fault = invoke(method, block, *c.now, in, state, memory, stored_mode<B>(c), memory);
              return uint64_t(0);
            });
        return fault;
      });
}
/// Whether the block states that its decision does not depend on the one before.
template <class B> consteval bool states_to_decide_anew() {
  if constexpr (requires { B::decides_anew; })
    return B::decides_anew;
  else
    return false;
}
template <class B> constexpr bool decides_anew = states_to_decide_anew<B>();
template <class B, class Real> uint64_t step_decide(const Call<Real>& c) {
  return guard<B>(
      c, [&](const B& block) __attribute__((always_inline)) {
        const auto in = gather<B>(c, AllInputs{});
        const auto& state = view_state(block, c.state);
        Fault fault;
        with_memory<B>(
            c, false, [&](const Memory<B>& memory) __attribute__((always_inline)) {
              auto& mode = stored_mode<B>(c);
              if constexpr (decides_anew<B>) mode = {};
              fault = invoke(&B::decide, block, *c.now, in, state, memory, mode, mode);
              return uint64_t(0);
            });
        return fault;
      });
}
/// The lanes in which two structs of Reals differ in any bit.
template <class Real, class T> uint64_t differing_lanes(const T& a, const T& b) {
  static_assert(sizeof(T) % sizeof(Real) == 0);
  uint64_t lanes = 0;
  for (size_t i = 0; i < sizeof(T) / sizeof(double); ++i) {
    const size_t at = i * sizeof(double);
    if (std::memcmp(reinterpret_cast<const char*>(&a) + at, reinterpret_cast<const char*>(&b) + at,
                    sizeof(double)) != 0)
      lanes |= uint64_t(1) << i % lanes_of<Real>;
  }
  return lanes;
}
/// Returns the lanes whose states changed: their signals must be computed again.
template <class B, class Real> uint64_t step_jump(const Call<Real>& c) {
  return guard<B>(c, [&](const B& block) {
    const auto in = gather<B>(c, AllInputs{});
    State<B>& state = view_state(block, c.state);
    const State<B> before = state;
    Fault fault;
    with_memory<B>(c, false, [&](const Memory<B>& memory) {
      fault = invoke(&B::jump, block, *c.now, in, before, memory, stored_mode<B>(c), state);
      return uint64_t(0);
    });
    *c.jumped |= differing_lanes<Real>(before, state) << c.first_lane;
    return fault;
  });
}
template <class B, class Real> uint64_t step_crossings(const Call<Real>& c) {
  return guard<B>(
      c, [&](const B& block) __attribute__((always_inline)) {
        const auto in = gather<B>(c, AllInputs{});
        const auto& state = view_state(block, c.state);
        auto& crossings = *reinterpret_cast<Crossings<B>*>(c.crossing);
        Fault fault;
        with_memory<B>(c, false, [&](const Memory<B>& memory) {
          fault = invoke(&B::crossings, block, *c.now, in, state, memory, stored_mode<B>(c), crossings);
          return uint64_t(0);
        });
        return fault;
      });
}

/// The result of a method that may return a Fault or nothing.
template <class F> Fault fault_of(F&& f) {
  if constexpr (std::is_void_v<decltype(f())>)
    return f(), Fault{};
  else
    return f();
}
/// Combines both; the reason is that of the first.
inline Fault joined(const Fault& first, const Fault& second) {
  return {first.lanes | second.lanes, first.lanes ? first.reason : second.reason};
}

template <class B> Fault prepare_block(B& block, const Setup& setup) {
  return fault_of([&] {
    if constexpr (requires { block.prepare(setup); })
      return block.prepare(setup);
    else if constexpr (requires { block.prepare(setup.sample_time); })
      return block.prepare(setup.sample_time);
  });
}

template <class B, class Real>
Fault start_block(const void* p, Real* state_data, void* memory_data, const Port<Real>* buffers,
                  void* mode_data) {
  const B& block = *static_cast<const B*>(p);
  Fault fault;
  const auto start = [&](auto& to) {
    if constexpr (requires { block.start(to); })
      fault = joined(fault, fault_of([&] { return block.start(to); }));
  };
  if constexpr (!std::is_same_v<State<B>, None>) {
    if constexpr (count_of<B, is_state_vector> == 0) new (state_data) State<B>{};
    auto&& state = view_state(block, state_data);
    start(state);
  }
  if constexpr (!std::is_same_v<Memory<B>, None>) {
    auto& stored = *new (memory_data) Memory<B>{};
    for_each<B, is_buffer>([&](auto i, const auto& entry) { attach(stored.*entry.member, buffers[i]); });
    start(stored);
    for_each<B, is_buffer>([&](auto, const auto& entry) { stored.*entry.member = {}; });
  }
  if constexpr (!std::is_same_v<Mode<B>, None>) {
    start(*new (mode_data) Mode<B>{});
  }
  return fault;
}

/// Whether T, which holds plain numbers, has padding bytes between or after its members. Assignment leaves
/// them undetermined.
template <class T> bool has_gaps() {
  if (std::is_empty_v<T>) return false;
  alignas(T) unsigned char bytes[sizeof(T)];
  std::memset(bytes, 1, sizeof bytes);
  __builtin_clear_padding(reinterpret_cast<T*>(bytes));
  return std::count(bytes, bytes + sizeof bytes, 1) < std::ptrdiff_t(sizeof bytes);
}

template <class B, class Real> Kernels<Real> kernels_of() {
  static_assert(group_count<B> <= 8, "at most eight groups of outputs with different feedthrough");
  static_assert(!(
                    requires { &B::update; } && requires { &B::derivatives; }),
                "a block is sampled or continuous, not both");
  Kernels<Real> k{};
  k.size = sizeof(B), k.align = alignof(B);
  k.memory_size = std::is_same_v<Memory<B>, None> ? 0 : sizeof(Memory<B>),
  k.memory_align = alignof(Memory<B>);
  k.mode_size = std::is_same_v<Mode<B>, None> ? 0 : sizeof(Mode<B>);
  k.memory_has_gaps = has_gaps<Memory<scalar_of<B>>>() || has_gaps<Mode<scalar_of<B>>>();
  k.construct = [](void* p) { new (p) B(); };
  k.destroy = [](void* p) { static_cast<B*>(p)->~B(); };
  k.copy = [](void* to, const void* from) {
    if constexpr (std::is_same_v<B, scalar_of<B>>)
      *static_cast<B*>(to) = *static_cast<const B*>(from);
    else
      spread(*static_cast<B*>(to), *static_cast<const scalar_of<B>*>(from));
  };
  k.tunable = [](void* p, std::string_view path) { return tunable<Real>(*static_cast<B*>(p), path); };
  k.prepare = [](void* p, const Setup& setup) { return prepare_block(*static_cast<B*>(p), setup); };
  k.start = &start_block<B, Real>;
  [&]<size_t... G>(std::index_sequence<G...>) { ((k.outputs[G] = &step_outputs<B, Real, int(G)>), ...); }
  (std::make_index_sequence<size_t(group_count<B>)>{});
  if constexpr (requires { &B::derivatives; }) {
    k.derivatives = &step_derivatives<B, Real, KeepSlope>;
    k.to_next_stage = &step_derivatives<B, Real, ToNextStage>;
    k.to_next_step = &step_derivatives<B, Real, ToNextStep>;
  }
  if constexpr (requires { &B::update; }) k.update = &step_memory<B, Real, &B::update>;
  if constexpr (requires { &B::accept; }) k.accept = &step_memory<B, Real, &B::accept>;
  if constexpr (requires { &B::decide; }) k.decide = &step_decide<B, Real>;
  if constexpr (requires { &B::jump; }) k.jump = &step_jump<B, Real>;
  // Events are located by variable-step methods, which run scalar.
  if constexpr (requires { &B::crossings; } && std::is_same_v<Real, double>)
    k.crossings = &step_crossings<B, Real>;
  return k;
}

}  // namespace loopwright
