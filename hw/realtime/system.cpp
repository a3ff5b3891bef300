#include "hw/realtime/system.h"
#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/utsname.h>
#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace loopwright::hw {
namespace {

void tell(SystemReport& report, std::string what, bool is_granted, std::string answer) {
  report.items.push_back({std::move(what), std::move(answer), is_granted});
}

void tell_kernel(SystemReport& report) {
  utsname name{};
  uname(&name);
  int flag = 0;
  std::ifstream("/sys/kernel/realtime") >> flag;
  const bool is_real_time = flag == 1 || std::strstr(name.version, "PREEMPT_RT");
  tell(report, "real-time kernel", is_real_time,
       fmt::format("{} {}", name.release, is_real_time ? "PREEMPT_RT" : "without PREEMPT_RT"));
}

/// Touches as much stack as a step could ever need, so that no page fault occurs later.
[[gnu::noinline]] void touch_stack() {
  volatile char stack[512 * 1024];
  for (size_t i = 0; i < sizeof stack; i += 4096) stack[i] = 0;
}

}  // namespace

bool SystemReport::all_granted() const {
  for (const Granted& item : items)
    if (!item.is_granted) return false;
  return true;
}

RealTimeProcess::RealTimeProcess(const SystemRequest& request, SystemReport& report) {
  tell_kernel(report);
  if (!request.lock_memory) return;
  mallopt(M_TRIM_THRESHOLD, -1);  // freed memory is not returned to the system
  mallopt(M_MMAP_MAX, 0);
  prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
  has_locked_ = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  tell(report, "memory locked", has_locked_,
       has_locked_ ? "all of it"
                   : fmt::format("{}; raise memlock in /etc/security/limits.conf", std::strerror(errno)));
  latency_file_ = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  const int32_t none = 0;
  const bool is_awake = latency_file_ >= 0 && write(latency_file_, &none, sizeof none) == sizeof none;
  tell(report, "processor kept awake", is_awake,
       is_awake ? "/dev/cpu_dma_latency" : fmt::format("/dev/cpu_dma_latency: {}", std::strerror(errno)));
}

RealTimeProcess::~RealTimeProcess() {
  if (has_locked_) munlockall();
  if (latency_file_ >= 0) close(latency_file_);
}

void make_thread_real_time(const SystemRequest& request, SystemReport& report) {
  touch_stack();
  if (request.priority > 0) {
    const sched_param parameter{request.priority};
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
    tell(report, fmt::format("SCHED_FIFO {}", request.priority), error == 0,
         error == 0 ? "granted"
                    : fmt::format("{}; raise rtprio in /etc/security/limits.conf", std::strerror(error)));
  }
  if (request.processor >= 0) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(request.processor, &set);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
    tell(report, fmt::format("processor {} only", request.processor), error == 0,
         error == 0 ? "granted" : std::strerror(error));
  }
}

std::string to_text(const SystemReport& report) {
  std::string text;
  for (const Granted& item : report.items)
    text += fmt::format("  {} {}: {}\n", item.is_granted ? "+" : "-", item.what, item.answer);
  return text;
}

}  // namespace loopwright::hw
