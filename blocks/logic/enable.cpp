/// level: on = 1 while u is true
/// rising, falling, either: on = 1 at the samples at which u changes
///
/// The blocks of a subdiagram with "enabled_by" or "triggered_by" run while its Enable block is on. It is
/// made together with the subdiagram; its output is `subdiagram.enabled`. The first value is not an edge. An
/// edge lasts for the whole instant, also if states jump there and everything is decided once more.
#include "blocks/logic/truth.h"

namespace loopwright::blocks {

enum class EnableKind { level, rising, falling, either };
constexpr auto names_of(EnableKind) {
  return std::array<std::string_view, 4>{"level", "rising", "falling", "either"};
}

template <class Real> struct Enable {
  EnableKind kind = EnableKind::level;
  struct In {
    Real u;
  };
  struct Out {
    Real on;
  };
  struct Mode {
    Real on, last, decided;  // decided: the time of the last decision, s
  };
  struct Crossings {
    Real u;
  };
  static constexpr auto describe() {
    return block(
        "Decides when a subdiagram runs.",
        parameter(&Enable::kind, "kind", "", "While the signal is true, or at which of its edges").optional(),
        input(&In::u, "u", "", "Logic value that enables or triggers"),
        output(&Out::on, "on", "", "1 while the subdiagram runs, else 0"), crossing(&Crossings::u, "u"));
  }
  void start(Mode& mode) const { mode = {0.0, unknown_truth, 0.0}; }
  Fault decide(const Instant& now, const In& in, Mode& mode) const {
    const auto truth = is_true(in.u);
    const auto had_edge = (mode.on > 0.5) & (mode.decided == now.time);
    const auto has_edge = had_edge | is_edge<Real>(edge(), mode.last, truth);
    mode.on = as_number<Real>(kind == EnableKind::level ? truth : has_edge);
    mode.last = as_number<Real>(truth), mode.decided = Real(now.time);
    return fault_unless_logic(in.u);
  }
  void outputs(const Mode& mode, Out& out) const { out.on = mode.on; }
  void crossings(const In& in, Crossings& value) const { value.u = truth_crossing(in.u); }

 private:
  EdgeKind edge() const {
    if (kind == EnableKind::rising) return EdgeKind::rising;
    return kind == EnableKind::falling ? EdgeKind::falling : EdgeKind::either;
  }
};
LOOPWRIGHT_BLOCK(Enable)

}  // namespace loopwright::blocks
