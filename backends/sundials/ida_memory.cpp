#include "backends/sundials/ida_memory.hpp"

#include <ida/ida_impl.h>
#include <sundials/sundials_config.h>

#include "backends/sundials/state_vector.hpp"

// Not part of IDA's public headers, but exported: what IDASolve calls before the first step.
extern "C" int IDAInitialSetup(IDAMem memory);

namespace traceraft::sundials {
namespace {

// Applies an action to every number that changes from step to step.
template <class Action>
void for_each_number(IDAMem m, const Action& action) {
  for (realtype* list : {m->ida_psi, m->ida_alpha, m->ida_beta, m->ida_sigma, m->ida_gamma})
    for (int k = 0; k < MXORDP1; ++k) action(list[k]);
  for (int* number : {&m->ida_kk, &m->ida_kused, &m->ida_knew, &m->ida_phase, &m->ida_ns})
    action(*number);
  for (realtype* number :
       {&m->ida_h0u, &m->ida_hh, &m->ida_hused, &m->ida_eta, &m->ida_tn, &m->ida_tretlast,
        &m->ida_cj, &m->ida_cjlast, &m->ida_cjold, &m->ida_cjratio, &m->ida_ss, &m->ida_oldnrm,
        &m->ida_epsNewt, &m->ida_toldel, &m->ida_tolsf})
    action(*number);
  for (long* number : {&m->ida_nst, &m->ida_nre, &m->ida_ncfn, &m->ida_netf, &m->ida_nni,
                       &m->ida_nnf, &m->ida_nsetups})
    action(*number);
}

int vectors(IDAMem m) {
  return std::max(m->ida_maxord_alloc, 3) + 1;
}

}  // namespace

void save_ida_memory(void* memory, CheckpointOut out) {
  auto* m = static_cast<IDAMem>(memory);
  write_binary(out, std::int64_t{sizeof(*m)});
  write_binary(out, std::int64_t{vectors(m)});
  for_each_number(m, [&](const auto& number) { write_binary(out, number); });
  for (int k = 0; k < vectors(m); ++k) write_binary(out, Vec(view(m->ida_phi[k])));
  write_binary(out, Vec(view(m->ida_ee)));
}

void load_ida_memory(void* memory, CheckpointIn in) {
  auto* m = static_cast<IDAMem>(memory);
  std::int64_t size = 0, count = 0;
  read_binary(in, size);
  read_binary(in, count);
  if (size != std::int64_t{sizeof(*m)} || count != vectors(m))
    throw IoError("checkpoint: it was written with another version of IDA");
  if (IDAInitialSetup(m) != IDA_SUCCESS)
    throw IoError("checkpoint: IDA does not start with these options");
  m->ida_SetupDone = SUNTRUE;
  for_each_number(m, [&](auto& number) { read_binary(in, number); });
  Vec buffer;
  for (int k = 0; k < vectors(m); ++k) {
    // The first is the state, the others are divided differences.
    if (k == 0)
      read_binary(in, buffer, view(m->ida_phi[k]).size());
    else
      read_difference(in, buffer, view(m->ida_phi[k]).size());
    view(m->ida_phi[k]) = buffer;
  }
  read_difference(in, buffer, view(m->ida_ee).size());
  view(m->ida_ee) = buffer;
}

}  // namespace traceraft::sundials
