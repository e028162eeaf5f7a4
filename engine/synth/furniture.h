#pragma once

#include <vector>

#include "engine/synth/palette.h"
#include "engine/synth/scene_builder.h"

namespace surefield {

/// Builds pieces of furniture. Each stands at a Spot (its front faces -y at 0 degrees) and is one object of
/// the scene; things that hang on a wall have their Spot on the wall's surface. Sizes in metres. Colours and
/// small measures vary with the builder's random numbers.
class Furniture {
 public:
  explicit Furniture(SceneBuilder& builder) : b_(builder), p_(builder) {}

  const Palette& palette() const { return p_; }

  void desk(const Spot& spot, double width);
  void work_place(const Spot& desk);  ///< monitor, keyboard and small things on a desk at that spot
  void chair(const Spot& spot);
  void swivel_chair(const Spot& spot);
  void round_table(const Spot& spot, double radius);
  void dining_table(const Spot& spot, double length);
  void low_table(const Spot& spot);
  void shelf(const Spot& spot, double width, int boards);
  void cabinet(const Spot& spot, double width, double height);
  void sofa(const Spot& spot, double width);
  void bed(const Spot& spot);
  void kitchen_row(const Spot& spot, double width);
  void plant(const Spot& spot, double height);
  void thicket(const Spot& spot, double height);  ///< a plant of many thin stems
  void floor_lamp(const Spot& spot);
  void boxes(const Spot& spot, int count);
  void bin(const Spot& spot);
  void rug(const Spot& spot, double length, double width);
  void ball(const Spot& spot, double radius);
  void pillar(const Spot& spot, double radius, double height);
  void bench(const Spot& spot, double length);

  void books(const Spot& top);  ///< a small stack
  void mug(const Spot& top);
  void bowl(const Spot& top);
  void laptop(const Spot& top);
  void papers(const Spot& top);
  void desk_lamp(const Spot& top);
  void vase(const Spot& top);

  void poster(const Spot& on_wall, double width, double height);
  void whiteboard(const Spot& on_wall);
  void clock(const Spot& on_wall);
  void radiator(const Spot& on_wall, double width);
  void ceiling_lamp(const Eigen::Vector3d& at, const Eigen::Vector3f& colour, double range);
  /// A closed door in an opening of that size; the Spot is on the floor in the wall's inner plane.
  void door(const Spot& in_wall, double width, double height);
  /// A closed door on the face of a wall without an opening.
  void door_leaf(const Spot& on_wall, double width, double height);
  /// The lining of an open doorway through two walls; the Spot is in the middle between their far faces.
  void doorway(const Spot& between, double width, double height);
  /// Frame and view of a window; the Spot is the middle of the sill in the wall's inner plane.
  void window(const Spot& in_wall, double width, double height);

  /// Somebody who walks along a closed polygon on the floor, away from the circuit; see Scene::visitor.
  void visitor(const std::vector<Eigen::Vector2d>& track);

 private:
  template <typename List>
  int any(const List& list) {
    return list[static_cast<std::size_t>(b_.random.index(static_cast<int>(list.size())))];
  }
  void legs(double width, double depth, double height, double thickness, int material);
  void book_row(double left, double right, double z, double depth);
  void foliage(const Eigen::Vector3d& crown, double radius, int count, double leaf_length);

  SceneBuilder& b_;
  Palette p_;
};

/// A hole in a wall: from and to along the wall, low and high above the floor, metres.
struct Opening {
  double from = 0, to = 0, low = 0, high = 0;
};

/// A box-shaped room with walls 0.1 m thick outside its inner measures. Walls in the order low x, high x,
/// low y, high y; openings are measured along y for the first two, along x for the others, in the world.
struct RoomPlan {
  Eigen::Vector3d low, high;
  int walls[4] = {0, 0, 0, 0};
  int floor = 0, ceiling = 0, skirting = 0;
  std::vector<Opening> openings[4];
};

inline constexpr double kWallThickness = 0.1;

/// Builds floor, ceiling, walls around the openings, and skirting boards.
void build_room(SceneBuilder& builder, const RoomPlan& plan);

}  // namespace surefield
