/// The cost of a loop on hardware, on the emulated card in virtual time: the paper's controller at 1 kHz.
#include <cstdlib>
#include "hw/drivers.h"
#include "hw/realtime/deploy.h"
#include "tests/benchmarks/measure.h"

namespace loopwright::benchmarks {
namespace {

hw::DeployResult deploy_for(double seconds) {
  setenv("HIL_LIBRARY", LOOPWRIGHT_EMULATOR, 1);
  LoadOptions options;
  options.variants["stage"] = "quanser";
  options.set = {{"solver.stop", std::to_string(seconds)}};
  const auto plan =
      load_plan(std::string(LOOPWRIGHT_SOURCE) + "/diagrams/linear_motor/conventional.json", options);
  Problems problems;
  const hw::Hardware hardware = hw::find_hardware(*plan, problems);
  auto virtual_device = std::make_shared<hw::DeviceDescription>(*hardware.device);
  virtual_device->clock.time = hw::Time::simulated;
  hw::IoDevice device(virtual_device, hw::find_driver("quanser")->make(virtual_device, problems));
  return hw::deploy(*plan, hardware, device, {});
}

void deploy_a_minute(benchmark::State& state) {
  std::vector<double> seconds, p99;
  for (auto _ : state) {
    const auto start = hw::wall_ns();
    const hw::DeployResult result = deploy_for(60);
    seconds.push_back(1e-9 * double(hw::wall_ns() - start));
    p99.push_back(result.statistics.step.quantile_us(0.99));
    state.SetIterationTime(seconds.back());
  }
  report(state, {"deploy_60_s_of_1_khz_wall_s",
                 median(seconds),
                 1,
                 "wall time of 60 s of control at 1 kHz on the emulated card in virtual time, card and motor "
                 "included, median",
                 {{"repetitions", double(seconds.size())}, {"step_p99_us", median(p99)}}});
}

void deploy_step(benchmark::State& state) {
  std::vector<double> p99, mean;
  for (auto _ : state) {
    const hw::DeployResult result = deploy_for(20);
    p99.push_back(result.statistics.step.quantile_us(0.99)), mean.push_back(result.statistics.step.mean_us());
    state.SetIterationTime(1e-6 * mean.back());
  }
  report(
      state,
      {"deploy_step_p99_us",
       median(p99),
       5,
       "99 % of the control steps of the paper's loop are computed within this time, with the time of every "
       "block taken; median",
       {{"mean_us", median(mean)}}});
}

}  // namespace

void add_deploy() {
  benchmark::RegisterBenchmark("deploy_a_minute", deploy_a_minute)->UseManualTime()->Iterations(5);
  benchmark::RegisterBenchmark("deploy_step", deploy_step)->UseManualTime()->Iterations(5);
}

}  // namespace loopwright::benchmarks
