#pragma once

#include "engine/synth/scene.h"

namespace surefield {

/// One room of 7.2 x 5.8 m with desks, shelves, a meeting table and a blank wall.
Scene make_office(uint32_t seed);

/// Living room, kitchen, study and bedroom, 8.4 x 8.4 m, with a closed walk through four doorways.
Scene make_apartment(uint32_t seed);

/// A closed way, 1.9 m wide, around a block of 8.2 x 5.2 m.
Scene make_corridor(uint32_t seed);

/// 15 x 11 x 4.5 m with pillars and little else.
Scene make_hall(uint32_t seed);

/// Two rooms of 4.6 x 4.2 m that differ by a vase and some books alone, joined by a corridor; walks visit the
/// first, then the second.
Scene make_twins(uint32_t seed);

}  // namespace surefield
