/// The `loopwright` program: one subcommand per file.
#include <malloc.h>
#include <sys/resource.h>
#include <exception>
#include <new>
#include <thread>
#include "engine/run/require_finished.h"
#include "tools/command/command.h"
#include "tools/command/command_line.h"
#include "tools/command/examples.h"

namespace loopwright {
namespace {

int run_program(int count, char** arguments) {
  CLI::App app{"Loopwright simulates block diagrams of motion control, and holds them against measurements."};
  app.require_subcommand(1);
  app.set_version_flag("--version", "loopwright " LOOPWRIGHT_VERSION);
  app.footer(
      "Exit codes: 0 done; 1 a run failed, or a check of a machine did; 2 wrong input, nothing was written;\n"
      "130 interrupted, what was computed is kept. Results go to stdout or where -o, --json and --report "
      "say;\n"
      "summaries go to stdout, or to stderr where results take it; problems and progress go to stderr, on a\n"
      "terminal in colours unless NO_COLOR is set.");
  std::function<int()> action;
  const auto choose = [&](std::function<int()> chosen) { action = std::move(chosen); };
  add_check(app, choose);
  add_run(app, choose);
  add_report(app, choose);
  add_plan(app, choose);
  add_new(app, choose);
  add_blocks(app, choose);
  add_schema(app, choose);
  add_look(app, choose);
  add_compare(app, choose);
  add_fit(app, choose);
  add_gp(app, choose);
  add_diagnose(app, choose);
  add_sweep(app, choose);
  add_deploy(app, choose);
  add_recover(app, choose);
  add_probe(app, choose);
  add_linearize(app, choose);
  add_design(app, choose);
  add_stability(app, choose);
  add_studio(app, choose);
  add_completion(app, choose);
  add_examples(app);
  try {
    app.parse(count, arguments);
    check_values(app);
    return action();
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    tell("{}\n", explain(app, e).text());
    return input_wrong;
  } catch (const InputError& e) {
    tell("{}\n", e.what());
    return input_wrong;
  } catch (const Interrupted& e) {
    tell("{}\n", e.what());
    return interrupted;
  } catch (const std::bad_alloc&) {
    tell("error: this needs more memory than there is\n");
    return run_failed;
  } catch (const std::exception& e) {
    tell("error: {}\n", e.what());
    return run_failed;
  }
}

/// Some work needs a larger stack than a system with small limits provides. A thread of its own, and the
/// threads that it starts, get a sufficient stack regardless of the limit.
template <class Work> int with_room_on_the_stack(Work&& work) {
  constexpr size_t enough = 8u << 20;  // bytes; the default of Linux
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= enough) return work();
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, enough);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
  int result = run_failed;
  std::thread([&] { result = work(); }).join();
  return result;
}

/// Columns as long as a record come and go all the time. Memory that is freed waits for the next of them,
/// instead of being given back to the system, which clears every page that it hands out again.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int largest_kept = 64 << 20, most_kept = 256 << 20;  // bytes
  mallopt(M_MMAP_THRESHOLD, largest_kept), mallopt(M_TRIM_THRESHOLD, most_kept);
#endif
}

}  // namespace
}  // namespace loopwright

int main(int count, char** arguments) {
  using namespace loopwright;
  keep_freed_memory();
  prepare_standard_streams();
  obey_interruption();
  const int result = with_room_on_the_stack([&] { return run_program(count, arguments); });
  return finish_answers() || result != done ? result : run_failed;
}
