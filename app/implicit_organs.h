#pragma once
// Organs of a run that are drawn as distance fields, ray-cast through their lattices and a scene's
// deformation (look.show = "implicit"; docs/methods/raycast.md).

#include "app/scene_deformation.h"
#include "base/result.h"
#include "render/depth_maps.h"
#include "render/raycaster.h"
#include "render/surface_renderer.h"
#include "sim/scene.h"
#include "sim/state_textures.h"
#include "sim/triangle_mesh.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace serosa::app {

class ImplicitOrgans {
public:
    /// Adds an organ: its distance field or depth maps, its lattice's displacement. Errors: an open surface,
    /// of the shaders. \param moves its lattice is asked where tissue is
    Status add(const sim::Scene& scene, const sim::TriangleMesh& metres, const sim::Lattice& lattice,
               const sim::TextureLayout& layout, bool moves);
    /// What the surface pass leaves to the box of a scene that is drawn in two stages (look.stage); after all
    /// were added. Errors: a box that meets no organ, of the shaders.
    struct OpenedSurface {
        const sim::Lattice* lattice;
        const sim::TriangleMesh* metres;
        const render::SurfaceBinding* binding;
    };
    Status open(render::SurfaceRenderer& renderer, const std::vector<OpenedSurface>& surfaces);
    /// Moves the deformations to where they are at a time, in what is drawn from now on. Errors: of
    /// deformations that together do more than a texture holds.
    Status moveTo(double time, render::SurfaceRenderer& renderer);
    /// Which may be edited: what is drawn follows at the next moveTo(). Null: the scene has none.
    SceneDeformation* deformation() { return deformation_.get(); }
    /// What a user should know of what was made.
    std::vector<std::string> notes() const {
        return deformation_ ? deformation_->notes() : std::vector<std::string>();
    }
    /// How many steps an organ takes in a frame: its increments then say how fast it moves.
    void setSteps(std::size_t organ, int steps) { organs_[organ].steps = steps; }
    bool empty() const { return organs_.empty(); }
    /// Casters of the organs as their states have them, in the order in which they were added. \param drawn
    /// has their cut masks
    std::vector<render::Raycaster*> casters(const std::vector<const sim::StateTextures*>& states,
                                            const render::SurfaceRenderer& drawn);

private:
    struct Organ {                                     // kept where it is: parts point at each other
        std::unique_ptr<render::DistanceVolume> field; // or
        std::unique_ptr<render::DepthMaps> depths;
        render::VolumeGrid grid;
        int steps = 0; // a frame
        std::unique_ptr<render::LatticeWarp> lattice;
        std::unique_ptr<render::Raycaster> caster;
    };
    Status readCutVolume(const sim::CutVolume& wanted);
    static Result<render::RayField> makeField(const sim::Look& look, const sim::TriangleMesh& metres,
                                              Organ& organ);
    /// Do the deformations differ from what is drawn?
    bool isStale() const {
        return deformation_ && (deformation_->moves() || placed_ != deformation_->version());
    }
    Status place(double time);
    render::StageBox surfaceBox(std::size_t organ, double time) const;

    std::unique_ptr<SceneDeformation> deformation_;
    std::unique_ptr<render::CutVolume> cutVolume_;
    std::string cutVolumeUnmet_; // what is wrong while no organ has met it
    int placed_ = -1;            // the version of the deformations that is drawn
    int proxyCells_ = 1;         // of what deformations by vertices move
    sim::Stage stage_ = sim::Stage::whole;
    double frameTime_ = 0; // s
    std::vector<Organ> organs_;
};

} // namespace serosa::app
