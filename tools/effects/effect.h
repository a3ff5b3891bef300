/// A physical effect that a model may lack: a fragment of ordinary blocks, and what a search must know of it.
///
/// One file an effect (docs/effects.md). The same blocks run on measured signals (effect_run.h) and in the
/// diagram into which the effect is inserted (insert.h).
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "engine/json/value.h"

namespace loopwright {

/// The signals that an effect may read, by the names that its wires use.
inline const std::vector<std::string> effect_roles = {"position", "velocity", "acceleration", "input",
                                                      "force"};

/// What $position, $force and $input stand for: rad, N*m and A for a motor that is driven by current. The
/// force is that of the place where forces add up, the input what was recorded.
struct MachineUnits {
  std::string position = "m", force = "N", input = "N";
};

/// Sizes of a record and of its machine, in SI: ranges and starts of parameters are expressions over them.
/// What is not known is 0.
struct RecordSizes {
  double stroke = 0;            ///< [position] highest less lowest position
  double lowest_position = 0;   ///< [position]
  double highest_position = 0;  ///< [position]
  double top_speed = 0;         ///< [position/s]
  double top_acceleration = 0;  ///< [position/s²]
  double force_level = 0;       ///< [force] root of the mean square of what the input makes of force
  double input_level = 0;       ///< [input] root of the mean square of the input
  double machine_mass = 0;      ///< [force s²/position] of the nominal model
  double machine_damping = 0;   ///< [force s/position] of the nominal model
  double resolution = 0;        ///< [position] of the measured position
  double duration = 0;          ///< [s]
  double sample_time = 1e-3;    ///< [s]
  double initial_position = 0;  ///< [position] first sample
  double initial_velocity = 0;  ///< [position/s]
};

/// Every size with its name in expressions and its unit by role.
struct NamedSize {
  std::string_view name, unit;
  double RecordSizes::*value;
};
extern const std::vector<NamedSize> record_sizes;

struct EffectParameter {
  enum class Scale { linear, logarithmic, reciprocal };
  std::string name, description;
  std::string unit;             ///< by role, "$force*s/$position"
  bool is_fitted = false;       ///< else fixed, or worked out from others
  bool is_linear = false;       ///< the effect is proportional to it, and effects of several add up
  bool is_period = false;       ///< a distance after which the effect repeats: found by a spatial spectrum
  Scale scale = Scale::linear;  ///< on which grids are even and steps are taken
  int points = 0;               ///< of the range on which a search looks first; 0: as is usual
  Value low, high, start;       ///< numbers or expressions over sizes; a low of 0 is a sign limit
  Value value;                  ///< of one that is not fitted: over sizes and other parameters
  Place place;
};

/// Where an effect acts on the machine.
struct Attachment {
  enum class To { force, input, sensor, parameter };
  /// Where on the way from command to force: on its way to the amplifier, in the amplifier's current loop, in
  /// the iron that saturates, in the field of the magnets.
  enum class Stage { command, amplifier, iron, magnets };
  To to = To::force;
  Stage stage = Stage::magnets;  ///< to the input
  std::string from;  ///< "friction.force": what is subtracted in the sum of forces, or takes the place of the
                     ///< input or of the measured position
  std::string slope;  ///< "late.slope": how much a held `from` should change over a sample; empty: not stated
  std::vector<std::string> targets;  ///< to a parameter: "Mass.mass", the first that the machine has
  Value add;                         ///< to a parameter: what is added to it
  bool is_optional = false;          ///< to a parameter: a machine without it is left as it is
  Place place;
};

/// Whether an axis with the effect stays where it is against a force: not at all, by as much as it can hold,
/// or with a give that noise would be seen to move.
enum class AtRest { free, holds, gives };

/// What a record must contain for the effect to be found in it. 0 and 1 ask for nothing.
struct Excitation {
  std::string text;
  int directions = 1, speeds = 1, accelerations = 0, reversals = 0, passes = 1;
  double periods = 0;  ///< stroke over the effect's period
  double duration_s = 0;
  bool varied_force = false;  ///< the force changes fast, or differs at the same place
};

/// A motion that tells effects apart, in sizes of the present record: passes over a part of the stroke at
/// several speeds, with an added mass or a chirp of force on top.
struct SeparatingExperiment {
  std::string text;
  std::vector<double> speeds{1};  ///< of the top speed
  double distance = 1;            ///< of the stroke
  double acceleration = 1;        ///< of the top acceleration
  int passes = 1;
  double pause_s = 0.2;        ///< between strokes
  double added_mass = 0;       ///< of the machine's mass
  double chirp_amplitude = 0;  ///< of the level of the force; on top of the command
  double chirp_from_hz = 0, chirp_to_hz = 0;
};

struct ConfusableEffect {
  std::string with;  ///< another effect of the catalogue
  std::string when;  ///< words: in which records
  SeparatingExperiment experiment;
};

struct Effect {
  std::string name;  ///< "coulomb_friction"; also the name of its file
  std::string form;  ///< of an effect with several: "force constant"; else empty
  std::string title, physics, path;
  std::vector<std::string> reads;  ///< the roles that its wires name
  std::vector<EffectParameter> parameters;
  std::vector<Attachment> attachments;
  std::vector<std::string> equivalents;  ///< other names of what looks the same
  Excitation needs;
  std::vector<ConfusableEffect> confusable;
  bool is_repeatable = false;  ///< may be there more than once, with other parameters
  AtRest at_rest = AtRest::free;
  Value blocks;  ///< as written

  const EffectParameter* find(std::string_view parameter) const;
};

/// Every effect of a file: one, or one for each of its forms. Empty after a problem.
std::vector<Effect> load_effect(const std::string& path, Problems& problems);

/// All effect files of the folders, sorted by name; a name that comes again replaces the former.
std::vector<Effect> load_catalogue(const std::vector<std::string>& folders, Problems& problems);

/// The catalogue that came with the program, see shared_file, or the folder that LOOPWRIGHT_EFFECTS names.
std::string catalogue_folder();

struct FitRange {
  double low = 0, high = 0, start = 0;
};
/// The range of a fitted parameter for a record of these sizes, in SI.
FitRange range_of(const EffectParameter& parameter, const RecordSizes& sizes);

/// Makes the parameter a fixed one: "the pitch is 22.5 mm".
void fix(Effect& effect, std::string_view parameter, double value);

/// "$force*s/$position" in the units of a machine.
std::string unit_in(std::string_view unit, const MachineUnits& units);

}  // namespace loopwright
