// CHOLMOD's settings and memory, of one thread at a time.
#pragma once

#include <suitesparse/cholmod.h>

namespace traceraft {

struct CholmodWorkspace {
  cholmod_common common;
  CholmodWorkspace() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.postorder = 1;
  }
  ~CholmodWorkspace() { cholmod_finish(&common); }
  CholmodWorkspace(const CholmodWorkspace&) = delete;
  CholmodWorkspace& operator=(const CholmodWorkspace&) = delete;
};

}  // namespace traceraft
