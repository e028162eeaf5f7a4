#include "engine/graph/block_system.h"

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
  values_.resize(rows_.size() * N * N);
  matrix_.resize(N * size, N * size);
  matrix_.resizeNonZeros(static_cast<Eigen::Index>(values_.size()));
  int* inner = matrix_.innerIndexPtr();
  int* outer = matrix_.outerIndexPtr();
  *outer = 0;
  for (int column = 0; column < size; ++column) {
    for (int c = 0; c < N; ++c) {
      for (int b = first_[column]; b < first_[column + 1]; ++b)
        for (int r = 0; r < N; ++r) *inner++ = N * rows_[b] + r;
      outer[1] = outer[0] + stride_of(column);
      ++outer;
    }
  }
  set_zero();
  std::copy(values_.begin(), values_.end(), matrix_.valuePtr());
  solver_.analyzePattern(matrix_);
}

template <int N>
void BlockSystem<N>::set_zero() {
  std::fill(values_.begin(), values_.end(), 0.0);
}

template <int N>
int BlockSystem<N>::offset_of(int row, int column) const {
  const auto begin = rows_.begin() + first_[column], end = rows_.begin() + first_[column + 1];
  const auto block = static_cast<int>(std::lower_bound(begin, end, row) - begin);
  return N * N * first_[column] + N * block;
}

template <int N>
void BlockSystem<N>::add(int row, int column, const Block& block) {
  const int r = std::min(place_[row], place_[column]), c = std::max(place_[row], place_[column]);
  Eigen::Map<Block, 0, Eigen::OuterStride<>> target(values_.data() + offset_of(r, c),
                                                    Eigen::OuterStride<>(stride_of(c)));
  if (r == place_[row]) {
    target += block;
  } else {
    target += block.transpose();
  }
}

template <int N>
Eigen::VectorXd BlockSystem<N>::diagonal() const {
  Eigen::VectorXd result(N * place_.size());
  for (std::size_t i = 0; i < place_.size(); ++i) {
    const int k = place_[i];
    for (int c = 0; c < N; ++c) result[N * i + c] = values_[offset_of(k, k) + c * stride_of(k) + c];
  }
  return result;
}

template <int N>
bool BlockSystem<N>::factorise(const Eigen::VectorXd& added) {
  double* values = matrix_.valuePtr();
  std::copy(values_.begin(), values_.end(), values);
  for (std::size_t i = 0; i < place_.size(); ++i) {
    const int k = place_[i];
    for (int c = 0; c < N; ++c) values[offset_of(k, k) + c * stride_of(k) + c] += added[N * i + c];
  }
  solver_.factorize(matrix_);
  return solver_.info() == Eigen::Success &&
         (solver_.vectorD().size() == 0 || solver_.vectorD().minCoeff() > 0);
}

template <int N>
Eigen::MatrixXd BlockSystem<N>::solve(const Eigen::MatrixXd& right) const {
  Eigen::MatrixXd ordered(right.rows(), right.cols());
  for (std::size_t i = 0; i < place_.size(); ++i)
    ordered.middleRows<N>(N * place_[i]) = right.middleRows<N>(N * i);
  const Eigen::MatrixXd solved = solver_.solve(ordered);
  for (std::size_t i = 0; i < place_.size(); ++i)
    ordered.middleRows<N>(N * i) = solved.middleRows<N>(N * place_[i]);
  return ordered;
}

template class BlockSystem<3>;
template class BlockSystem<6>;

}  // namespace surefield
