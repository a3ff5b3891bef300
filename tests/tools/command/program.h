/// Runs the built program like a user: its outputs and its exit code.
#pragma once
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>
#include <string>
#include <vector>
#include "tests/engine/diagram/diagram_folder.h"
#include "where.h"

namespace loopwright {

/// The program of this build, or the one that $LOOPWRIGHT_PROGRAM names.
inline std::string program() {
  const char* other = std::getenv("LOOPWRIGHT_PROGRAM");
  return other ? other : LOOPWRIGHT_PROGRAM;
}

struct Outcome {
  int code = -1;  ///< exit code; 128 + signal if a signal ended it
  std::string out, err;
};

inline std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A started program, with its output in files of its own folder.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments, const std::string& folder = "") {
    arguments.insert(arguments.begin(), program());
    const std::string out = output_.path("out"), err = output_.path("err");
    std::vector<char*> raw;
    for (std::string& argument : arguments) raw.push_back(argument.data());
    raw.push_back(nullptr);
    process_ = fork();
    if (process_ != 0) return;
    dup2(open(out.c_str(), O_CREAT | O_WRONLY, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_CREAT | O_WRONLY, 0600), STDERR_FILENO);
    if (!folder.empty() && chdir(folder.c_str()) != 0) _exit(99);
    execv(raw[0], raw.data());
    _exit(98);
  }
  void send(int signal) const { kill(process_, signal); }
  std::string err() const { return text_of(output_.path("err")); }
  Outcome wait() {
    int status = 0;
    waitpid(process_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(output_.path("out")),
            err()};
  }

 private:
  DiagramFolder output_;
  pid_t process_ = -1;
};

inline Outcome loopwright_program(std::vector<std::string> arguments, const std::string& folder = "") {
  return Program(std::move(arguments), folder).wait();
}

inline bool contains(std::string_view text, std::string_view part) { return text.find(part) != text.npos; }

}  // namespace loopwright
