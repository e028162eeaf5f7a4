#pragma once

#include <Eigen/SparseCholesky>
#include <utility>
#include <vector>

namespace surefield {

/// A sparse symmetric system of equations in blocks of N x N, for the same pattern again and again: unknowns
/// are ordered once for little fill (approximate minimum degree on the graph of blocks), the pattern of the
/// factor is found once. Sums are in the order of the calls. N is 3 or 6.
template <int N>
class BlockSystem {
 public:
  using Block = Eigen::Matrix<double, N, N>;

  /// Unknowns are numbered from 0 to size - 1; `pairs` are those that share an equation, in any order, more
  /// than once too.
  BlockSystem(int size, const std::vector<std::pair<int, int>>& pairs);

  void set_zero();
  /// Adds a block of the matrix, and its transpose on the other side of the diagonal. The pair must be one of
  /// the pattern, or twice the same unknown.
  void add(int row, int column, const Block& block);

  /// The diagonal, N numbers an unknown.
  Eigen::VectorXd diagonal() const;

  /// Decomposes the matrix with this added to its diagonal; false where it is not positive definite then.
  bool factorise(const Eigen::VectorXd& added);

  /// The solution for each column of `right`, N rows an unknown, after factorise().
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

 private:
  /// Where in values_ the first number of a block of the upper triangle is; columns lie stride_of(column)
  /// apart.
  int offset_of(int row, int column) const;
  int stride_of(int column) const { return N * (first_[column + 1] - first_[column]); }

  std::vector<int> place_;  ///< of each unknown in the order of elimination
  std::vector<int> first_;  ///< of each column of blocks in rows_
  std::vector<int> rows_;   ///< of the blocks of the upper triangle, column by column, ascending
  std::vector<double> values_;
  Eigen::SparseMatrix<double> matrix_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Upper, Eigen::NaturalOrdering<int>> solver_;
};

extern template class BlockSystem<3>;
extern template class BlockSystem<6>;

}  // namespace surefield
