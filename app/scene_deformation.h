#pragma once
// A scene's deformations as what the deformation shader draws with: of each organ one texture and where it
// lies, at each time (docs/methods/raycast.md).
//
// Several of one organ are one: their sum where they share box and place, else one after the other, the first
// next to the organ at rest, sampled anew on a box around all of theirs (render/deformation_chain.h). Those
// by vertices are a list beside it (render/coarse_warp.h).

#include "render/coarse_warp.h"
#include "render/deformation_sources.h"
#include "render/stage_box.h"
#include "sim/scene.h"
#include "sim/triangle_mesh.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace serosa::app {

class SceneDeformation {
public:
    /// Errors, with file and line: a map that folds or does not fit its box, of files. \param scene with at
    /// least one deformation
    static Result<SceneDeformation> create(const sim::Scene& scene);

    /// Says what is wrong with it on this organ, m, at all times that a key names. Errors: an organ that
    /// crosses a face of a box on which the map does not vanish; a box that meets none of the organs.
    Status check(std::size_t organ, const sim::TriangleMesh& metres);
    /// After check() of all organs.
    Status checkMet() const;
    /// Errors: a texture of more texels along a side.
    Status checkSizes(int most) const;

    /// What the pixel does: an organ's warp at a time; it points into this, until the next call for another
    /// time. Nothing: none of the deformations is of this organ.
    Result<std::optional<render::Warp>> at(std::size_t organ, double time);
    /// What the vertex stage does then, after it. Errors: of more of them than it takes.
    Result<std::optional<render::CoarseWarp>> coarseAt(std::size_t organ, double time) const;
    /// The first deformation of an organ by vertices, for a message; nothing: none is.
    std::optional<std::size_t> firstByVertices(std::size_t organ) const;
    /// As it is now: what the scene says, unless it was edited.
    const sim::Deformation& deformation(std::size_t i) const { return scene_.deformations[i]; }
    /// Where its box lies at a time, m.
    render::TextureMapping mapping(std::size_t i, double time) const;
    std::string name(std::size_t i) const; // its kind, as a scene says it
    std::size_t count() const { return scene_.deformations.size(); }
    /// Puts another in its place, of the same kind: its box elsewhere, more or less of what it does, its
    /// points moved. What depends on that alone is made again. Errors, which change nothing: as create().
    Status edit(std::size_t i, const sim::Deformation& now);
    /// All as the scene says.
    Status restore();
    /// Rises with each edit.
    int version() const { return version_; }
    Error errorOf(std::size_t i, const std::string& message) const;
    /// What takes a place of its box at a time to where it was a while (s) before, m; of several boxes of
    /// the organ, of the one that goes furthest. Of those that pixels do.
    glm::dmat4 motionAt(std::size_t organ, double time, double while_) const;
    /// Does it go anywhere?
    bool moves() const;
    /// The box of a scene that is drawn in two stages, at a time. \param seam m
    render::StageBox stageBox(double time, double seam) const;
    /// Of the i-th deformation, as its kind makes it; null: the vertex stage does it, without one.
    const render::DeformationTexture* texture(std::size_t i) const {
        return textures_[i] ? &*textures_[i] : nullptr;
    }
    /// What a user should know of what was made.
    std::vector<std::string> notes() const;

private:
    static Result<render::DeformationTexture> textureOf(const sim::Deformation& one, std::string& note);
    render::Warp warpOf(std::size_t i, double time) const;
    /// Some of them as one.
    struct Chain {
        std::optional<render::DeformationTexture> texture;
        render::TextureMapping mapping;
        double time = -1;
        int version = -1;
    };
    Result<std::optional<render::DeformationTexture>> makeTexture(const sim::Deformation& one, std::size_t i);
    Status checkCoarse(std::size_t organ, const sim::TriangleMesh& metres);
    Status link(const std::vector<std::size_t>& some, double time, Chain& chain) const;

    sim::Scene scene_;
    std::vector<sim::Deformation> asWritten_;
    int version_ = 0;
    std::vector<std::optional<render::DeformationTexture>> textures_; // one a deformation, by pixels
    std::vector<bool> met_;                                           // an organ lies in its box
    std::map<std::vector<std::size_t>, Chain> chains_;
    struct Notes {
        std::string made, placed; // of its texture; of where its box lies, by check()
    };
    std::vector<Notes> notes_; // one a deformation: an edit's take the place of those before
};

} // namespace serosa::app
