// The kernel's rows, columns and fields as Tpetra sees them.
#pragma once

#include <Teuchos_RCP.hpp>
#include <Thyra_LinearOpBase.hpp>
#include <Thyra_VectorBase.hpp>
#include <Tpetra_CrsGraph.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <vector>

#include "kernel/fem/csr.hpp"

namespace traceraft::trilinos {

using TpetraMap = Tpetra::Map<>;
using TpetraGraph = Tpetra::CrsGraph<>;
using TpetraMatrix = Tpetra::CrsMatrix<double>;
using ThyraOperator = Teuchos::RCP<const Thyra::LinearOpBase<double>>;
using ThyraVector = Teuchos::RCP<Thyra::VectorBase<double>>;

// Rows are numbered rank by rank; columns are the kernel's local ones, ghosts at the end.
class TpetraSpace {
 public:
  // Collective. Every process of MPI has a rank of the pattern, or the pattern is of one rank only.
  explicit TpetraSpace(const fem::SparsityPattern& pattern);

  const Teuchos::RCP<const TpetraMap>& map() const { return map_; }
  Teuchos::RCP<TpetraMatrix> make_matrix() const;
  // matrix = scale · A
  void fill(double scale, const fem::CsrMatrix& A, TpetraMatrix& matrix) const;

 private:
  Teuchos::RCP<const TpetraMap> map_;
  Teuchos::RCP<const TpetraGraph> graph_;
  std::vector<int> position_;  // in the kernel's pattern, of every entry of Tpetra's
};

ThyraOperator as_operator(const Teuchos::RCP<const TpetraMatrix>& matrix);
const TpetraMatrix& as_matrix(const ThyraOperator& op);

// Between a field of this rank and a Thyra vector on the map.
void copy_to(VecView field, Thyra::VectorBase<double>& vector);
void copy_from(const Thyra::VectorBase<double>& vector, VecRef field);

}  // namespace traceraft::trilinos
