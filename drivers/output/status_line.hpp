// One line rewritten on a terminal, a plain line now and then elsewhere.
#pragma once

#include <string>

#include "kernel/core/stopwatch.hpp"

namespace traceraft::output {

class StatusLine {
 public:
  explicit StatusLine(bool quiet);
  // Is it time for another line? At most five a second on a terminal, one in 15 s elsewhere.
  bool due() const;
  void show(double share, const std::string& text);  // share: of the work done, 0 to 1
  void finish();                                     // ends the line

 private:
  bool quiet_, terminal_;
  bool shown_ = false;
  Stopwatch since_;
};

// 3725 -> "1:02:05"
std::string clock_text(double seconds);

}  // namespace traceraft::output
