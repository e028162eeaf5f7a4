#include "engine/graph/block_system.h"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <algorithm>

namespace surefield {

namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// The place of each unknown in an order of elimination that fills little.
std::vector<int> elimination_order(int size, const Pairs& pairs) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1);
  for (const auto& [a, b] : pairs)
    if (a != b) entries.emplace_back(std::min(a, b), std::max(a, b), 1);
  Eigen::SparseMatrix<double> pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Upper>(), order);
  std::vector<int> place(size);
  for (int k = 0; k < size; ++k) place[order.indices()[k]] = k;
  return place;
}

}  // namespace

template <int N>
BlockSystem<N>::BlockSystem(int size, const Pairs& pairs) : place_(elimination_order(size, pairs)) {
  std::vector<std::vector<int>> rows(size);
  for (int k = 0; k < size; ++k) rows[k].push_back(k);
  for (const auto& [a, b] : pairs)
    rows[std::max(place_[a], place_[b])].push_back(std::min(place_[a], place_[b]));
  first_.push_back(0);
  for (std::vector<int>& column : rows) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    rows_.insert(rows_.end(), column.begin(), column.end());
    first_.push_back(static_cast<int>(rows_.size()));
  }
  matrix_.assign(rows_.size(), Block::Zero());
  find_factor();
}

template <int N>
int BlockSystem<N>::find_reach(int k) {
  int top = size();
  seen_[k] = k;
  for (int b = first_[k]; b < first_[k + 1]; ++b) {
    int length = 0;
    for (int i = rows_[b]; seen_[i] != k; i = parents_[i]) {
      if (parents_[i] < 0) parents_[i] = k;
      reach_[length++] = i;
      seen_[i] = k;
    }
    while (length > 0) reach_[--top] = reach_[--length];
  }
  return top;
}

template <int N>
void BlockSystem<N>::find_factor() {
  parents_.assign(size(), -1);
  seen_.assign(size(), -1);
  reach_.resize(size());
  std::vector<int> counts(size(), 0);
  for (int k = 0; k < size(); ++k)
    for (int top = find_reach(k); top < size(); ++top) ++counts[reach_[top]];
  factor_first_.assign(1, 0);
  for (const int count : counts) factor_first_.push_back(factor_first_.back() + count);
  factor_rows_.resize(factor_first_.back());
  factor_.resize(factor_first_.back());
  diagonal_.resize(size());
  row_.assign(size(), Block::Zero());
}

template <int N>
void BlockSystem<N>::set_zero() {
  std::fill(matrix_.begin(), matrix_.end(), Block::Zero());
}

template <int N>
typename BlockSystem<N>::Block& BlockSystem<N>::at(int row, int column) {
  const auto begin = rows_.begin() + first_[column], end = rows_.begin() + first_[column + 1];
  return matrix_[std::lower_bound(begin, end, row) - rows_.begin()];
}

template <int N>
void BlockSystem<N>::add(int row, int column, const Block& block) {
  const int r = place_[row], c = place_[column];
  if (r <= c) {
    at(r, c) += block;
  } else {
    at(c, r) += block.transpose();
  }
}

template <int N>
Eigen::VectorXd BlockSystem<N>::diagonal() const {
  Eigen::VectorXd result(N * size());
  for (int i = 0; i < size(); ++i) result.segment<N>(N * i) = matrix_[first_[place_[i] + 1] - 1].diagonal();
  return result;
}

template <int N>
bool BlockSystem<N>::factorise(const Eigen::VectorXd& added) {
  for (int i = 0; i < size(); ++i) {
    const int k = place_[i];
    diagonal_[k] = matrix_[first_[k + 1] - 1];
    diagonal_[k].diagonal() += added.segment<N>(N * i);
  }
  filled_.assign(factor_first_.begin(), factor_first_.end());
  std::fill(seen_.begin(), seen_.end(), -1);
  for (int k = 0; k < size(); ++k) {
    int top = find_reach(k);
    for (int b = first_[k]; b < first_[k + 1] - 1; ++b) row_[rows_[b]] = matrix_[b];
    for (; top < size(); ++top) {
      const int i = reach_[top];
      const Block x = diagonal_[i].template triangularView<Eigen::Lower>().solve(row_[i]);
      row_[i].setZero();
      for (int p = factor_first_[i]; p < filled_[i]; ++p) row_[factor_rows_[p]].noalias() -= factor_[p] * x;
      diagonal_[k].noalias() -= x.transpose() * x;
      factor_rows_[filled_[i]] = k;
      factor_[filled_[i]++] = x.transpose();
    }
    const Eigen::LLT<Block> root(diagonal_[k]);
    if (root.info() != Eigen::Success) {
      std::fill(row_.begin(), row_.end(), Block::Zero());
      return false;
    }
    diagonal_[k] = root.matrixL();
  }
  return true;
}

template <int N>
Eigen::MatrixXd BlockSystem<N>::solve(const Eigen::MatrixXd& right) const {
  Eigen::MatrixXd x(right.rows(), right.cols()), result(right.rows(), right.cols());
  for (int i = 0; i < size(); ++i) x.middleRows<N>(N * place_[i]) = right.middleRows<N>(N * i);
  for (int k = 0; k < size(); ++k) {
    auto own = x.middleRows<N>(N * k);
    diagonal_[k].template triangularView<Eigen::Lower>().solveInPlace(own);
    for (int p = factor_first_[k]; p < factor_first_[k + 1]; ++p)
      x.middleRows<N>(N * factor_rows_[p]) -= factor_[p] * own;
  }
  for (int k = size() - 1; k >= 0; --k) {
    auto own = x.middleRows<N>(N * k);
    for (int p = factor_first_[k]; p < factor_first_[k + 1]; ++p)
      own -= factor_[p].transpose() * x.middleRows<N>(N * factor_rows_[p]);
    diagonal_[k].template triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  for (int i = 0; i < size(); ++i) result.middleRows<N>(N * i) = x.middleRows<N>(N * place_[i]);
  return result;
}

template class BlockSystem<3>;
template class BlockSystem<6>;

}  // namespace surefield
