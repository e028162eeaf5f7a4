#include "engine/io/g2o_file.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <ostream>
#include <span>
#include <string>

#include "engine/io/files.h"
#include "engine/io/pose_numbers.h"
#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kMostId = 1e15;              // exact as a double
constexpr double kNegativeEigenvalue = 1e-6;  // of the largest: what is rounded may be below zero by
constexpr const char* kVertexTag = "VERTEX_SE3:QUAT";
constexpr const char* kEdgeTag = "EDGE_SE3:QUAT";
constexpr const char* kFixTag = "FIX";

/// The numbers behind the tag of a line.
struct G2oLine {
  TextPlace place;
  std::string tag;
  std::vector<double> numbers;

  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(place.file, place.line, problem);
  }
  void require_count(std::size_t count, const char* what) const {
    if (numbers.size() != count)
      fail(fmt::format("{} has {} numbers, not {}: {}", tag, numbers.size(), count, what));
  }
  std::int64_t id(std::size_t index) const {
    const double number = numbers[index];
    if (!(number == std::floor(number) && std::abs(number) < kMostId))
      fail(fmt::format("{} is no number of a vertex", number));
    return static_cast<std::int64_t>(number);
  }
  /// The pose of seven numbers, inverted: vertices and edges are the other way round than ours.
  Pose inverse_pose(std::size_t first) const {
    const Pose pose = pose_from_quaternion(place, std::span(numbers).subspan(first, 7));
    if (!pose.matrix().allFinite()) fail("the pose is not finite");
    return pose.inverse();
  }
};

G2oLine split_line(const std::filesystem::path& file, const TextLine& line) {
  const auto end = line.text.find_first_of(" \t");
  G2oLine result{{file, line.number}, printable(line.text.substr(0, end)), {}};
  if (result.tag.starts_with("PARAMS_")) return result;
  if (result.tag != kVertexTag && result.tag != kEdgeTag && result.tag != kFixTag)
    result.fail(fmt::format("\"{}\" is not read; a graph of 3-D poses has {}, {} and {}",
                            result.tag.substr(0, 60), kVertexTag, kEdgeTag, kFixTag));
  auto numbers = parse_numbers(end == std::string::npos ? "" : line.text.substr(end));
  if (!numbers) result.fail(fmt::format("something behind {} is no number", result.tag));
  result.numbers = *std::move(numbers);
  return result;
}

Matrix6 read_information(const G2oLine& line) {
  Matrix6 information;
  std::size_t next = 9;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column)
      information(row, column) = information(column, row) = line.numbers[next++];
  if (!information.allFinite()) line.fail("the information matrix is not finite");
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(information, Eigen::EigenvaluesOnly);
  const Vector6 values = eigen.eigenvalues();
  if (values[0] < -kNegativeEigenvalue * std::abs(values[5]))
    line.fail("the information matrix has a negative eigenvalue; an inverse of a covariance has none");
  return information;
}

class G2oReader {
 public:
  explicit G2oReader(const std::filesystem::path& file) {
    std::vector<G2oLine> edges, fixes;
    for (const TextLine& text : read_lines(file)) {
      G2oLine line = split_line(file, text);
      if (line.tag == kVertexTag) add_vertex(line);
      if (line.tag == kEdgeTag) edges.push_back(std::move(line));
      if (line.tag == kFixTag) fixes.push_back(std::move(line));
    }
    for (const G2oLine& line : edges) add_edge(line);
    for (const G2oLine& line : fixes)
      for (std::size_t i = 0; i < line.numbers.size(); ++i) graph_.vertices[vertex_of(line, i)].fixed = true;
    if (graph_.vertices.empty())
      throw InputError(file, fmt::format("has no {}; is it a g2o file?", kVertexTag));
  }

  G2oGraph take() { return std::move(graph_); }

 private:
  void add_vertex(const G2oLine& line) {
    line.require_count(8, "id, x y z, qx qy qz qw");
    const std::int64_t id = line.id(0);
    if (!places_.emplace(id, static_cast<int>(graph_.vertices.size())).second)
      line.fail(fmt::format("vertex {} stands in the file twice", id));
    graph_.vertices.push_back({id, line.inverse_pose(1), false});
  }

  int vertex_of(const G2oLine& line, std::size_t index) const {
    const std::int64_t id = line.id(index);
    const auto place = places_.find(id);
    if (place == places_.end()) line.fail(fmt::format("the file has no vertex {}", id));
    return place->second;
  }

  void add_edge(const G2oLine& line) {
    line.require_count(30, "two ids, x y z, qx qy qz qw, 21 of the information matrix");
    const int from = vertex_of(line, 0), to = vertex_of(line, 1);
    if (from == to) line.fail("the edge joins a vertex to itself");
    graph_.edges.push_back({from, to, line.inverse_pose(2), read_information(line)});
  }

  G2oGraph graph_;
  std::map<std::int64_t, int> places_;
};

std::string pose_text(const Pose& pose) {
  const Pose inverse = pose.inverse();
  Eigen::Quaterniond q(inverse.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Eigen::Vector3d t = inverse.translation();
  return fmt::format("{} {} {} {} {} {} {}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace

G2oGraph read_g2o(const std::filesystem::path& file) {
  return G2oReader(file).take();
}

void write_g2o(const std::filesystem::path& file, const G2oGraph& graph) {
  write_file(file, [&](std::ostream& stream) {
    for (const G2oGraph::Vertex& vertex : graph.vertices)
      stream << fmt::format("{} {} {}\n", kVertexTag, vertex.id, pose_text(vertex.pose));
    for (const G2oGraph::Vertex& vertex : graph.vertices)
      if (vertex.fixed) stream << fmt::format("{} {}\n", kFixTag, vertex.id);
    for (const RelativePose& edge : graph.edges) {
      stream << fmt::format("{} {} {} {}", kEdgeTag, graph.vertices[edge.from].id, graph.vertices[edge.to].id,
                            pose_text(edge.pose));
      for (int row = 0; row < 6; ++row)
        for (int column = row; column < 6; ++column)
          stream << fmt::format(" {}", edge.information(row, column));
      stream << '\n';
    }
  });
}

}  // namespace surefield
