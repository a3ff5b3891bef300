/// The unit equations of a diagram.
#pragma once
#include <deque>
#include <unordered_map>
#include "engine/plan/flatten.h"
#include "engine/plan/unit_expressions.h"

namespace loopwright {

/// One end of an equation: the unit of a port or parameter of a block, or a given unit.
struct End {
  int block = -1;  // the variables belong to this block
  const UnitExpression* expression = nullptr;
  std::string_view name;  // of the port or parameter; for a given unit, its text in the file
};
/// The rule of a block that determines the unit of an output.
struct Rule {
  struct Argument {
    End end;
    double power;
  };
  std::vector<Argument> arguments;
  bool is_formula = false;          // otherwise the product of the powers of the arguments
  std::optional<FormulaUnit> unit;  // of a formula, once the units of its arguments are known
};
/// Points into the diagram. Texts are written only for equations that are violated, as most equations hold.
struct Equation {
  End left, right;
  const Place* place;
  const std::string* declared = nullptr;  // path of the subdiagram port, if that is its left end
  Rule* rule = nullptr;                   // then its right end
  bool is_open_input = false;             // its right end is an input of the diagram
  bool is_bare = false;                   // a bare gain, which keeps the unit of its input
  bool is_wire() const { return left.block >= 0 && right.block >= 0; }
  bool is_parameter() const { return left.block >= 0 && right.block < 0 && !rule && !is_open_input; }
  bool agrees(const Unit& a, const Unit& b) const {
    const bool is_converted = is_parameter() && left.expression->factors.empty();  // done where it was read
    if (is_converted) return a.same_dimension(b);
    return a.fits(b) && (a.radians() == b.radians() || conversion(b, a).kind == Conversion::Kind::none);
  }
  /// Nothing to solve, and no contradiction.
  bool is_settled() const {
    return !rule && left.expression->factors.empty() && right.expression->factors.empty() &&
           agrees(left.expression->constant, right.expression->constant);
  }
};

/// The equations of the wires, the parameters with units, the declarations of subdiagrams, and the rules of
/// blocks.
class UnitEquations {
 public:
  UnitEquations(const FlatDiagram& flat, const Diagram& diagram);
  std::vector<Equation>& list() { return equations_; }
  const TypeUnits& types_of(int block) const { return *types_of_blocks_[size_t(block)]; }
  /// The number of unknowns of all blocks.
  size_t variables() const { return variables_; }
  size_t variable_of(int block, const UnitFactor& factor) const {
    return first_variable_[size_t(block)] + size_t(factor.variable);
  }
  /// Whether a variable is the position of a moving part.
  bool is_position(size_t variable) const;

 private:
  void number_variables();
  const UnitExpression* constant(const Unit& unit) {
    return &constants_.emplace_back(UnitExpression{unit, {}});
  }
  void add_block(int b);
  void add_equation(const Equation& equation);
  void add_number(const NumberWithUnit& number);
  void add_rule(int b);
  void add_claims(int b);
  End output_end(const FlatWire& wire) const;
  /// The declared unit of an input of the diagram, examined as a part; without a declaration there is no
  /// expression.
  End open_input_end(const FlatWire& wire);
  void add_declarations(const Diagram& diagram, const std::string& prefix);
  const FlatWire* declared(const std::string& path);

  const FlatDiagram& flat_;
  const Diagram& diagram_;
  std::unordered_map<const BlockType*, TypeUnits> types_;
  std::vector<const TypeUnits*> types_of_blocks_;
  std::deque<UnitExpression> constants_;
  std::deque<Rule> rules_;
  std::deque<std::string> declared_paths_;
  std::unordered_map<std::string_view, const FlatWire*> declared_;
  std::vector<Equation> equations_;
  size_t next_number_ = 0;              // of those with units; belongs to the next block
  size_t variables_ = 0;                // of all blocks
  std::vector<size_t> first_variable_;  // of each block
};

}  // namespace loopwright
