#pragma once

#include "engine/formats/triangle_mesh.h"
#include "engine/synth/scene.h"

namespace surefield {

/// The surfaces of all bodies of a scene, those that touch or reach into others included, without the
/// visitor. No triangle of a flat face is longer than some 0.15 m; round bodies are off by at most 0.5 mm.
/// Coloured by the mean colours of the materials, as they look in white light.
TriangleMesh make_scene_mesh(const Scene& scene);

}  // namespace surefield
