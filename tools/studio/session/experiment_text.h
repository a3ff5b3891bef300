/// The text of an experiment file.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>
#include "engine/json/value.h"
#include "tools/studio/session/text_change.h"

namespace loopwright::studio {

/// From a request "write_experiment" (tools/studio/protocol.md); `data`: the record, relative to the
/// experiment. `before`: the experiment that it replaces, or nothing; its "set", which a request does not
/// have, stays. Throws Refused for a request that is incomplete.
std::string experiment_text(const Value& request, const std::string& data, const Value& before);

/// Every port that an experiment drives, compares, or names in its roles and sites.
std::vector<std::string> ports_of_experiment(const Value& experiment);
/// The changes that give them the names of `new_name`, unsorted.
TextChanges ports_renamed(const Value& experiment,
                          const std::function<std::string(const std::string& port)>& new_name);

/// The experiment with its ports renamed: "axis" → "stage" renames "axis.position" too.
std::string with_ports_renamed(const std::string& path, const std::string& text,
                               const std::map<std::string, std::string>& renamed);

}  // namespace loopwright::studio
