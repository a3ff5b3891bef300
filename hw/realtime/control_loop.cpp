#include "hw/realtime/control_loop.h"
#include "models/real/whole.h"
#include <algorithm>
#include <cmath>

namespace loopwright::hw {

ControlLoop::ControlLoop(const Plan& plan, const Hardware& hardware, IoDevice& device, Clock& clock,
                         LogRing& log, std::span<const LogColumn> columns)
    : hardware_(hardware),
      device_(device),
      clock_(clock),
      log_(log),
      columns_(columns),
      stepper_(plan, hardware),
      device_is_clock_(device.capabilities().is_clock),
      is_simulated_(device.description().clock.time == Time::simulated),
      period_ns_(whole_between<int64_t>(std::round(1e9 * hardware.period_s), 1, INT64_MAX / 2)) {
  inputs_.resize(device.description().inputs.size());
  for (const OutputChannel& output : device.description().outputs) outputs_.push_back(output.safe);
  row_.resize(columns.size());
  block_sums_.resize(plan.blocks.size());
  for (const Plan::Logged& logged : plan.log)
    if (error_ < 0 && logged.name.find("error") != std::string::npos) error_ = logged.number;
}

void ControlLoop::warm_up() {
  for (int i = 0; i < 2; ++i) {
    for (size_t a = 0; a < hardware_.axes.size(); ++a) stepper_.measure(a, 0, 0);
    step();
    fill_row(row_, columns_, stepper_.run(), device_, {});
    stepper_.finish();
  }
  stepper_.reset();
  std::ranges::fill(block_sums_, BlockSum{});
  end_ = {};
}

Status ControlLoop::start() {
  struct Leaving {
    ControlLoop& loop;
    ~Leaving() { loop.leave(); }
  } const at_the_end{*this};  // also if the driver throws
  enter(LoopPart::start, wall_ns());
  return device_.start(hardware_.period_s);
}

void ControlLoop::run() noexcept {
  while (cycle()) stepper_.finish();
  leave();
}

bool ControlLoop::cycle() noexcept {
  Sample sample;
  const int64_t begin = wall_ns();
  if (const Status status = read(sample); !status.ok())
    return end_with(is_asked_to_stop_ ? LoopEnd::Why::asked : LoopEnd::Why::status, status);
  if (is_asked_to_stop_.load(std::memory_order_relaxed)) return end_with(LoopEnd::Why::asked);
  const int64_t lateness_ns = lateness_of(sample);
  const int64_t was_read = wall_ns();
  enter(LoopPart::step, was_read);
  if (!count_missing(sample)) return false;
  for (size_t a = 0; a < hardware_.axes.size(); ++a) {
    const blocks::HardwareIo& io = *hardware_.axes[a].io;
    stepper_.measure(a, inputs_[size_t(io.position_channel)],
                     io.velocity_channel < 0 ? 0 : inputs_[size_t(io.velocity_channel)]);
  }
  if (!step()) return end_with(LoopEnd::Why::step_failed);
  const int64_t stepped = wall_ns();
  enter(LoopPart::write, stepped);
  const Status written = write();
  const int64_t done = wall_ns();
  enter(LoopPart::step, done);  // the rest of it, up to the next sample
  statistics_.read.add(was_read - begin, statistics_.cycles);
  statistics_.step.add(stepped - was_read, statistics_.cycles);
  statistics_.write.add(done - stepped, statistics_.cycles);
  statistics_.total.add(done - was_read, statistics_.cycles);
  const bool goes_on = account_for(lateness_ns, stepped - was_read);
  if (!written.ok()) return end_with(LoopEnd::Why::status, written);
  return goes_on;
}

Status ControlLoop::read(Sample& sample) noexcept {
  if (!device_is_clock_ && statistics_.cycles > 0) {
    leave();
    clock_.sleep_until(origin_ns_ + (instant_ + 1) * period_ns_);
  }
  enter(LoopPart::read, wall_ns());
  return device_.read(sample, inputs_);
}

/// Time since the instant at which the sample was due. The clocks drift: the origin follows early samples at
/// once and late ones slowly, so that the lateness is that of this computer and not of the card's clock.
int64_t ControlLoop::lateness_of(const Sample& sample) noexcept {
  if (device_is_clock_) {
    due_ns_ = origin_ns_ + sample.sequence * period_ns_;
    clock_.sampled(due_ns_);
  }
  const int64_t now = clock_.now_ns();
  if (statistics_.cycles == 0) {
    origin_ns_ = now - sample.sequence * period_ns_ * device_is_clock_;
    kicked_ns_ = due_ns_ = now;
    return 0;
  }
  if (!device_is_clock_) {
    due_ns_ = origin_ns_ + (instant_ + 1) * period_ns_;
    const int64_t late = std::max<int64_t>(0, now - due_ns_);
    skipped_ = late / period_ns_;  // the sample belongs to the last instant that has passed
    return late;
  }
  const int64_t late = now - due_ns_;
  origin_ns_ += late < 0 ? late : std::min(late, period_ns_) / 1000;
  return std::max<int64_t>(0, late);
}

bool ControlLoop::count_missing(const Sample& sample) noexcept {
  LoopStatistics& s = statistics_;
  const Policy& policy = device_.description().policy;
  const bool is_first = s.cycles == 0;  // the plan begins with it, regardless of earlier losses
  missing_ = is_first ? 0 : sample.lost + skipped_;
  s.lost_samples += is_first ? 0 : sample.lost;
  s.skipped_periods += skipped_;
  s.longest_gap = std::max(s.longest_gap, missing_);
  if (!is_first && sample.lost >= policy.lost_that_end()) return end_with(LoopEnd::Why::lost, {Code::lost});
  if (skipped_ >= policy.most_skipped) return end_with(LoopEnd::Why::skipped, {Code::late});
  instant_ += is_first ? 0 : missing_ + 1;
  return stepper_.ends_within(missing_) ? end_with(LoopEnd::Why::finished) : true;
}

bool ControlLoop::step() noexcept {
  int64_t before = wall_ns();
  stepper_.compute(missing_, [&](int block) {
    const int64_t now = wall_ns();
    part_since_.store(now, std::memory_order_relaxed);
    BlockSum& sum = block_sums_[size_t(block)];
    sum.total_ns += now - before;
    sum.longest_ns = std::max(sum.longest_ns, now - before);
    before = now;
  });
  for (size_t a = 0; a < hardware_.axes.size(); ++a)
    outputs_[size_t(hardware_.axes[a].io->command_channel)] = stepper_.command(a);
  return stepper_.run().failed() == 0;
}

Status ControlLoop::write() noexcept {
  const Status written = device_.write(outputs_);
  if (!written.ok()) return written;
  const int64_t now = clock_.now_ns();
  longest_unkicked_ns_ = std::max(longest_unkicked_ns_, now - kicked_ns_);
  kicked_ns_ = now;
  return device_.kick();
}

/// Counts, logs, and returns whether to continue.
bool ControlLoop::account_for(int64_t lateness_ns, int64_t step_ns) noexcept {
  LoopStatistics& s = statistics_;
  const CycleAccount account{1e-9 * double(lateness_ns), 1e-9 * double(step_ns), double(missing_)};
  s.lateness.add(lateness_ns, s.cycles);
  const int64_t backlog = lateness_ns / period_ns_;
  s.longest_backlog = std::max(s.longest_backlog, backlog);
  const bool is_overrun = clock_.now_ns() - due_ns_ > period_ns_;
  s.overruns += is_overrun;
  overruns_in_row_ = is_overrun ? overruns_in_row_ + 1 : 0;
  s.most_overruns_in_row = std::max(s.most_overruns_in_row, overruns_in_row_);
  ++s.cycles;
  fill_row(row_, columns_, stepper_.run(), device_, account);
  if (is_simulated_) wait_for_log();
  log_.push(row_);
  live_time_.store(row_[0], std::memory_order_relaxed);
  live_error_.store(error_ < 0 ? 0 : stepper_.run().number(error_), std::memory_order_relaxed);
  live_command_.store(stepper_.command(0), std::memory_order_relaxed);
  live_lateness_.store(account.lateness_s, std::memory_order_relaxed);
  const Policy& policy = device_.description().policy;
  if (policy.on_overrun == OnOverrun::fault && overruns_in_row_ >= policy.most_overruns)
    return end_with(LoopEnd::Why::overruns, {Code::late});
  return stepper_.is_last() ? end_with(LoopEnd::Why::finished) : true;
}

/// In simulated time there are no deadlines, and a minute of model time would overrun any log.
void ControlLoop::wait_for_log() noexcept {
  const timespec moment = {0, 100'000};
  if (log_.has_room()) return;
  leave();  // the disk, not the device, is waited for
  while (!log_.has_room() && !is_asked_to_stop_.load(std::memory_order_relaxed)) nanosleep(&moment, nullptr);
  enter(LoopPart::step, wall_ns());
}

LiveValues ControlLoop::live() const noexcept {
  const Plan& plan = stepper_.run().plan();
  return {live_time_.load(std::memory_order_relaxed),     plan.clock.time(plan.stop_tick),
          live_error_.load(std::memory_order_relaxed),    live_command_.load(std::memory_order_relaxed),
          live_lateness_.load(std::memory_order_relaxed), error_ >= 0};
}

LoopStatistics ControlLoop::statistics() const {
  LoopStatistics s = statistics_;
  s.glitches = device_.glitches(), s.clamped = device_.clamped(), s.rate_limited = device_.rate_limited();
  s.dropped_rows = log_.drops();
  if (const double timeout = device_.description().watchdog.timeout; timeout > 0)
    s.least_watchdog_margin_s = timeout - 1e-9 * double(longest_unkicked_ns_);
  for (size_t b = 0; b < block_sums_.size() && s.cycles > 0; ++b)
    if (block_sums_[b].total_ns > 0)
      s.blocks.push_back({stepper_.run().plan().blocks[b].path,
                          1e-3 * double(block_sums_[b].total_ns) / double(s.cycles),
                          1e-3 * double(block_sums_[b].longest_ns)});
  std::ranges::sort(s.blocks, std::ranges::greater{}, &BlockTime::mean_us);
  return s;
}

}  // namespace loopwright::hw
