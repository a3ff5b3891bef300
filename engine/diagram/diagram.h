/// A diagram as in its file, after resolving parameters, variants, overrides and expressions; still nested.
///
/// The file (docs/diagram_format.md) is JSON. `load_diagram` reads it and every subdiagram that it names, and
/// collects all problems. Checks that need knowledge of particular blocks are left to the plan: whether a
/// type exists, whether its settings fit, whether the source of a wire exists and has the right unit.
#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "engine/json/problem.h"
#include "engine/unit/unit.h"
#include "engine/json/value.h"

namespace loopwright {

struct Diagram;

/// One end of a wire as written: "feedback.command", "gain.y[2]", or the name of an input of the diagram.
struct Wire {
  std::string source;
  Place place;
};

/// The wires into one input port of a block.
struct PortWires {
  std::string port;
  Place place;           ///< of the port's name
  bool is_list = false;  ///< written as a list, even if of one wire
  std::vector<Wire> wires;
};

/// When a subdiagram runs: while a signal is true, or at each of its edges.
struct RunCondition {
  std::string key;              ///< "enabled_by" or "triggered_by"
  Place place;                  ///< of the key
  Wire wire;                    ///< in the diagram that contains the subdiagram
  std::string kind = "level";   ///< or the edge: "rising", "falling", "either"
  bool resets_states = false;   ///< states start anew when it is enabled; otherwise they are held
  bool resets_outputs = false;  ///< outputs are 0 while it is disabled; otherwise they are held
  bool is_triggered() const { return kind != "level"; }
};

/// A block, or a subdiagram in place of a block. Of a block with variants only the active variant is kept.
struct BlockEntry {
  std::string name;
  Place place;       ///< of the name
  std::string type;  ///< empty for a subdiagram, and for an entry with errors
  Place type_place;
  Value settings;  ///< object: all but the keys of the engine; expressions evaluated, units attached
  Boxed<Value> sample_time, sample_offset;  ///< numbers in s
  std::vector<PortWires> in;
  std::shared_ptr<const Diagram> subdiagram;
  std::shared_ptr<const RunCondition> condition;  ///< of a subdiagram; null: it runs all the time
  std::string variant;                            ///< name of the active variant; empty without variants
};

struct DiagramInput {
  std::string name, unit, description;  ///< empty unit: that of the wire
  Place place;
};

struct DiagramOutput {
  std::string name, unit, description;  ///< empty unit: that of the source
  Place place;
  Wire source;
};

/// A named value. Numbers are in SI, for any unit in the file.
struct Parameter {
  std::string name, description;
  Value value;               ///< number, boolean, text, or a list of them
  std::optional<Unit> unit;  ///< as declared, with its scale (mm: 1e-3); none: a bare number
  Place place;               ///< of the name
};

/// One key of "solver", with its source location for messages.
template <class T> struct Setting {
  T value{};
  bool is_given = false;
  Place place{};
};

struct SolverSettings {
  Setting<std::string> method{"rk4"};  ///< euler, heun, rk4, dopri5, cvode-bdf or cvode-adams
  Setting<double> start{0.0};          ///< s
  Setting<double> stop{0.0};           ///< s; not given: the caller must decide when to stop
  Setting<double> step{0.0};           ///< s; of a fixed-step method; not given: the plan decides
  Setting<double> maximum_step{std::numeric_limits<double>::infinity()};  ///< s; of a variable-step method
  Setting<double> relative_tolerance{1e-6};
  Setting<double> absolute_tolerance{1e-9};
  Setting<double> record_step{0.0};  ///< s between rows of the recording; not given: the plan decides
  Setting<std::string> algebraic_loops{"error"};  ///< or "solve"
  Setting<uint64_t> seed{1};                      ///< of every random source
  Place place;                                    ///< of the object, or of the diagram if it has none
};

struct Diagram {
  std::string title, description;
  std::string path;  ///< of the file, as it was opened
  std::vector<Parameter> parameters;
  SolverSettings
      solver;  ///< applies to the outermost diagram; that of a subdiagram applies when it is run alone
  std::vector<BlockEntry> blocks;
  std::vector<DiagramInput> inputs;
  std::vector<DiagramOutput> outputs;
  std::vector<Wire> log;  ///< ports, also nested, "stage.mass.velocity", and patterns, "stage.*"
  std::vector<std::string>
      files;  ///< outermost diagram: every diagram file that was read, in order of reading
  std::vector<FileRead> files_read;  ///< outermost diagram: the subdiagrams' files
};

/// Replaces the source of an input port by the output of a new block at the top level.
struct Drive {
  /// "axis.force", also nested, "stage.mass.force"; "command.terms[1]" for one wire of a list;
  /// "force" for an input of the outermost diagram.
  std::string port;
  Value settings;  ///< object: the settings of the new block
  std::string type = "RecordedColumn", output = "value";
};

struct LoadOptions {
  /// `--set path=value`: a parameter of the diagram ("observer_cutoff") or of a subdiagram ("stage.payload"),
  /// a setting of a block ("cogging.harmonics.0.amplitude"), or a key of the solver ("solver.stop"). The
  /// value is JSON, an expression ("=2*pi"), a number with a unit ("25 mm"), or otherwise plain text.
  std::vector<std::pair<std::string, std::string>> set;
  /// The same as a file states it: path → value; applied after `set`.
  std::vector<Value::Member> set_in_file;
  std::map<std::string, std::string>
      variants;  ///< `--variant stage=quanser`: block path → name of the variant
  std::vector<Drive> drives;
};

/// Reads a diagram and its subdiagrams. With errors the result is the readable part, or null if nothing could
/// be read.
std::shared_ptr<const Diagram> load_diagram(const std::string& path, const LoadOptions& options,
                                            Problems& problems);

/// Resolves a path given in a file, relative to the folder of that file.
std::string resolve_relative(const Place& place, std::string_view path);

}  // namespace loopwright
