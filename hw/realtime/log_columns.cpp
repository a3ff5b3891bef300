#include "hw/realtime/log_columns.h"
#include <algorithm>
#include "hw/realtime/deploy.h"

namespace loopwright::hw {

std::vector<LogColumn> log_columns(const Plan& plan, const Hardware& hardware) {
  using Kind = LogColumn::Kind;
  std::vector<LogColumn> columns{{"time", "s", Kind::time}};
  const auto add = [&](LogColumn column) {
    if (std::ranges::find(columns, column.name, &LogColumn::name) == columns.end())
      columns.push_back(std::move(column));
  };
  for (const Plan::Logged& logged : plan.log)
    add({logged.name, logged.unit_is_known ? to_string(logged.unit) : "", Kind::signal, logged.number});
  for (const Axis& axis : hardware.axes) {
    const Plan::Block& block = plan.blocks[size_t(axis.block)];
    const DeviceDescription& device = *hardware.device;
    const OutputChannel& command = device.outputs[size_t(axis.io->command_channel)];
    add({axis.path + ".position", device.inputs[size_t(axis.io->position_channel)].unit, Kind::signal,
         block.outputs[0]});
    if (axis.io->velocity_channel >= 0)
      add({axis.path + ".velocity", device.inputs[size_t(axis.io->velocity_channel)].unit, Kind::signal,
           block.outputs[1]});
    add({axis.path + ".command", command.unit, Kind::signal, axis.command});
    add({axis.path + ".applied", command.unit, Kind::applied, -1, size_t(axis.io->command_channel)});
  }
  add({std::string(lateness_column), "s", Kind::lateness});
  add({std::string(step_column), "s", Kind::step_time});
  add({std::string(lost_column), "1", Kind::lost});
  return columns;
}

void fill_row(std::span<double> row, std::span<const LogColumn> columns, const Run<double>& run,
              const IoDevice& device, const CycleAccount& account) noexcept {
  for (size_t i = 0; i < columns.size(); ++i) {
    const LogColumn& column = columns[i];
    switch (column.kind) {
      case LogColumn::Kind::time:
        row[i] = run.now().time;
        break;
      case LogColumn::Kind::signal:
        row[i] = run.number(column.number);
        break;
      case LogColumn::Kind::applied:
        row[i] = device.applied()[column.output];
        break;
      case LogColumn::Kind::lateness:
        row[i] = account.lateness_s;
        break;
      case LogColumn::Kind::step_time:
        row[i] = account.step_time_s;
        break;
      case LogColumn::Kind::lost:
        row[i] = account.lost;
        break;
    }
  }
}

}  // namespace loopwright::hw
