// The program as tests call it.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "backends/posix/durable_file.hpp"

namespace traceraft::testing {

struct ProgramEnd {
  int code;
  std::string output;  // stdout and stderr
};

inline ProgramEnd shell(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string output;
  char buffer[4096];
  while (const std::size_t count = fread(buffer, 1, sizeof buffer, pipe))
    output.append(buffer, count);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), output};
}

inline ProgramEnd traceraft(const std::string& arguments) {
  return shell(std::string(TRACERAFT_PROGRAM) + " " + arguments);
}

// Starts the program in the background; the caller ends it.
inline pid_t start_traceraft(const std::string& arguments) {
  const pid_t child = fork();
  if (child == 0) {
    const std::string command = "exec " + std::string(TRACERAFT_PROGRAM) + " " + arguments;
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  return child;
}

inline std::string content(const std::filesystem::path& path) {
  return posix::read_file(path, 1 << 28);
}

// Without its checksum, so that a test may change it and write it again.
inline nlohmann::json json_of(const std::filesystem::path& path) {
  nlohmann::json json = nlohmann::json::parse(content(path));
  json.erase("checksum");
  return json;
}

// Whether a text holds a fact: a name of a file, an option or a parameter, or a number. Sentences
// may change.
inline ::testing::AssertionResult names(const std::string& text, const std::string& fact) {
  if (text.find(fact) != std::string::npos)
    return ::testing::AssertionSuccess() << "'" << fact << "' is in:\n" << text;
  return ::testing::AssertionFailure() << "'" << fact << "' is not in:\n" << text;
}

// Whether bad input was answered by exit code 2 and a message with this fact.
inline ::testing::AssertionResult refuses(const ProgramEnd& end, const std::string& fact) {
  if (end.code != 2)
    return ::testing::AssertionFailure() << "it ended with " << end.code << ":\n" << end.output;
  return names(end.output, fact);
}

inline long lines_of(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return 0;
  const std::string text = content(path);
  return std::count(text.begin(), text.end(), '\n');
}

}  // namespace traceraft::testing
