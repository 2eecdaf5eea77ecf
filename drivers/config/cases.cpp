#include "drivers/config/cases.hpp"

namespace traceraft::config {

// The two vesicle cases are those of Zhiliakov, Wang, Quaini, Olshanskii, Majd, BBA Biomembranes
// 1863 (2021) 183446.
const NamedList<CaseEntry>& cases() {
  // Twice as fine along boundaries as the paper's mesh of 128 cells, in no more time, and with its
  // noise: drawn two refinements coarser than that mesh, as in the authors' parameter files.
  const std::vector<std::pair<std::string, std::string>> vesicle_mesh = {
      {"mesh", "adaptive"}, {"cells", "256"}, {"noise-cells", "32"}};
  static const std::vector<CaseEntry> entries = {
      {"guv-2to1",
       "giant vesicle, DOPC:DPPC 2:1 with 20 % cholesterol, 16 % raft",
       {{"raft-fraction", "0.16"}, {"diffusion", "2.5e-5"}},
       "2:1:20",
       vesicle_mesh},
      {"guv-3to1",
       "giant vesicle, DOPC:DPPC 3:1 with 20 % cholesterol, 10 % raft",
       {{"raft-fraction", "0.1"}, {"diffusion", "1e-5"}},
       "3:1:20",
       vesicle_mesh},
      {"spinodal",
       "50:50 mixture from nodal noise, wide phase boundaries",
       {{"raft-fraction", "0.5"},
        {"cells", "64"},
        {"epsilon", "0.25"},
        {"noise-cells", "64"},
        {"t-end", "0.5"}}},
      {"two-rafts",
       "a large and a small raft: the small one dissolves (seconds to run)",
       {{"initial", "caps"},
        {"initial-caps", "0 0 1 50; 0 0 -1 25"},
        {"mobility", "constant:value=0.25"},
        {"cells", "32"},
        {"epsilon", "0.4"},
        {"t-end", "1"}}},
  };
  static const NamedList<CaseEntry> list("case", entries);
  return list;
}

}  // namespace traceraft::config
