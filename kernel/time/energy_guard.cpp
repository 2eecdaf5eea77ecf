#include "kernel/time/energy_guard.hpp"

#include <cmath>

namespace traceraft::time {

void EnergyGuard::start(VecView y) {
  if (!active_) return;
  energy_ = candidate_ = problem_.energy(y);
  allowed_ = allowed_rise(energy_, problem_.energy_scale());
}

Status EnergyGuard::judge(VecView y) {
  if (!active_) return {};
  candidate_ = problem_.energy(y);
  if (candidate_ <= energy_ + allowed_) return {};  // not if it is NaN
  ++refused_;
  return Status::retry("the energy grows");
}

void EnergyGuard::save(CheckpointOut out) const {
  for (const double value : {allowed_, energy_}) write_binary(out, value);
  write_binary(out, refused_);
}

void EnergyGuard::load(CheckpointIn in, VecView y) {
  for (double* value : {&allowed_, &energy_}) read_binary(in, *value);
  read_binary(in, refused_);
  if (active_ && in.carried) energy_ = problem_.energy(y);
}

}  // namespace traceraft::time
