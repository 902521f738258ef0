#pragma once
// Organs of a run that are drawn as distance fields, ray-cast through their lattices and a scene's
// deformation (look.show = "implicit"; docs/methods/raycast.md).

#include "base/result.h"
#include "render/raycaster.h"
#include "render/surface_renderer.h"
#include "sim/scene.h"
#include "sim/state_textures.h"
#include "sim/triangle_mesh.h"

#include <memory>
#include <vector>

namespace serosa::app {

class ImplicitOrgans {
public:
    /// The scene's deformation as a texture. Errors, with the scene's line: a map that folds or does not fit.
    static Result<render::DeformationTexture> deformationTexture(const sim::Scene& scene);

    /// Adds an organ: its distance field, its lattice's displacement. Errors: an open surface, of the
    /// shaders. \param moves its lattice is asked where tissue is
    Status add(const sim::Scene& scene, const sim::TriangleMesh& metres, const sim::Lattice& lattice,
               const sim::TextureLayout& layout, bool moves);
    bool empty() const { return organs_.empty(); }
    /// Casters of the organs as their states have them, in the order in which they were added. \param drawn
    /// has their cut masks
    std::vector<render::Raycaster*> casters(const std::vector<const sim::StateTextures*>& states,
                                            const render::SurfaceRenderer& drawn);

private:
    struct Organ { // kept where it is: parts point at each other
        std::unique_ptr<render::DistanceVolume> field;
        std::unique_ptr<render::LatticeWarp> lattice;
        std::unique_ptr<render::Raycaster> caster;
    };
    std::unique_ptr<render::DeformationTexture> deformation_;
    std::vector<Organ> organs_;
};

} // namespace serosa::app
