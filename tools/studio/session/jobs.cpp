#include "tools/studio/session/jobs.h"
#include <algorithm>

namespace loopwright::studio {

Jobs::Jobs(int most_at_once) {
  for (int i = 0; i < most_at_once; ++i) threads_.emplace_back([this] { run(); });
}

Jobs::~Jobs() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    waiting_.clear();
    for (const auto& job : jobs_) job->interrupt_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Jobs::start(int64_t client, int64_t id, const std::string& lane, std::function<void(Job&)> work,
                 std::function<void()> drop) {
  auto job = std::make_shared<Job>();
  job->client_ = client, job->id_ = id, job->lane_ = lane, job->drop_ = std::move(drop);
  std::vector<std::shared_ptr<Job>> overtaken;
  {
    const std::lock_guard lock(mutex_);
    if (!lane.empty())
      std::ranges::copy_if(jobs_, std::back_inserter(overtaken), [&](const auto& other) {
        return other->client_ == client && other->lane_ == lane;
      });
    jobs_.push_back(job);
    waiting_.push_back({job, std::move(work)});
  }
  for (const auto& other : overtaken) cancel(other);
  changed_.notify_one();
}

void Jobs::cancel(const std::shared_ptr<Job>& job) {
  job->interrupt_ = true;
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(waiting_, [&](const Waiting& waiting) { return waiting.job == job; });
    std::erase(jobs_, job);
  }
  if (!job->is_done_.exchange(true)) job->drop_();
}

void Jobs::cancel(int64_t client, int64_t id) {
  std::shared_ptr<Job> found;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& job : jobs_)
      if (job->client_ == client && job->id_ == id) found = job;
  }
  if (found) cancel(found);
}

void Jobs::cancel_all_of(int64_t client) {
  std::vector<std::shared_ptr<Job>> found;
  {
    const std::lock_guard lock(mutex_);
    std::ranges::copy_if(jobs_, std::back_inserter(found),
                         [&](const auto& job) { return job->client_ == client; });
  }
  for (const auto& job : found) cancel(job);
}

bool Jobs::finish(Job& job) { return !job.is_done_.exchange(true); }

size_t Jobs::waiting_or_running() const {
  const std::lock_guard lock(mutex_);
  return jobs_.size();
}

void Jobs::run() {
  while (true) {
    Waiting next;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return ends_ || !waiting_.empty(); });
      if (ends_) return;
      next = std::move(waiting_.front());
      waiting_.erase(waiting_.begin());
    }
    next.work(*next.job);
    const std::lock_guard lock(mutex_);
    std::erase(jobs_, next.job);
  }
}

}  // namespace loopwright::studio
