/// Subdiagrams that run only while they are enabled, or when they are triggered.
///
/// An Enable block decides when the blocks inside run. With "outputs": "reset", every output passes through
/// an EnabledOutput block, which gives 0 meanwhile. Both are made here and belong to the diagram around the
/// subdiagram.
#pragma once
#include "engine/plan/flatten.h"
#include "engine/plan/plan.h"

namespace loopwright {

/// The path of the Enable block of a subdiagram is that of the subdiagram and this name.
inline constexpr std::string_view gate_name = "enabled";

/// The entry of a block made for a subdiagram.
BlockEntry entry_of_gate(const BlockEntry& subdiagram, std::string_view type);

/// Fills Plan::gates and the gates of its blocks.
void add_gates(const FlatDiagram& flat, const std::vector<int>& flat_of_block, Plan& plan,
               Problems& problems);

/// Reports blocks that cannot be stopped and started again, and triggers that are not sampled or that blocks
/// would miss. The rates of the plan must be known.
void check_gates(const Plan& plan, Problems& problems);

/// Reports names of the subdiagram that the gate needs.
void check_gate_names(const BlockEntry& subdiagram, const std::string& path, Problems& problems);

/// Reports an output that is wired straight to something outside the subdiagram: it could not be held.
void check_held_output(const FlatDiagram& flat, int gate, const DiagramOutput& output, const FlatWire& source,
                       const std::string& path, Problems& problems);

/// Whether a gate is this one or one inside it.
bool is_inside(const FlatDiagram& flat, int gate, int outer);

}  // namespace loopwright
