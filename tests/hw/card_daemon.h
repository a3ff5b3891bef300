/// The emulated card in its own process: it can be inspected after the process that drove it has ended.
#pragma once
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cstdio>
#include <stdexcept>
#include <string>
#include "where.h"

namespace loopwright::hw {

class CardDaemon {
 public:
  /// `world`: a file that is created; programs with HIL_EMU_SHARED=world use this card. `settings`: as in
  /// $HIL_EMU.
  CardDaemon(const std::string& world, const std::string& settings) {
    int to[2], from[2];
    if (pipe2(to, O_CLOEXEC) != 0 || pipe2(from, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    process_ = fork();
    if (process_ == 0) {
      dup2(to[0], STDIN_FILENO), dup2(from[1], STDOUT_FILENO);
      execl(LOOPWRIGHT_BINARY "/bin/hil_emulator_daemon", "hil_emulator_daemon", world.c_str(),
            settings.c_str(), nullptr);
      _exit(98);
    }
    close(to[0]), close(from[1]);
    in_ = fdopen(to[1], "w"), out_ = fdopen(from[0], "r");
    if (line() != "ready\n") throw std::runtime_error("the daemon does not begin");
  }
  ~CardDaemon() {
    fclose(in_), fclose(out_);
    waitpid(process_, nullptr, 0);
  }
  CardDaemon(const CardDaemon&) = delete;
  CardDaemon& operator=(const CardDaemon&) = delete;

  double get(const std::string& name) {
    fprintf(in_, "get %s\n", name.c_str());
    fflush(in_);
    return std::stod(line());
  }

 private:
  std::string line() {
    char text[128] = "";
    return fgets(text, sizeof text, out_) ? text : "";
  }
  pid_t process_;
  FILE *in_, *out_;
};

}  // namespace loopwright::hw
