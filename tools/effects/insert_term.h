/// Adds a term at any port of a diagram, as a diagnosis without roles finds it.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>
#include "tools/effects/insert.h"

namespace loopwright {

/// One block whose output is added at a port.
struct Term {
  std::string name, title;          ///< "sign_at_net" is the name of its block
  std::string port;                 ///< at which it acts: a Sum, any other output, or an input of a block
  std::vector<std::string> reads;   ///< a port, or two of which the second is subtracted; none: a constant
  std::string settings;             ///< of the block, with its type, as JSON members
  std::string input, output = "y";  ///< its ports; the input is a list if it ends with "[]"
  bool is_change = false;           ///< what acts is the output minus what the block reads
  bool is_subtracted = false;       ///< what acts is minus the output
};

/// What earlier insertions changed in a diagram. Ports are those of the diagram as it was.
struct InsertedTerms {
  std::set<std::string> driven;               ///< ports that the experiments drive
  std::vector<std::string> blocks;            ///< that were added, by path
  std::map<std::string, std::string> sum_at;  ///< port → the Sum that adds terms to its signal
  std::map<std::string, std::string>
      signal_at;                          ///< driven input of a block → the port that has its signal now
  std::vector<MovedPort> moved;           ///< driven ports that the experiments must name differently
  std::vector<std::string> taken_out_by;  ///< of each term the parameter that takes it out when 0
};

/// The text of the diagram with the term, and a parameter "with_<name>" that takes it out when 0. Notes what
/// it changed in `inserted`. A changed subdiagram is written inline. Empty after a problem: the term reads
/// what is not known in the diagram of its port.
std::optional<std::string> insert_term(std::shared_ptr<const SourceFile> file,
                                       const std::map<std::string, std::string>& variants, const Term& term,
                                       InsertedTerms& inserted, Problems& problems);

}  // namespace loopwright
