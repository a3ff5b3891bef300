/// A physical effect that a model may lack: a fragment of ordinary blocks, and the data that a search needs.
///
/// One file per effect (docs/effects.md). The same blocks run on measured signals (effect_run.h) and in the
/// diagram into which the effect is inserted (insert.h).
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "engine/json/value.h"

namespace loopwright {

/// The signals that an effect may read, by the names used in its wires.
inline const std::vector<std::string> effect_roles = {"position", "velocity", "acceleration", "input",
                                                      "force"};

/// The meaning of $position, $force and $input: for example rad, N*m and A for a current-driven motor. The
/// force is that of the sum of forces, the input is the recorded one.
struct MachineUnits {
  std::string position = "m", force = "N", input = "N";
};

/// Quantities of a record and of its machine, in SI; ranges and initial values of parameters are expressions
/// over them. Unknown ones are 0.
struct RecordSizes {
  double stroke = 0;            ///< [position] maximum minus minimum position
  double lowest_position = 0;   ///< [position]
  double highest_position = 0;  ///< [position]
  double top_speed = 0;         ///< [position/s]
  double top_acceleration = 0;  ///< [position/s²]
  double force_level = 0;       ///< [force] root mean square of the force produced by the input
  double input_level = 0;       ///< [input] root mean square of the input
  double machine_mass = 0;      ///< [force s²/position] of the nominal model
  double machine_damping = 0;   ///< [force s/position] of the nominal model
  double resolution = 0;        ///< [position] of the measured position
  double duration = 0;          ///< [s]
  double start = 0;             ///< [s] by the clock of the record, the first one of several
  bool clocks_differ = false;   ///< the others begin at other times
  double sample_time = 1e-3;    ///< [s]
  double initial_position = 0;  ///< [position] first sample
  double initial_velocity = 0;  ///< [position/s]
  double second = 1;            ///< [s] for times of machines, which do not depend on the record
};

/// Every quantity with its name in expressions and its unit by role.
struct NamedSize {
  std::string_view name, unit;
  double RecordSizes::*value;
};
extern const std::vector<NamedSize> record_sizes;

struct EffectParameter {
  enum class Scale { linear, logarithmic, reciprocal };
  std::string name, description;
  std::string unit;             ///< by role, "$force*s/$position"
  bool is_fitted = false;       ///< otherwise fixed, or computed from others
  bool is_linear = false;       ///< the effect is proportional to it, and several effects add up
  bool is_period = false;       ///< a distance after which the effect repeats: found by a spatial spectrum
  Scale scale = Scale::linear;  ///< scale on which grids are uniform and steps are taken
  int points = 0;               ///< part of the range that a search tries first; 0: the default
  Value low, high, start;       ///< numbers or expressions over quantities; a low of 0 is a sign limit
  Value value;                  ///< of one that is not fitted: over quantities and other parameters
  bool is_bounded = false;      ///< not fitted, but an effect with a value outside low … high is none
  Place place;
};

/// Where an effect acts on the machine.
struct Attachment {
  enum class To { force, input, sensor, parameter };
  /// Position on the path from command to force: before the amplifier, in the amplifier's current loop, in
  /// the saturating iron, in the field of the magnets.
  enum class Stage { command, amplifier, iron, magnets };
  To to = To::force;
  Stage stage = Stage::magnets;  ///< to the input
  std::string from;  ///< "friction.force": subtracted from the forces; or replaces input or measured position
  std::string slope;  ///< "late.slope": change of a held `from` over a sample; empty: not stated
  std::vector<std::string> targets;  ///< to a parameter: "Mass.mass", the first one of the machine
  Value add;                         ///< to a parameter: the value added to it
  bool is_optional = false;          ///< to a parameter: a machine without it is left unchanged
  Place place;
};

/// Whether an axis with the effect keeps its position against a force: not at all, up to its holding force,
/// or with a compliance that noise would visibly move.
enum class AtRest { free, holds, gives };

/// What a record must contain for the effect to be identifiable. 0 and 1 require nothing.
struct Excitation {
  std::string text;
  int directions = 1, speeds = 1, accelerations = 0, reversals = 0, passes = 1;
  double periods = 0;  ///< stroke over the effect's period
  double duration_s = 0;
  bool varied_force = false;  ///< the force changes fast, or differs at the same position
};

/// A motion that distinguishes effects, in quantities of the present record: passes over a part of the stroke
/// at several speeds, optionally with an added mass or a chirp of force.
struct SeparatingExperiment {
  std::string text;
  std::vector<double> speeds{1};  ///< of the top speed
  double distance = 1;            ///< of the stroke
  double acceleration = 1;        ///< of the top acceleration
  int passes = 1;
  double pause_s = 0.2;        ///< between strokes
  double added_mass = 0;       ///< of the machine's mass
  double chirp_amplitude = 0;  ///< of the level of the force; added to the command
  double chirp_from_hz = 0, chirp_to_hz = 0;
};

struct ConfusableEffect {
  std::string with;  ///< another effect of the catalogue
  std::string when;  ///< in words: in which records
  SeparatingExperiment experiment;
};

struct Effect {
  std::string name;  ///< "coulomb_friction"; also the name of its file
  std::string form;  ///< of an effect with several: "force constant"; otherwise empty
  std::string title, physics, path;
  std::vector<std::string> reads;  ///< the roles named by its wires
  std::vector<EffectParameter> parameters;
  std::vector<Attachment> attachments;
  std::vector<std::string> equivalents;  ///< other names of effects with the same appearance
  Excitation needs;
  std::vector<ConfusableEffect> confusable;
  bool is_repeatable = false;  ///< may occur more than once, with different parameters
  AtRest at_rest = AtRest::free;
  Value blocks;  ///< as written

  const EffectParameter* find(std::string_view parameter) const;
};

/// Every effect of a file: one, or one for each of its forms. Empty after a problem, and for an effect at a
/// site of any diagram (site_effect.h).
std::vector<Effect> load_effect(const std::string& path, Problems& problems);

/// All effect files of the folders, sorted by name; a repeated name replaces the earlier one.
std::vector<Effect> load_catalogue(const std::vector<std::string>& folders, Problems& problems);

/// The catalogue installed with the program, see shared_file, or the folder named by LOOPWRIGHT_EFFECTS.
std::string catalogue_folder();

struct FitRange {
  double low = 0, high = 0, start = 0;
};
/// The range of a fitted parameter for a record with these quantities, in SI.
FitRange range_of(const EffectParameter& parameter, const RecordSizes& sizes);

/// Makes the parameter a fixed one: "the pitch is 22.5 mm".
void fix(Effect& effect, std::string_view parameter, double value);

/// "$force*s/$position" in the units of a machine.
std::string unit_in(std::string_view unit, const MachineUnits& units);

}  // namespace loopwright
