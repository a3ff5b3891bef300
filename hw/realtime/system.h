/// What the computer grants a loop that must be on time: asked for, told, never assumed.
#pragma once
#include <string>
#include <vector>

namespace loopwright::hw {

struct SystemRequest {
  int priority = 80;   ///< of SCHED_FIFO; 0: the usual scheduling
  int processor = -1;  ///< the loop runs on this one only; -1: any
  bool lock_memory = true;
};

/// One thing that was asked for.
struct Granted {
  std::string what, answer;
  bool is_granted = false;
};
struct SystemReport {
  std::vector<Granted> items;
  bool all_granted() const;
};

/// For the whole process: kernel, locked memory, heap that is not given back, no deep sleep of the processor.
/// What it holds is released at the end of its life.
class RealTimeProcess {
 public:
  RealTimeProcess(const SystemRequest& request, SystemReport& report);
  ~RealTimeProcess();
  RealTimeProcess(const RealTimeProcess&) = delete;
  RealTimeProcess& operator=(const RealTimeProcess&) = delete;

 private:
  bool has_locked_ = false;
  int latency_file_ = -1;
};

/// For the calling thread: scheduling, processor, a stack that is there.
void make_thread_real_time(const SystemRequest& request, SystemReport& report);

/// One line an item, "SCHED_FIFO 80: granted".
std::string to_text(const SystemReport& report);

}  // namespace loopwright::hw
