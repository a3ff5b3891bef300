/// The processes of one `mpirun`: they share the blocks of a sweep, each writes a file of its own.
#pragma once
#include <memory>
#include "tools/sweep/run_sweep.h"

namespace loopwright {

class Ranks {
 public:
  /// One process alone, unless an MPI launcher started it and MPI was there when this was built.
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  bool is_first() const;
  std::string name() const;  ///< "rank 2 of 4: "; empty for a process alone
  /// Blocks are handed out one by one to whoever asks; nobody writes before all have read.
  void join(SweepOptions& options);
  /// Until all have come here.
  void wait();

 private:
  struct Window;
  std::unique_ptr<Window> window_;
};

}  // namespace loopwright
