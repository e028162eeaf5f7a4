#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace surefield {

/// A sparse symmetric system of equations in blocks of N x N, for the same pattern again and again: unknowns
/// are ordered once for little fill (approximate minimum degree on the graph of blocks), the pattern of the
/// factor is found once. The decomposition L L' goes by rows on blocks as a whole (Davis, Direct Methods for
/// Sparse Linear Systems, 2006, "up-looking"), about three times as fast as Eigen's SimplicialLDLT on single
/// numbers. Sums are in the order of the calls. N is 3 or 6.
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
  using Matrix = std::vector<Block, Eigen::aligned_allocator<Block>>;

  void find_factor();
  /// The upper triangle's block, made where it is in matrix_.
  Block& at(int row, int column);
  /// Sets reach_ to the columns of the factor's row `k`, each behind those it needs; its end is size().
  int find_reach(int k);
  int size() const { return static_cast<int>(place_.size()); }

  std::vector<int> place_;  ///< of each unknown in the order of elimination
  std::vector<int> first_;  ///< of each column of blocks in rows_
  std::vector<int> rows_;   ///< of the blocks of the upper triangle, column by column, ascending
  Matrix matrix_;           ///< these blocks; those of the diagonal are the last of their columns

  std::vector<int> parents_;       ///< in the tree of elimination; -1 at its roots
  std::vector<int> factor_first_;  ///< of each column of the factor in factor_rows_
  std::vector<int> factor_rows_;   ///< of the factor's blocks below the diagonal
  Matrix factor_, diagonal_;       ///< these, and the lower triangles on it
  std::vector<int> filled_, seen_, reach_;
  Matrix row_;  ///< of the factor, in the making
};

extern template class BlockSystem<3>;
extern template class BlockSystem<6>;

}  // namespace surefield
