#include "backends/trilinos/teko_solver.hpp"

#include <Teko_PreconditionerInverseFactory.hpp>
#include <Teko_RequestHandler.hpp>
#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Thyra_DefaultProductVector.hpp>
#include <Thyra_DefaultProductVectorSpace.hpp>
#include <Thyra_VectorStdOps.hpp>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <functional>
#include <mutex>
#include <sstream>
#include <stdexcept>

#include "backends/trilinos/belos_method.hpp"
#include "backends/trilinos/inverse_library.hpp"
#include "backends/trilinos/runtime.hpp"
#include "backends/trilinos/two_solve_factory.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/linear/setup_policy.hpp"
#include "kernel/linear/two_solve_preconditioner.hpp"

namespace traceraft {
namespace {

using Teuchos::ParameterList;
using Teuchos::RCP;
using Teuchos::rcp;

// Measured at n = 128: a new hierarchy costs about as much as 5 iterations.
constexpr long kSetupPrice = 5;
// A solution whose residual is larger than asked for by more than rounding is none.
constexpr double kSlack = 1.01;

// Everything that does not change from solver to solver.
struct Setting {
  PatternPtr pattern;
  TpetraSpace space;
  std::string preconditioner, method;
  ParameterList belos;
  RCP<Teko::InverseLibrary> library;
  bool always_new = false;
  std::size_t file_checksum = 0;  // of the parameter file
};

// With the exact tangent B + sM must be positive definite, which no approximate inverse notices.
// The constant function tells where f0'' is negative on the whole.
TwoSolveShifts shifts_of(const BlockJacobian& J, double area) {
  double sum = 0;
  for (const double value : J.mc.values) sum -= value;
  const double mean = J.ranks().sum(sum) / area;  // of f0''; the stiffness has no part in it
  TwoSolveShifts shifts = two_solve_shifts(J);
  for (int attempt = 1; attempt < kMostShifts && mean - shifts.q <= 0; ++attempt)
    shifts = two_solve_shifts(J, attempt);
  return shifts;
}

class TekoSolver final : public LinearSolver {
 public:
  TekoSolver(std::shared_ptr<const Setting> setting, int lanes)
      : setting_(std::move(setting)), shared_(lanes, kSetupPrice), lanes_(lanes) {
    const TpetraSpace& space = setting_->space;
    for (RCP<TpetraMatrix>& block : blocks_) block = space.make_matrix();
    A_ = Thyra::block2x2<double>(as_operator(blocks_[0]), as_operator(blocks_[1]),
                                 as_operator(blocks_[2]), as_operator(blocks_[3]));
    handler_ = rcp(new Teko::RequestHandler);
    handler_->addRequestCallback(rcp(new TwoSolveCallback(request_)));
    setting_->library->setRequestHandler(handler_);
    factory_ = setting_->library->getInverseFactory(setting_->preconditioner);
    for (Lane& lane : lanes_) {
      lane.method = make_belos_method(setting_->method, setting_->belos);
      lane.b = Thyra::createMember(A_->range());
      lane.x = Thyra::createMember(A_->domain());
    }
  }

  std::string name() const override { return "teko"; }
  bool shares_factors() const override { return true; }

  Status setup(const BlockJacobian& J, int) override {
    const ScopedTimer timer(shared_.seconds());
    shared_.begin(J.shift);
    fill(J);
    double area = 0;
    for (const double value : J.mm.values) area += value;
    const TwoSolveShifts shifts = shifts_of(J, J.ranks().sum(area));
    request_ = {shifts.p, shifts.q, row_scale_};
    const Status status = guarded("no preconditioner", [&]() -> Status {
      if (inverse_.is_null())
        inverse_ = Teko::buildInverse(*factory_, A_);
      else
        Teko::rebuildInverse(*factory_, A_, inverse_);
      return {};
    });
    if (status.ok())
      shared_.succeed();
    else
      inverse_ = Teuchos::null;
    return status;
  }

  bool wants_setup(const BlockJacobian& J, int) const override {
    return setting_->always_new || shared_.worn(J.shift);
  }

  SolveReport solve(const BlockJacobian& J, ConstVec b, VecRef x, double tolerance,
                    int lane_number) override {
    // Trilinos keeps what it computes with in its objects.
    const std::lock_guard lock(one_at_a_time_);
    Lane& lane = lanes_[lane_number];
    LinearStatistics& statistics = shared_.of_lane(lane_number);
    const ScopedTimer timer(statistics.solve_seconds);
    ++statistics.solves;
    if (!shared_.ready()) return {Status::retry("there is no preconditioner")};
    fill(J);
    const int n = J.block_size();
    copy_halves(b, 1 / row_scale_, *lane.b);
    copy_halves(x, 1, *lane.x);
    SolveReport report;
    report.status = guarded("Belos", [&] {
      report = lane.method->solve(A_, inverse_, lane.b, lane.x, tolerance);
      return report.status;
    });
    shared_.count(lane_number, report.iterations);
    if (!report.status.ok()) {
      lane.method->forget();
      return report;
    }
    copy_from(*block(*lane.x, 0), x.head(n));
    copy_from(*block(*lane.x, 1), x.tail(n));
    report.status = verified(J, b, x, tolerance);
    if (report.status.ok()) restore_mass(J, b, x);
    return report;
  }

  LinearStatistics statistics() const override { return shared_.statistics(); }
  void save(CheckpointOut out) const override {
    write_binary(out, setting_->file_checksum);
    shared_.save(out);
    // What a method has recycled is not saved: the run goes on like one that is resumed here.
    for (const Lane& lane : lanes_) lane.method->forget();
  }
  void load(CheckpointIn in) override {
    std::size_t checksum = 0;
    read_binary(in, checksum);
    if (checksum != setting_->file_checksum)
      throw IoError("the file of --teko-parameters is not the one that the run was started with");
    shared_.load(in);
  }

 private:
  // Trilinos turns what goes wrong into exceptions of many kinds. With several ranks the others may
  // wait for this one within a library: only the end of all of them is safe.
  template <class Action>
  Status guarded(const char* what, const Action& action) const {
    try {
      return action();
    } catch (const std::exception& error) {
      const std::string complaint = teko_complaints(), reason = error.what();
      const std::string why = std::string(what) + ": " +
                              (complaint.empty() ? reason.substr(0, reason.find('\n')) : complaint);
      if (setting_->pattern->halo.ranks->size() > 1) throw std::runtime_error("teko: " + why);
      return Status::retry(why);
    }
  }

  struct Lane {
    std::unique_ptr<BelosMethod> method;
    ThyraVector b, x;
  };

  static RCP<Thyra::VectorBase<double>> block(Thyra::VectorBase<double>& vector, int which) {
    return dynamic_cast<Thyra::ProductVectorBase<double>&>(vector).getNonconstVectorBlock(which);
  }
  static void copy_halves(ConstVec field, double first_scale, Thyra::VectorBase<double>& vector) {
    const Eigen::Index n = field.size() / 2;
    copy_to(first_scale * field.head(n), *block(vector, 0));
    copy_to(field.tail(n), *block(vector, 1));
  }

  // Belos judges by one norm: the first block row is divided by the shift.
  void fill(const BlockJacobian& J) {
    row_scale_ = J.shift > 0 ? J.shift : 1;
    const TpetraSpace& space = setting_->space;
    space.fill(1 / row_scale_, J.cc, *blocks_[0]);
    space.fill(1 / row_scale_, J.cm, *blocks_[1]);
    space.fill(1, J.mc, *blocks_[2]);
    space.fill(1, J.mm, *blocks_[3]);
  }

  Status verified(const BlockJacobian& J, ConstVec b, ConstVec x, double tolerance) const {
    Vec residual(b.size());
    J.multiply(x, residual, team_);
    residual = b - residual;
    // NaN is refused, too.
    if (scaled_norm(J, residual) <= kSlack * tolerance * scaled_norm(J, b)) return {};
    return Status::retry("the residual is larger than Belos says");
  }

  std::shared_ptr<const Setting> setting_;
  SharedSetup shared_;
  std::vector<Lane> lanes_;
  std::array<RCP<TpetraMatrix>, 4> blocks_;
  ThyraOperator A_;
  TwoSolveRequest request_;
  RCP<Teko::RequestHandler> handler_;
  RCP<Teko::InverseFactory> factory_;
  Teko::InverseLinearOp inverse_;
  ThreadTeam team_{1};
  std::mutex one_at_a_time_;
  double row_scale_ = 1;
};

std::string option(const TekoOptions& options, const char* name, const char* otherwise) {
  const auto found = options.find(name);
  return found == options.end() ? otherwise : found->second;
}

// What is wrong with one of the options.
[[noreturn]] void refuse(const char* option, const std::string& why) {
  throw OptionError(option, why);
}

// A name of ours or of a sublist of the user's.
std::string one_of(const TekoOptions& options, const char* name, const char* otherwise,
                   std::vector<std::string> names, const ParameterList& own = ParameterList()) {
  const std::string word = option(options, name, otherwise);
  for (auto entry = own.begin(); entry != own.end(); ++entry) names.push_back(own.name(entry));
  if (std::find(names.begin(), names.end(), word) == names.end())
    refuse(name, unknown_name_message(name, word, names));
  return word;
}

// The lists of a parameter file, and a checksum of it.
struct ParameterFile {
  ParameterList lists;
  std::size_t checksum = 0;
};

ParameterFile read_parameters(const std::string& path) {
  ParameterFile file;
  if (path.empty()) return file;
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream || text.str().empty())
    refuse("parameters", path + ": cannot be read: " + std::strerror(errno ? errno : ENODATA));
  file.checksum = std::hash<std::string>()(text.str());
  try {
    Teuchos::updateParametersFromXmlString(text.str(), Teuchos::ptrFromRef(file.lists));
  } catch (const std::exception& error) {
    const std::string why = error.what();
    refuse("parameters", path + ": no Teuchos parameter list: " + why.substr(0, why.find('\n')));
  }
  for (auto entry = file.lists.begin(); entry != file.lists.end(); ++entry) {
    const std::string& name = file.lists.name(entry);
    if (name != "Inverse Library" && name != "Belos")
      refuse("parameters",
             path + ": " + unknown_name_message("sublist", name, {"Inverse Library", "Belos"}));
    if (!file.lists.isSublist(name)) refuse("parameters", path + ": " + name + " is no sublist");
  }
  const ParameterList& inverses = file.lists.sublist("Inverse Library");
  for (auto entry = inverses.begin(); entry != inverses.end(); ++entry)
    if (!inverses.isSublist(inverses.name(entry)) ||
        !inverses.sublist(inverses.name(entry)).isParameter("Type"))
      refuse("parameters", path + ": the inverse " + inverses.name(entry) +
                               " needs a sublist with the parameter Type");
  return file;
}

// What Trilinos does not know of a user's lists is the file's fault.
template <class Make>
auto said_of_file(const std::string& path, const Make& make) {
  try {
    return make();
  } catch (const std::exception& error) {
    if (path.empty()) throw;
    const std::string complaint = teko_complaints(), why = error.what();
    refuse("parameters", path + ": " + (complaint.empty() ? why : complaint));
  }
}

}  // namespace

LinearSolverFactory make_teko_solver(const PatternPtr& pattern, const TekoOptions& options) {
  start_trilinos();
  const std::string path = option(options, "parameters", "");
  ParameterFile file = read_parameters(path);
  const ParameterList& own = file.lists.sublist("Inverse Library");
  const ParameterList belos = file.lists.sublist("Belos");
  const std::string inverse = one_of(options, "inverse", "muelu", kTekoInverses, own);
  if (inverse == "direct" && pattern->halo.ranks->size() > 1)
    refuse("inverse", "direct works on one rank only; choose muelu or ifpack2");
  const std::string method = one_of(options, "method", "fgmres", kBelosMethods);
  (void)said_of_file(path, [&] { return make_belos_method(method, belos); });
  const auto setting = std::make_shared<Setting>(
      Setting{pattern, TpetraSpace(*pattern),
              one_of(options, "preconditioner", "two-solve", kTekoPreconditioners, own), method,
              belos, said_of_file(path, [&] { return make_inverse_library(inverse, own); }),
              one_of(options, "renewal", "worn", {"worn", "always"}) == "always", file.checksum});
  return [setting](int lanes) { return std::make_unique<TekoSolver>(setting, lanes); };
}

}  // namespace traceraft
