/// Result of a deployment: JSON for programs, text for a terminal, an HTML page.
#pragma once
#include "hw/realtime/deploy.h"
#include "tools/report/report.h"

namespace loopwright {

/// Stable keys: status, message, outputs_safe, time, cycles, overruns, lost_samples, …,
/// lateness_us.{mean,p50,p99, p999,max,max_cycle} and the same of read_us, step_us, write_us, total_us;
/// blocks[], system[], device[].
std::string to_json(const hw::DeployResult& result);
std::string to_text(const hw::DeployResult& result);
report::Page deployment_page(const Plan& plan, const hw::DeployResult& result);

}  // namespace loopwright
