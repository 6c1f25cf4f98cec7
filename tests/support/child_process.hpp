#pragma once

#include <array>
#include <csignal>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/descriptor.hpp"

namespace yuragi {

/// A program beside the test, ended with it. Its standard output and error come in one stream, line by line.
class ChildProcess {
 public:
  explicit ChildProcess(const std::vector<std::string>& command) {
    std::array<int, 2> in{};
    std::array<int, 2> out{};
    if (pipe2(in.data(), O_CLOEXEC) != 0 || pipe2(out.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    std::vector<char*> words;
    words.reserve(command.size() + 1);
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);

    pid_ = fork();
    if (pid_ == 0) {
      dup2(in[0], STDIN_FILENO);
      dup2(out[1], STDOUT_FILENO);
      dup2(out[1], STDERR_FILENO);
      execvp(words[0], words.data());
      _exit(127);
    }
    close(in[0]);
    close(out[1]);
    in_ = Descriptor(in[1]);
    out_ = Descriptor(out[0]);
    if (pid_ < 0) throw std::runtime_error("no process");
  }
  ~ChildProcess() {
    if (pid_ > 0) end(SIGKILL);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void type(const std::string& line) {
    const std::string bytes = line + "\n";
    if (write(in_.get(), bytes.data(), bytes.size()) < 0) throw std::runtime_error("the program does not listen");
  }
  void close_input() { in_.reset(); }

  /// A signal that does not end it (SIGSTOP, SIGCONT).
  void send(int signal_number) const { kill(pid_, signal_number); }

  /// What follows `beginning` on the next line that begins so. Throws if the output ends first, or nothing comes for 60
  /// s.
  std::string line_after(const std::string& beginning) {
    for (std::string line;;) {
      pollfd wait{out_.get(), POLLIN, 0};
      char c = 0;
      if (poll(&wait, 1, 60'000) != 1 || read(out_.get(), &c, 1) != 1) break;
      if (c != '\n') {
        line += c;
        continue;
      }
      if (line.starts_with(beginning)) return line.substr(beginning.size());
      line.clear();
    }
    throw std::runtime_error("no line that begins with \"" + beginning + "\"");
  }

  /// All that is still to come, until the program closes its output.
  std::string rest() {
    std::string text;
    std::array<char, 4096> block{};
    for (ssize_t size = 0; (size = read(out_.get(), block.data(), block.size())) > 0;) {
      text.append(block.data(), static_cast<std::size_t>(size));
    }
    return text;
  }

  /// Waits for the program's own end; its exit code, or 128 and more for a signal.
  int wait() { return end(0); }

  int end(int signal_number) {
    if (signal_number != 0) kill(pid_, signal_number);
    int status = 0;
    waitpid(std::exchange(pid_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t pid_ = -1;
  Descriptor in_, out_;
};

}  // namespace yuragi
