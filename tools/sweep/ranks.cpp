#include "tools/sweep/ranks.h"
#include <fmt/format.h>
#include <cstdlib>

#ifdef LOOPWRIGHT_MPI
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>
#endif

namespace loopwright {

#ifdef LOOPWRIGHT_MPI

/// A counter in the first rank to which every rank can add without the participation of the first one.
struct Ranks::Window {
  int rank = 0, size = 1;
  int64_t* counter = nullptr;
  MPI_Win window{};

  Window() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    MPI_Win_allocate(rank == 0 ? sizeof(int64_t) : 0, sizeof(int64_t), MPI_INFO_NULL, MPI_COMM_WORLD,
                     &counter, &window);
    if (rank == 0) *counter = 0;
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Win_lock_all(0, window);
  }
  ~Window() {
    // A rank that fails leaves the others in a barrier: all ranks end, and --resume continues.
    if (std::uncaught_exceptions() > 0) MPI_Abort(MPI_COMM_WORLD, 1);
    MPI_Win_unlock_all(window);
    MPI_Win_free(&window);
    MPI_Finalize();
  }
  int64_t next() {
    const int64_t one = 1;
    int64_t before = 0;
    MPI_Fetch_and_op(&one, &before, MPI_INT64_T, 0, 0, MPI_SUM, window);
    MPI_Win_flush(0, window);
    return before;
  }
  void wait() { MPI_Barrier(MPI_COMM_WORLD); }
};

Ranks::Ranks() {
  // Environment variables that the launchers of Open MPI, MPICH and Slurm set for a process.
  const bool is_launched =
      std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMI_SIZE") || std::getenv("PMIX_RANK");
  if (is_launched) window_ = std::make_unique<Window>();
}

#else

struct Ranks::Window {
  int rank = 0, size = 1;
  int64_t next() { return 0; }
  void wait() {}
};
Ranks::Ranks() = default;

#endif

Ranks::~Ranks() = default;

bool Ranks::is_first() const { return !window_ || window_->rank == 0; }

std::string Ranks::name() const {
  return window_ ? fmt::format("rank {} of {}: ", window_->rank, window_->size) : "";
}

void Ranks::join(SweepOptions& options) {
  if (!window_) return;
  options.writer = fmt::format("rank_{}", window_->rank);
  options.next_block = [this] { return window_->next(); };
  options.all_have_read = [this] { window_->wait(); };
}

void Ranks::wait() {
  if (window_) window_->wait();
}

}  // namespace loopwright
