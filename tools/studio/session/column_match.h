/// Guesses what the columns of a record are in a diagram: by name, unit, and the structure of the machine.
/// A person confirms every guess.
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "engine/plan/plan.h"
#include "engine/record/recording.h"

namespace loopwright::studio {

struct PortOfDiagram {
  std::string path;
  std::optional<Unit> unit;
  bool is_input = false;
  Number number = -1;
};
/// The scalar ports of a diagram, those nearest to its surface first.
std::vector<PortOfDiagram> ports_of(const Plan& plan, const Diagram& diagram);

struct RoleGuess {
  std::string role, port, why;
};
/// The machine: the mass, the sum of forces that moves it, and the input of the diagram around it.
std::vector<RoleGuess> guess_roles(const Plan& plan, const std::vector<PortOfDiagram>& ports);

struct ColumnGuess {
  enum class Use { time, drive, compare, ignore };
  std::string column, name;    ///< as in the file, and without its unit
  std::string unit;            ///< of its numbers; empty: not known
  bool unit_is_stated = true;  ///< by the heading; otherwise guessed from the end of the name, "force_N"
  Use use = Use::ignore;
  std::string port, why;
  std::string resolution;  ///< a number in the unit of the column, whatever that is; empty: not seen
  double low = 0, high = 0;
  std::vector<std::string> candidates;
};
std::string_view name_of(ColumnGuess::Use use);

std::vector<ColumnGuess> guess_columns(const Recording& record, const std::vector<PortOfDiagram>& ports,
                                       const std::vector<RoleGuess>& roles);

}  // namespace loopwright::studio
