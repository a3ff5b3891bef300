/// The processes of one `mpirun`: they share the blocks of a sweep, and each writes a file of its own.
#pragma once
#include <memory>
#include "tools/sweep/run_sweep.h"

namespace loopwright {

class Ranks {
 public:
  /// A single process, unless an MPI launcher started it and MPI was available at build time.
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  bool is_first() const;
  std::string name() const;  ///< "rank 2 of 4: "; empty for a single process
  /// Blocks are assigned one by one on request; no process writes before all have read.
  void join(SweepOptions& options);
  /// Waits until all processes have reached this call.
  void wait();

 private:
  struct Window;
  std::unique_ptr<Window> window_;
};

}  // namespace loopwright
