/// The sources of wires, by the names in a diagram and its subdiagrams.
#pragma once
#include <string_view>
#include <unordered_set>
#include "engine/plan/flatten.h"
#include "engine/plan/scope.h"

namespace loopwright {

/// The block of a gate or of a reset output as the source of a wire.
FlatWire made_wire(int block, const Wire& at);

class WireResolver {
 public:
  /// `open`: inputs of the outermost diagram may have no source. `scopes`: of each flat block.
  WireResolver(FlatDiagram& flat, const std::vector<Scope*>& scopes, bool open, Problems& problems)
      : flat_(flat), scopes_(scopes), open_(open), problems_(problems) {}

  /// Follows a name to its block output, through diagram inputs, subdiagram outputs and nested paths.
  FlatWire resolve(Scope& scope, std::string_view text, const Wire& at, const std::string& reader,
                   int depth = 0);
  /// The source of an input of the diagram, by its name.
  FlatWire resolve_input(Scope& scope, const std::string& name, const std::string& element, const Wire& at,
                         const std::string& reader, int depth = 0);
  /// The source of an output of a subdiagram, as its surroundings see it.
  FlatWire output_of(Scope& inner, size_t o, int depth = 0);
  /// Reports that a wire has no source. `names`: what could have been meant instead of `wrong`.
  FlatWire fail(const Wire& at, const std::string& reader, std::string message,
                std::vector<std::string> names, const std::string& wrong, std::string hint = "");

 private:
  FlatWire resolve_inside(Scope& inner, std::string_view rest, const Wire& at, const std::string& reader,
                          int depth);
  FlatWire resolve_port(int block, std::string_view rest, const Wire& at, const std::string& reader,
                        int depth);
  FlatWire with_element(FlatWire wire, const std::string& element, const Wire& at, const std::string& reader);

  FlatDiagram& flat_;
  const std::vector<Scope*>& scopes_;
  const bool open_;
  Problems& problems_;
  std::unordered_set<std::string> told_;
};

}  // namespace loopwright
