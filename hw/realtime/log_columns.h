/// What a row of the log holds: the plan's own signals, each axis, and the accounts of the loop.
#pragma once
#include <span>
#include "engine/record/recording.h"
#include "hw/device/io_device.h"
#include "hw/realtime/axes.h"
#include "hw/realtime/period.h"

namespace loopwright::hw {

struct LogColumn {
  enum class Kind : uint8_t { time, signal, applied, lateness, step_time, lost };
  std::string name, unit;
  Kind kind = Kind::signal;
  Number number = -1;  ///< of a signal
  size_t output = 0;   ///< of what was applied
};

/// What the loop knows of a cycle beside the run and the device.
struct CycleAccount {
  double lateness_s = 0, step_time_s = 0;
  double lost = 0;  ///< instants since the row before that have no row, as no sample of them came
};

/// "time", everything the plan logs, "<axis>.position", "<axis>.command", "<axis>.applied", the accounts. The
/// measured velocity too, where the device measures one. No name twice.
std::vector<LogColumn> log_columns(const Plan& plan, const Hardware& hardware);

/// One row; as many numbers as columns.
void fill_row(std::span<double> row, std::span<const LogColumn> columns, const Run<double>& run,
              const IoDevice& device, const CycleAccount& account) noexcept;

}  // namespace loopwright::hw
