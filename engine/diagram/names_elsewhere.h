/// Names of blocks and solvers in other programs, and what is equivalent here.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace loopwright {

struct NameElsewhere {
  std::string_view name;         ///< as it is written there: "Transfer Fcn"
  std::string_view block;        ///< the equivalent block; empty: none
  std::string_view note;         ///< what else to know, or what to do without a block
  std::string_view method = "";  ///< of a solver: the equivalent method
};

/// Simulink's blocks and solvers, and names of control, mechanics and programmable controllers (IEC 61131-3).
std::span<const NameElsewhere> names_elsewhere();

/// "Transfer Fcn", "TransferFcn" and "transfer_fcn" are one name: its letters and digits in lower case.
std::string plain_name(std::string_view written);

/// Without the number that Simulink appends to the name of a block: "gain" for "gain1".
std::string_view without_number(std::string_view name);

/// What to use instead of it: "Pack", with the note.
std::string advice(const NameElsewhere& entry);

/// The entry for a name, with or without a number at its end. Null if
/// there is none.
const NameElsewhere* find_name_elsewhere(std::string_view written);

}  // namespace loopwright
