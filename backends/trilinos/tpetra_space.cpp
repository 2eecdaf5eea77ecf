#include "backends/trilinos/tpetra_space.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace traceraft::trilinos {
namespace {

using Teuchos::RCP;
using Teuchos::rcp;
using LocalIndex = TpetraMap::local_ordinal_type;
using GlobalIndex = TpetraMap::global_ordinal_type;

RCP<const Teuchos::Comm<int>> communicator(const Communicator& ranks) {
  if (ranks.size() == 1) return rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
  return Tpetra::getDefaultComm();
}

// The global numbers of the columns: mine, then those that the owners of the ghosts say.
RCP<const TpetraMap> column_map(const TpetraMap& rows, const Halo& halo) {
  const auto first = static_cast<double>(rows.getMinGlobalIndex());
  Vec buffer;
  const Vec numbers =
      halo.with_ghosts(Vec::LinSpaced(halo.owned, first, first + halo.owned - 1), buffer);
  std::vector<GlobalIndex> global;
  for (Eigen::Index i = 0; i < numbers.size(); ++i) global.push_back(std::llround(numbers[i]));
  return rcp(new TpetraMap(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                           Teuchos::ArrayView<const GlobalIndex>(global), 0, rows.getComm()));
}

RCP<const Tpetra::Vector<double>> tpetra_vector(const Thyra::VectorBase<double>& vector) {
  return Thyra::TpetraOperatorVectorExtraction<double>::getConstTpetraVector(
      Teuchos::rcpFromRef(vector));
}

}  // namespace

TpetraSpace::TpetraSpace(const fem::SparsityPattern& pattern) {
  const Halo& halo = pattern.halo;
  const auto comm = communicator(*halo.ranks);
  map_ = rcp(new TpetraMap(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                           static_cast<std::size_t>(pattern.rows()), 0, comm));
  const RCP<const TpetraMap> columns = column_map(*map_, halo);
  // Tpetra wants the columns of a row ascending in their local numbers.
  position_.resize(pattern.column.size());
  std::iota(position_.begin(), position_.end(), 0);
  for (int i = 0; i < pattern.rows(); ++i)
    std::sort(position_.begin() + pattern.row_begin[i],
              position_.begin() + pattern.row_begin[i + 1],
              [&](int a, int b) { return pattern.column[a] < pattern.column[b]; });
  Teuchos::ArrayRCP<std::size_t> begin(pattern.row_begin.size());
  Teuchos::ArrayRCP<LocalIndex> column(position_.size());
  std::copy(pattern.row_begin.begin(), pattern.row_begin.end(), begin.begin());
  for (std::size_t k = 0; k < position_.size(); ++k)
    column[static_cast<Teuchos::Ordinal>(k)] = pattern.column[position_[k]];
  const auto graph = rcp(new TpetraGraph(map_, columns, begin, column));
  graph->expertStaticFillComplete(map_, map_);
  graph_ = graph;
}

RCP<TpetraMatrix> TpetraSpace::make_matrix() const {
  const auto matrix = rcp(new TpetraMatrix(graph_));
  matrix->fillComplete(map_, map_);
  return matrix;
}

void TpetraSpace::fill(double scale, const fem::CsrMatrix& A, TpetraMatrix& matrix) const {
  const auto values = matrix.getLocalMatrixHost().values;
  for (std::size_t k = 0; k < position_.size(); ++k) values(k) = scale * A.values[position_[k]];
}

ThyraOperator as_operator(const RCP<const TpetraMatrix>& matrix) {
  const RCP<const Tpetra::Operator<double>> op = matrix;
  return Thyra::constTpetraLinearOp<double>(Thyra::tpetraVectorSpace<double>(op->getRangeMap()),
                                            Thyra::tpetraVectorSpace<double>(op->getDomainMap()),
                                            op);
}

const TpetraMatrix& as_matrix(const ThyraOperator& op) {
  const auto tpetra = Thyra::TpetraOperatorVectorExtraction<double>::getConstTpetraOperator(op);
  return dynamic_cast<const TpetraMatrix&>(*tpetra);
}

void copy_to(VecView field, Thyra::VectorBase<double>& vector) {
  const auto target =
      Thyra::TpetraOperatorVectorExtraction<double>::getTpetraVector(Teuchos::rcpFromRef(vector));
  const auto values = target->getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (Eigen::Index i = 0; i < field.size(); ++i) values(static_cast<std::size_t>(i), 0) = field[i];
}

void copy_from(const Thyra::VectorBase<double>& vector, VecRef field) {
  const auto values = tpetra_vector(vector)->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (Eigen::Index i = 0; i < field.size(); ++i) field[i] = values(static_cast<std::size_t>(i), 0);
}

}  // namespace traceraft::trilinos
