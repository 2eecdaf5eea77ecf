#include "backends/sundials/state_vector.hpp"

#include <cmath>
#include <memory>
#include <new>

#include "kernel/fem/csr.hpp"

namespace traceraft::sundials {
namespace {

struct Content {
  Vec data;
  const StateSpace* space;
};

Content& content(N_Vector v) {
  return *static_cast<Content*>(v->content);
}

const Communicator& ranks_of(N_Vector v) {
  return content(v).space->ranks;
}

void destroy(N_Vector v) {
  if (!v) return;
  delete static_cast<Content*>(v->content);
  v->content = nullptr;
  N_VFreeEmpty(v);
}

N_Vector clone(N_Vector v) {
  N_Vector copy = N_VNewEmpty(v->sunctx);
  if (!copy) return nullptr;
  N_VCopyOps(v, copy);
  try {  // no exception may pass through the functions of C that ask for copies
    // Its numbers are not set: a Krylov method asks for a hundred of them and touches few.
    copy->content = new Content{Vec(content(v).data.size()), content(v).space};
  } catch (const std::bad_alloc&) {
    N_VFreeEmpty(copy);
    return nullptr;
  }
  return copy;
}

double weighted_norm(N_Vector x, double weight_c, double weight_mu) {
  const Vec& data = content(x).data;
  const auto& norm = content(x).space->norm;
  const Eigen::Index n = data.size() / 2;
  const double c = weight_c != 0 ? weight_c * norm(data.head(n)) : 0;
  const double mu = weight_mu != 0 ? weight_mu * norm(data.tail(n)) : 0;
  return std::hypot(c, mu);
}

double norm_with_weights(N_Vector x, N_Vector w) {
  const Vec& weight = content(w).data;
  return weighted_norm(x, weight[0], weight[weight.size() / 2]);
}

double norm_with_mask(N_Vector x, N_Vector w, N_Vector id) {
  const Vec& weight = content(w).data;
  const Vec& mask = content(id).data;
  const Eigen::Index n = weight.size() / 2;
  return weighted_norm(x, mask[0] > 0 ? weight[0] : 0, mask[n] > 0 ? weight[n] : 0);
}

void set_operations(_generic_N_Vector_Ops& ops) {
  ops.nvgetvectorid = [](N_Vector) { return SUNDIALS_NVEC_CUSTOM; };
  ops.nvclone = clone;
  ops.nvcloneempty = clone;
  ops.nvdestroy = destroy;
  ops.nvspace = [](N_Vector v, sunindextype* reals, sunindextype* integers) {
    *reals = content(v).data.size();
    *integers = 1;
  };
  ops.nvgetarraypointer = [](N_Vector v) { return content(v).data.data(); };
  ops.nvgetlength = [](N_Vector v) -> sunindextype {
    return std::llround(ranks_of(v).sum(static_cast<double>(content(v).data.size())));
  };
  ops.nvlinearsum = [](double a, N_Vector x, double b, N_Vector y, N_Vector z) {
    content(z).data = a * content(x).data + b * content(y).data;
  };
  ops.nvconst = [](double value, N_Vector z) { content(z).data.setConstant(value); };
  ops.nvprod = [](N_Vector x, N_Vector y, N_Vector z) {
    content(z).data = content(x).data.cwiseProduct(content(y).data);
  };
  ops.nvdiv = [](N_Vector x, N_Vector y, N_Vector z) {
    content(z).data = content(x).data.cwiseQuotient(content(y).data);
  };
  ops.nvscale = [](double a, N_Vector x, N_Vector z) { content(z).data = a * content(x).data; };
  ops.nvabs = [](N_Vector x, N_Vector z) { content(z).data = content(x).data.cwiseAbs(); };
  ops.nvinv = [](N_Vector x, N_Vector z) { content(z).data = content(x).data.cwiseInverse(); };
  ops.nvaddconst = [](N_Vector x, double b, N_Vector z) {
    content(z).data = content(x).data.array() + b;
  };
  ops.nvdotprod = [](N_Vector x, N_Vector y) {
    return ranks_of(x).sum(fem::dot(content(x).data, content(y).data));
  };
  ops.nvmaxnorm = [](N_Vector x) { return ranks_of(x).max(content(x).data.cwiseAbs().maxCoeff()); };
  ops.nvmin = [](N_Vector x) { return ranks_of(x).min(content(x).data.minCoeff()); };
  ops.nvwrmsnorm = norm_with_weights;
  ops.nvwrmsnormmask = norm_with_mask;
}

}  // namespace

N_Vector new_state_vector(Eigen::Index size, const StateSpace& space, SUNContext context) {
  auto data = std::make_unique<Content>(Content{Vec::Zero(size), &space});
  N_Vector v = N_VNewEmpty(context);
  if (!v) throw std::bad_alloc();
  set_operations(*v->ops);
  v->content = data.release();
  return v;
}

Eigen::Map<Vec> view(N_Vector v) {
  Vec& data = content(v).data;
  return {data.data(), data.size()};
}

}  // namespace traceraft::sundials
