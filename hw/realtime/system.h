/// What the computer grants to a real-time loop: requested and reported, never assumed.
#pragma once
#include <string>
#include <vector>

namespace loopwright::hw {

struct SystemRequest {
  int priority = 80;   ///< of SCHED_FIFO; 0: the default scheduling
  int processor = -1;  ///< the loop runs on this one only; -1: any
  bool lock_memory = true;
};

/// One requested item.
struct Granted {
  std::string what, answer;
  bool is_granted = false;
};
struct SystemReport {
  std::vector<Granted> items;
  bool all_granted() const;
};

/// For the whole process: kernel, locked memory, heap that is not returned, no deep sleep of the processor.
/// The destructor releases what it holds.
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

/// For the calling thread: scheduling, processor, a resident stack.
void make_thread_real_time(const SystemRequest& request, SystemReport& report);

/// One line per item, "SCHED_FIFO 80: granted".
std::string to_text(const SystemReport& report);

}  // namespace loopwright::hw
