// Sparse systems of blocks against a dense decomposition.
#include "engine/graph/block_system.h"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <cmath>

using namespace surefield;

namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// Any numbers, the same ones each time.
Eigen::MatrixXd numbers(int rows, int columns, double seed) {
  Eigen::MatrixXd m(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) m(i, j) = std::sin(17 * seed + 3.1 * i + 5.3 * j * j + 0.7 * i * j);
  return m;
}

template <int N>
void check_against_dense(int size, const Pairs& pairs) {
  using Block = typename BlockSystem<N>::Block;
  BlockSystem<N> system(size, pairs);
  // A second time on the same pattern: nothing of the first is left.
  for (const double seed : {1.0, 2.0}) {
    system.set_zero();
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(N * size, N * size);
    const auto add = [&](int i, int j, const Block& block) {
      system.add(i, j, block);
      dense.block<N, N>(N * i, N * j) += block;
      if (i != j) dense.block<N, N>(N * j, N * i) += block.transpose();
    };
    for (int i = 0; i < size; ++i) {
      const Block root = numbers(N, N, seed + i);
      add(i, i, root * root.transpose() + 40 * Block::Identity());
    }
    for (const auto& [i, j] : pairs) add(i, j, numbers(N, N, seed * i + j));
    const Eigen::VectorXd added = numbers(N * size, 1, seed).cwiseAbs();
    CHECK((system.diagonal() - dense.diagonal()).norm() < 1e-12);
    dense.diagonal() += added;
    const Eigen::MatrixXd right = numbers(N * size, 2, seed);
    REQUIRE(system.factorise(added));
    CHECK((system.solve(right) - dense.ldlt().solve(right)).norm() < 1e-12 * std::max(1, size));
    // Not positive definite, and then again.
    CHECK(system.factorise(-1e3 * Eigen::VectorXd::Ones(N * size)) == (size == 0));
    REQUIRE(system.factorise(added));
    CHECK((system.solve(right) - dense.ldlt().solve(right)).norm() < 1e-12 * std::max(1, size));
  }
}

/// A chain with a loop each `stride`, and some pairs twice and the other way round.
Pairs chain(int size, int stride) {
  Pairs pairs;
  for (int i = 0; i + 1 < size; ++i) pairs.emplace_back(i, i + 1);
  for (int i = 0; i + stride < size; i += 2) pairs.emplace_back(i + stride, i);
  if (size > 1) pairs.emplace_back(1, 0);
  return pairs;
}

}  // namespace

TEST_CASE("systems of blocks are solved as dense ones are") {
  for (const int size : {0, 1, 2, 3, 17, 40}) {
    INFO(size);
    check_against_dense<3>(size, chain(size, 5));
    check_against_dense<6>(size, chain(size, 7));
    check_against_dense<6>(size, {});
  }
  Pairs all;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < i; ++j) all.emplace_back(i, j);
  check_against_dense<6>(9, all);
}
