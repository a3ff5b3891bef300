/// Fits that do not depend on each other, on all processors.
#include <algorithm>
#include <atomic>
#include <thread>
#include "tools/diagnose/predict/in_parallel.h"
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {
namespace {

/// Of fits that are offered at once there are hardly more; each thread has a model and a record of its own.
constexpr size_t most_threads = 8;

}  // namespace

struct SiteFitter::Other {
  std::unique_ptr<SiteModel> model;
  SiteFilter filter;
  SiteFitter fitter;

  explicit Other(const SiteFitter& of)
      : model(of.filter_.model().another()), filter(*model), fitter(filter, of.rows_, of.is_interrupted_) {}
  void learn(const SiteFitter& of) {
    model->set_substeps(of.filter_.model().substeps());
    filter.take_scales(of.filter_), fitter.offer(of.shapes_);
  }
};

void SiteFitter::side_by_side(size_t count, const std::function<void(SiteFitter&, size_t)>& fit) {
  const size_t threads =
      std::min({count, most_threads, std::max<size_t>(1, std::thread::hardware_concurrency())});
  std::erase_if(others_,
                [&](const auto& other) { return other->model->suppositions() != model().suppositions(); });
  while (others_.size() + 1 < threads) others_.push_back(std::make_shared<Other>(*this));
  std::vector<double> before;
  for (const auto& other : others_) other->learn(*this), before.push_back(other->model->work().done());
  std::atomic<size_t> next = 0;
  in_parallel(threads, [&](size_t t) {
    SiteFitter& fitter = t == 0 ? *this : others_[t - 1]->fitter;
    for (size_t i = next++; i < count; i = next++) fit(fitter, i);
  });
  for (size_t i = 0; i < others_.size(); ++i)
    model().work().add(1, others_[i]->model->work().done() - before[i]);
}

}  // namespace loopwright::diagnosis
