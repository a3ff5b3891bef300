#include "tools/diagnose/search/state_behind.h"
#include <algorithm>
#include <functional>
#include <numeric>

namespace loopwright::diagnosis {

std::vector<int> states_behind(const SiteModel& model, const SitePass& pass) {
  const std::vector<SiteVariable>& variables = model.variables();
  std::vector<int> behind(variables.size());
  std::iota(behind.begin(), behind.end(), 0);
  const auto value = [&](size_t v, size_t row) { return variables[v].at(&pass.path[0][row * pass.numbers]); };
  std::vector<size_t> order(pass.rows);
  for (size_t s = 0; s < variables.size(); ++s) {
    if (!variables[s].is_state || variables[s].minus >= 0) continue;
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::sort(order, {}, [&](size_t row) { return value(s, row); });
    for (size_t v = 0; v < variables.size(); ++v) {
      if (variables[v].is_state || behind[v] != int(v)) continue;
      const auto along = [&](size_t row) { return value(v, row); };
      if (std::ranges::is_sorted(order, std::less{}, along) ||
          std::ranges::is_sorted(order, std::greater{}, along))
        behind[v] = int(s);
    }
  }
  return behind;
}

}  // namespace loopwright::diagnosis
