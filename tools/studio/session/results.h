/// What jobs have computed and the page may ask for again: runs, records, comparisons, diagnoses.
#pragma once
#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include "engine/record/recording.h"
#include "tools/diagnose/diagnosis.h"
#include "tools/fit/fit.h"
#include "tools/report/thin.h"
#include "tools/studio/session/checked_text.h"

namespace loopwright::studio {

/// A recording, with what makes any window of it quick to draw.
struct Signals {
  Recording recording;
  std::vector<report::CurveSummary> summaries;  ///< of its columns behind the time
  explicit Signals(Recording recorded);
};

struct StoredRun {
  std::string path;                        ///< of the diagram
  Json facts;                              ///< as the answer of "run", without signals
  LoadOptions load;                        ///< with which it was read
  std::shared_ptr<const Signals> signals;  ///< null: of a kept run, on the disk
  std::set<std::string> held;              ///< signals that hold between samples
  std::string kept_as = {};                ///< in the folder of kept runs; empty: it is not kept
};

struct StoredComparison {
  std::shared_ptr<const Signals> signals;  ///< measured, simulated, error
};

struct StoredDiagnosis {
  std::shared_ptr<const Diagnosis> diagnosis;
  std::vector<std::string> experiments;  ///< relative to the folder
  LoadOptions load;
};

struct StoredFit {
  std::shared_ptr<const Fit> fit;
  int64_t revision;  ///< of the diagram that was fitted
};

/// Whether an entry stays for good.
template <class T> bool is_kept(const T&) { return false; }
inline bool is_kept(const StoredRun& run) { return !run.kept_as.empty(); }

/// Numbered from 1 on; of each kind the last ones stay, beside those that are kept. Thread-safe.
template <class T> class Store {
 public:
  explicit Store(size_t most) : most_(most) {}
  int64_t add(std::shared_ptr<const T> entry) {
    const std::lock_guard lock(mutex_);
    entries_.emplace(++last_, std::move(entry));
    const auto is_free = [](const auto& other) { return !is_kept(*other.second); };
    if (size_t(std::ranges::count_if(entries_, is_free)) > most_)
      entries_.erase(std::ranges::find_if(entries_, is_free));
    return last_;
  }
  void replace(int64_t number, std::shared_ptr<const T> entry) {
    const std::lock_guard lock(mutex_);
    if (const auto found = entries_.find(number); found != entries_.end()) found->second = std::move(entry);
  }
  std::shared_ptr<const T> find(int64_t number) const {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(number);
    return found == entries_.end() ? nullptr : found->second;
  }
  std::map<int64_t, std::shared_ptr<const T>> all() const {
    const std::lock_guard lock(mutex_);
    return entries_;
  }

 private:
  mutable std::mutex mutex_;
  std::map<int64_t, std::shared_ptr<const T>> entries_;
  int64_t last_ = 0;
  const size_t most_;
};

struct Results {
  Store<StoredRun> runs{30};
  Store<StoredComparison> comparisons{4};
  Store<StoredDiagnosis> diagnoses{4};
  Store<StoredFit> fits{4};
  /// The last record that was looked at.
  std::mutex record_mutex;
  std::string record_version;  ///< path, time and size of the file that was read
  std::shared_ptr<const Signals> record;
};

/// A window of signals, thinned to at most four numbers a pixel.
struct Window {
  std::vector<std::string> names;  ///< empty: all
  double from, to;                 ///< s
  size_t points = 1200;            ///< pixels
};
Json signals_json(const Signals& signals, const Window& window, const std::set<std::string>& held);

/// The rows of a window, unthinned.
Recording cut(const Recording& recording, const Window& window);

/// x and y, thinned; x ascends.
Json thinned_curve(std::span<const double> x, std::span<const double> y, size_t points);

}  // namespace loopwright::studio
