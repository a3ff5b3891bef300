/// The header for block files. A block is a value: it has parameters and no mutable state.
///
// clang-format off
///   template <class Real> struct MyBlock {                  // a plain struct instead: scalar only, run lane by lane
///     Real gain;                                            // parameters: Real is tunable; int, bool, string, enum, lists structural
///     struct In  { Real u; };                               // ports: Real, Vector<const Real>, Many<Real>
///     struct Out { Real y; };                               //        Real, Vector<Real>
///     struct State  { Real x; };                            // continuous states: all Reals, or all Vector<Real> (state_vector)
///     struct Memory { … };                                  // discrete memory: trivially copyable, Vector<Real> for buffers
///     struct Mode   { … };                                  // piecewise constant: constant during integration
///     struct Crossings { Real g; };                         // functions whose zero crossing is an event
///     static constexpr auto describe();                     // block(sentence, parameter…, input…, output…, buffer…, crossing…)
///     void check(const Checker&);                           // rules between parameters; reads files; scalar block only
///     void prepare(double sample_time | const Setup&);      // derived constants, once per run
///     void start(State&) const, start(Memory&) const, start(Mode&) const;   // default: zeros
///     void outputs(…, Out&) const;
///     void derivatives(…, State& rate) const;
///     void update(…, Memory&) const;                        // the next memory, from frozen inputs, at every sample
///     void accept(…, Memory&) const;                        // continuous memory: after every accepted solver step
///     void decide(…, Mode&) const;                          // the active mode: at samples, steps and events, never inside a step
///     void jump(…, State&) const;                           // resets states at an event, from frozen inputs
///     void crossings(…, Crossings&) const;
///     bool may_cross() const;                               // false: with these parameters there is no crossing; default: true
///     double next_stop(double now) const;                   // the next time (s) at which it is not smooth
///     double shortest_period() const;                       // s, of a generated signal, so that no step skips it; infinity: none
///     std::vector<UnitClaim> unit_claims() const;           // units that come from files (engine/block/instance_units.h)
///     double unit_power(int wire) const;                    // the output's unit is the product of the wires' units to these powers
///     FormulaUnit formula_unit(std::span<const Unit>) const;  // the output's unit as a function of the wires' units
///     static constexpr bool decides_anew = true;            // decide() is given an empty Mode: the one before does not matter
///     static constexpr bool has_side_effects = true;        // acts on the external world: never several runs at a time
///   };
///   LOOPWRIGHT_BLOCK(MyBlock)
// clang-format on
///
/// Where … stands, a method takes any of `const Instant&, const In&, const State&, const Memory&, const
/// Mode&`. Every method, including prepare and start, may return a Fault.
#pragma once
#include <cmath>
#include <numbers>
#include "engine/block/registry.h"
#include "models/real/functions.h"

namespace loopwright {

using std::numbers::pi;

#ifdef LOOPWRIGHT_LANE_REAL  // compiled into a module for one instruction set: lane kernels only
template <template <class> class B> bool register_block(std::string_view type, std::string_view) {
  lane_kernels<LOOPWRIGHT_LANE_REAL>().emplace(type,
                                               kernels_of<B<LOOPWRIGHT_LANE_REAL>, LOOPWRIGHT_LANE_REAL>());
  return true;
}
template <class B> bool register_block(std::string_view, std::string_view) { return true; }
#else
/// "blocks/<folder>/<file>" for a source in this tree; blocks from elsewhere have a folder of their own.
inline std::string source_of(std::string_view file) {
  const size_t rooms = file.rfind("blocks/");
  if (rooms != file.npos && file.find('/', rooms + 7) != file.npos) return std::string(file.substr(rooms));
  return "blocks/further/" + std::string(file.substr(file.rfind('/') + 1));
}

template <class B> bool register_scalar(std::string_view type, std::string_view file, bool lane_wise) {
  BlockInfo info = info_of<B>(type);
  info.source = source_of(file);
  info.room = info.source.substr(7, info.source.find('/', 7) - 7);
  info.lane_wise = lane_wise;
  add_block(block_layout, std::move(info), kernels_of<B, double>());
  return true;
}
template <template <class> class B> bool register_block(std::string_view type, std::string_view file) {
  return register_scalar<B<double> >(type, file, true);
}
template <class B> bool register_block(std::string_view type, std::string_view file) {
  return register_scalar<B>(type, file, false);
}
#endif

#define LOOPWRIGHT_BLOCK(Type) \
  [[maybe_unused]] static const bool registered_##Type = ::loopwright::register_block<Type>(#Type, __FILE__);

}  // namespace loopwright
