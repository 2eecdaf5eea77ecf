// One function per subcommand; each returns an exit code and throws InputError, IoError or
// LockedError.
#pragma once

#include <string>
#include <vector>

#include "drivers/configuration.hpp"

namespace traceraft {

struct RunRequest {
  GivenValues flags;
  std::string config_file;  // "" for none
  std::string out;          // "" for the first free runs/<case>-N
  bool validate = false;    // stop after checking everything
  bool quiet = false;
};
int run_command(const RunRequest& request);

struct ResumeRequest {
  std::string folder;
  GivenValues flags;  // options that do not change the numbers
  bool quiet = false;
};
int resume_command(const ResumeRequest& request);

struct VerifyRequest {
  std::vector<std::string> studies;  // names, or "all"
  bool quick = false;
};
int verify_command(const VerifyRequest& request);

int list_command();

}  // namespace traceraft
