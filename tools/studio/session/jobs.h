/// Long work beside the answers to other requests: cancellable, with progress; what is overtaken is dropped.
#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace loopwright::studio {

/// What a job sees of its owner. Thread-safe.
class Job {
 public:
  const std::atomic<bool>& interrupt() const { return interrupt_; }
  bool is_cancelled() const { return interrupt_; }

 private:
  friend class Jobs;
  std::atomic<bool> interrupt_{false};
  std::atomic<bool> is_done_{false};
  int64_t client_ = 0, id_ = 0;
  std::string lane_;
  std::function<void()> drop_;
};

/// Few enough that a burst of requests does not start a thread for each; others wait in order.
class Jobs {
 public:
  explicit Jobs(int most_at_once = 4);
  ~Jobs();  ///< cancels all and waits
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// Starts `work`. Earlier jobs of the client in the same lane are cancelled (an empty lane has only its own
  /// job). `drop` is called once, at once, when a job is cancelled before it has finished.
  void start(int64_t client, int64_t id, const std::string& lane, std::function<void(Job&)> work,
             std::function<void()> drop);
  void cancel(int64_t client, int64_t id);
  void cancel_all_of(int64_t client);
  /// True once, for whoever may answer: `false` if the job was cancelled before.
  bool finish(Job& job);
  size_t waiting_or_running() const;

 private:
  struct Waiting {
    std::shared_ptr<Job> job;
    std::function<void(Job&)> work;
  };
  void cancel(const std::shared_ptr<Job>& job);
  void run();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::shared_ptr<Job>> jobs_;  ///< waiting or running
  std::vector<Waiting> waiting_;
  bool ends_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace loopwright::studio
