/// Whether a loop with a learned compensation is stable, and how much compensation is certified.
///
/// The diagram is linearized except for the learned block and every memoryless block whose slope varies over
/// the range of a run, such as the plant's cogging: those are functions w = f(z) of bounded slope. The
/// remainder is linear, M: w → z, with all delays, holds and filters of the diagram.
///
/// Certificate A (bounded input, bounded output): M is stable and the functions are bounded, so every signal
/// is bounded. Certificate B (incremental small gain): with N_ik = Σ_j L_ij ‖M_{ij←k}‖, L the greatest slopes
/// and ‖·‖ the gain from peak to peak (or of energy), a spectral radius of N below 1 makes the response to
/// given inputs unique: perturbations decay. For one function this is α (L_x ‖G F‖ + L_v ‖G F F_v‖) < 1.
/// Desoer, Vidyasagar, Feedback Systems: Input-Output Properties, 1975, chapters III and VI.
#pragma once
#include <optional>
#include "models/linear/margins.h"
#include "tools/linearize/linear_diagram.h"
#include "tools/report/report.h"

namespace loopwright {

/// A memoryless block of bounded slope.
struct Nonlinearity {
  struct Input {
    std::string port;
    double slope = 0;          ///< included in the linear part
    double deviation = 0;      ///< greatest deviation of a slope from that one
    double low = 0, high = 0;  ///< range that was examined
  };
  std::string block;
  std::string output;  ///< port
  std::vector<Input> inputs;
  double bound = 0;  ///< greatest |f - linear part| over the range
  bool is_learned = false;
  bool has_jumps = false;  ///< it is discontinuous: no slope bounds it, the certificates exclude it
  std::string source;      ///< origin of the slopes
};

struct Certificate {
  bool holds = false;
  double radius = 0;          ///< spectral radius of N at the diagram's α; below 1: certified
  double radius_without = 0;  ///< at α = 0: due to the plant's own functions
  double largest_alpha = 0;   ///< largest certified α; infinite without a learned block, 0 for none
};

/// The constants and conditions of the paper's Proposition 1, of the diagram's own sampled loop.
struct PaperCondition {
  double gamma_dx = 0;  ///< ‖S P‖₁, position per command, with observer and compensation cut
  double gamma_q = 0;   ///< ‖Q Pₙ⁻¹‖₁
  double gain_q = 0;    ///< ‖Q‖₁
  double gamma_v = 0;   ///< ‖F_v‖₁; 0 without a learned block
  double gamma_xu = 0;  ///< ‖C_FB‖₁: the branch of (52) that is finite
  double gamma_g = 1;   ///< ‖F_gp‖₁
  double gamma_xd = 0;  ///< from reference to position, without feedforward
  double K = 0;         ///< L_x + L_v γ_v
  double alpha = 0;
  double rho_printed = 0;      ///< (58) as printed
  double rho_corrected = 0;    ///< (58) with ‖Q‖₁ in the place of the second γ_q
  double alpha_printed = 0;    ///< (62) as printed
  double alpha_corrected = 0;  ///< (62) with ‖Q‖₁
  double least_rho = 0;        ///< lower bound of ρ, from gains at rest and the jump of Q Pₙ⁻¹
  double c0_factor = 0;        ///< (60): c₀ = γ_dx γ_q c_u + this · b_μ
};

/// Two runs, one with a pulse added to the plant's command.
struct KickTest {
  double alpha = 0;
  double peak = 0;       ///< largest |difference of position|
  double rest = 0;       ///< the same over the last tenth of the time after the kick
  double tolerance = 0;  ///< limit of `rest`: counts of the encoder, a thousandth of the peak
  bool decays = false;
  std::vector<double> time, difference;
};

struct StabilityRequest {
  std::string disturbance;      ///< input port of the plant among the outermost blocks; empty: automatic
  double kick = 5;              ///< in the unit of that port
  double kick_duration = 0.01;  ///< s
  bool kicks = true;
};

struct StabilityReport {
  std::string title, plan;
  std::string disturbance, position, observer, feedback, learned;  ///< ports and blocks that were found
  std::string position_unit, command_unit;
  double sample_time = 0;
  double alpha = 0;         ///< of the diagram; 0 without a learned block
  double lead = 0;          ///< s, of the learned block
  double largest_pole = 0;  ///< |z| of the linear part
  /// Of the linear part between the disturbance and the position; warnings name modes outside that do not
  /// decay.
  Stability linear_part = Stability::unstable;
  Margins margins;  ///< at the plant's input, learned block cut
  std::vector<Nonlinearity> nonlinearities;
  double displacement = 0;              ///< A: the most that the learned block can add to the position
  Certificate peak, energy;             ///< B with gains from peak to peak, and of energy
  std::optional<PaperCondition> paper;  ///< only with an observer and a feedback
  std::vector<KickTest> kicks;
  std::vector<LinearizationNote> notes;
  std::vector<std::string> warnings;

  bool linear_part_is_stable() const { return linear_part == Stability::stable; }
  bool is_certified() const { return linear_part_is_stable() && peak.holds; }
};

/// Runs the diagram once for the ranges of its signals, and twice for each kick. Throws InputError,
/// Interrupted, and std::runtime_error when a run fails.
StabilityReport assess_stability(const std::string& path, const LoadOptions& load,
                                 const StabilityRequest& request, const RunOptions& options = {});

std::string to_text(const StabilityReport& report);
/// Stable keys: certified, alpha, B.{peak,energy}.{holds,radius,largest_alpha}, A.…, paper.…, kicks[],
/// margins.
std::string to_json(const StabilityReport& report);
report::Page stability_page(const StabilityReport& report);

}  // namespace loopwright
