#include "tools/experiment/stated_roles.h"
#include <fmt/format.h>
#include <memory>
#include "tools/experiment/experiment.h"
#include "tools/experiment/repeated_records.h"

namespace loopwright {

bool have_roles(const std::vector<std::string>& experiments) {
  size_t with_roles = 0;
  std::vector<std::shared_ptr<const Experiment>> all;
  for (const std::string& path : experiments) {
    Problems problems;  // reported by the path that is taken
    const auto experiment = read_experiment(path, problems);
    all.push_back(experiment);
    with_roles += !experiment || problems.has_errors() || !experiment->roles.ports.empty();
  }
  if (with_roles == experiments.size() || with_roles == 0) {
    Problems repeated;
    refuse_repeated_records(all, repeated);
    if (repeated.has_errors()) throw InputError(std::move(repeated));
    return with_roles > 0;
  }
  Problems problems;
  auto& p = problems.error({}, "/roles", "", "some of the experiments name roles, others do not");
  p.expected = "\"roles\" in every experiment, or in none";
  p.found = fmt::format("{} of {} experiments name roles", with_roles, experiments.size());
  throw InputError(std::move(problems));
}

}  // namespace loopwright
