#pragma once
// The deformation shader (CS07; shaders/raycast.frag): a closed mesh as the zero set of its distance field,
// warped back by a deformation texture, cut by its mask, found ray by ray in the pixel. Hollow, solid or a
// shell.
//
// Object space is the lattice's (its unit and origin), so that the picture's Frame and the surface pass go
// with it.

#include "base/result.h"
#include "gpu/handles.h"
#include "gpu/program.h"
#include "render/coarse_warp.h"
#include "render/cut_volume.h"
#include "render/deformation_texture.h"
#include "render/frame.h"
#include "render/lattice_warp.h"
#include "render/ray_field.h"
#include "render/ray_proxy.h"
#include "render/shown_bounds.h"
#include "render/stage_box.h"
#include "shaders/raycast_constants.h"
#include "sim/lattice.h"
#include "sim/scene.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace serosa::render {

enum class Solid {
    hollow = SRS_SOLID_HOLLOW,
    solid = SRS_SOLID_SOLID,
    shell = SRS_SOLID_SHELL,
    combined = SRS_SOLID_COMBINED // hollow, for comparison
};
enum class Search {
    linear = SRS_SEARCH_LINEAR,
    threshold = SRS_SEARCH_THRESHOLD,
    jacobian = SRS_SEARCH_JACOBIAN
};

enum class Normals { warped, gradient }; // eq. 5; of the deformed field

struct RaycastLook {
    Solid solid = Solid::solid;
    Search search = Search::jacobian;
    double step = 0.5;    // between samples, voxels of the distance field
    double coarse = 0;    // share of a pixel and of a frame's way that samples may lie apart (section 6.3)
    double threshold = 1; // Search::threshold: nearer than this, voxels, steps are a quarter
    double thickness = 0.008; // of a shell, m
    bool closes = false;      // a surface that is drawn beside it: all but faces of cuts lies a little behind
    Normals normals = Normals::warped;
    bool antialias = false; // a ray for each sample of a pixel
    bool skipField = true;  // empty space, by the distance field; depth maps know no way to skip
    bool skipCut = true;    // what a map's mask cuts away, by the distance to what it keeps
    glm::vec3 skin{0.342F, 0.048F, 0.037F}, inner{0.45F, 0.2F, 0.14F}, flesh{0.42F, 0.085F, 0.07F}; // linear
};

/// What a scene's look says of it; the rest as above.
RaycastLook raycastLook(const sim::Look& look);

/// What a pixel met.
struct RaycastProbe {
    enum Kind { nothing = 0, surface = 1, innerSide = 2, cutFace = 3 };
    int kind = nothing;
    int samples = 0;               // that the search took, refining apart
    double t = 0;                  // along the ray from the eye, m; orthographic: from the box's far face
    glm::dvec3 normal{0}, rest{0}; // unit; m
};

class Raycaster {
public:
    /// \param field its textures outlive this
    static Result<Raycaster> create(const sim::Lattice& lattice, const RayField& field);
    static Result<Raycaster> create(const sim::Lattice& lattice, const DistanceVolume& volume) {
        return create(lattice, RayField::of(volume));
    }

    /// From now on; nothing: at rest. \param worldFromLocal of mapping: m
    void setWarp(const std::optional<Warp>& warp);
    /// What is in the warp's box now was here a frame ago, m; from now on. setWarp() puts it back to rest.
    void setMotion(const glm::dmat4& beforeFromNow) { beforeFromNow_ = beforeFromNow; }
    /// The organ as its lattice has it, from now on; null: at rest. A warp then acts on the organ at rest.
    /// \param lattice outlives this
    void setLattice(const LatticeWarp* lattice) { lattice_ = lattice; }
    /// The hybrid of section 6.3: moves what setWarp() leaves by these maps in the vertex stage; after
    /// setWarp, which ends it. Not beside a lattice or a stage. \param cells of the proxy, along the longest
    /// side
    void setCoarse(const CoarseWarp& coarse, int cells);
    /// What is ray-cast lies in this box, and its colour goes over what was drawn before by its seam;
    /// nothing: all is, after setWarp.
    void setStage(const std::optional<StageBox>& stage);
    /// Colours the faces of cuts, from now on; null: nothing does. \param volume outlives this
    void setCutVolume(const CutVolume* volume) { cutVolume_ = volume; }
    /// Bounds of what may be drawn, m: the field's, and where the warp can take it; of a lattice: its own.
    const glm::dvec3& lowest() const { return lowest_; }
    const glm::dvec3& highest() const { return highest_; }

    /// Draws into the bound target with its depth test. Errors: of the shaders, when first used.
    Status draw(const Frame& frame, const RaycastLook& look);
    /// What each pixel of a picture of this size meets, top row first. Waits.
    Result<std::vector<RaycastProbe>> probe(const Frame& frame, const RaycastLook& look, int width,
                                            int height);

private:
    struct Variant {
        Solid solid;
        Search search;
        Normals normals;
        FieldKind field;
        int skip;   // 1 by the field, 2 by the cut
        int volume; // CutVolume::kind(), 0: none
        bool lattice, cut, warped, masked, wound, within, staged, coloured, samples, coarse, proxy, probe;
        auto operator<=>(const Variant&) const = default;
    };
    Raycaster() = default;
    Result<gpu::Program*> program(const Variant& variant);
    void upload(const DeformationTexture& texture);
    /// Do all rays run within the texture's box?
    bool isWithin() const;
    /// Can any sample of what is drawn lie further apart than a step? \param pixel its width at a place
    bool mayBeCoarse(const RaycastLook& look, const glm::vec4& pixel) const;
    Status drawBox(const Frame& frame, const RaycastLook& look, bool probe);
    void drawFaces(const RaycastLook& look, bool blended) const;

    RayField field_;
    const LatticeWarp* lattice_ = nullptr;
    const CutVolume* cutVolume_ = nullptr;
    glm::dvec3 origin_{0}; // m: of object space
    double unit_ = 1;      // m
    gpu::Texture3D displacement_, skipTexture_;
    ShownBounds shownBounds_;
    double skipNear_ = 0, skipReach_ = 0, maskSlope_ = 1;       // m, 1/m
    std::shared_ptr<const std::vector<std::uint8_t>> uploaded_; // what the textures were made from,
    double woundAround_ = 0;                                    // and of which radius
    bool masked_ = false;                                       // the texture cuts something away
    double scale_ = 1, bias_ = 0;
    glm::vec3 half_{1};
    std::optional<TextureMapping> mapping_; // m
    glm::dmat4 beforeFromNow_{1};           // m
    std::optional<StageBox> stage_;
    std::optional<CoarseWarp> coarse_;
    RayProxy proxy_; // of what setWarp() leaves
    gpu::Buffer coarseMaps_;
    glm::dvec3 lowest_{0}, highest_{0};
    gpu::VertexArray empty_;
    gpu::Texture2D none_; // one texel, where there is no map of shadows or occlusion
    std::map<Variant, gpu::Program> programs_;
};

} // namespace serosa::render
