#pragma once
// A scene: what one TOML file of schema 1 says, in SI units (docs/scene.md). Every value but schema, model
// and length_unit has a default. Lengths carry units in the file ("2.5 mm"); bare numbers where a unit
// belongs are errors.

#include "base/result.h"
#include "sim/body.h"
#include "sim/cut_motion.h"
#include "sim/material.h"
#include "sim/region.h"
#include "sim/solver.h"
#include "sim/thread.h"
#include "sim/tool.h"
#include "sim/triangle_mesh.h"
#include "sim/up_axis.h"

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace serosa::sim {

/// Procedural pose instead of simulation (MS05 figure 6): all nodes follow a bend about the z axis whose
/// curvature grows from 0 to 1 / `bendRadius` over the run: x is the arc length along the bent centre line,
/// which starts level at the organ's middle; the ends go down.
struct Pose {
    double bendRadius = 0; // m
};

/// From a time on an organ is simulated on a level of detail.
struct LevelKey {
    double time = 0; // s
    int level = 1;
};

/// A texture of tissue made by the program (render/tissue_texture.h).
enum class TissueTexture { none, heartMuscle, fat, liverCapsule, kidney };

/// How an organ's surface looks from near: a texture made by the program, or pictures (PNG). They repeat
/// every `tile`, in the model's texture coordinates (then a tile is 1) or, where it has none, in rest space.
struct OrganLook {
    TissueTexture texture = TissueTexture::none;
    std::filesystem::path albedo, normal, height; // resolved as Organ::model; empty: none
    int albedoLine = 0, normalLine = 0, heightLine = 0;
    double tile = 0.024;    // m: side of a tile in rest space
    double relief = 0.0004; // m: from the lowest to the highest of the height
    bool textured() const {
        return texture != TissueTexture::none || !albedo.empty() || !normal.empty() || !height.empty();
    }
};

struct Organ {
    std::string name = "organ";
    std::filesystem::path model; // resolved against the scene file's folder
    int modelLine = 0;           // of the scene file, for messages; 0: none
    double lengthUnit = 0;       // m per file unit
    glm::dvec3 at{0};            // m, world: where the model's origin lies
    UpAxis upAxis = UpAxis::y;   // of the file
    bool repair = false;         // mend what sim/mesh_repair.h names
    std::size_t nodes = 20000;
    double spacing = 0;                  // m; 0: by nodes
    Tissue tissue;                       // with its materials
    std::vector<MaterialRegion> regions; // of these; a later one wins
    std::vector<Region> fixed;
    double fixedLowestShare =
        0;                 // `[[organ.fixed]] shape = "lowest", share = 0.05`: lowest part of the height
    double tearStrain = 0; // springs stretched beyond (1 + this) tear; 0: none do
    std::optional<Pose> pose;
    OrganLook look;
    bool selfContact = false; // its parts touch each other
    int selfContactLine = 0;  // of the scene file, for messages
    StepMethod method = StepMethod::explicitSteps;
    int methodLine = 0; // of the scene file, for messages; 0: none
    // Level of detail (sim/lod.h): level 1 is the lattice above, each further one has twice its spacing.
    int levels = 1;                      // at most kMostLevels
    std::vector<LevelKey> levelKeys;     // rising times
    bool levelsByRule = false;           // app/level_rule.h; else by the keys
    std::optional<glm::dvec3> gridPoint; // m: of a further level, whose grid goes through it; no key
};

/// Name of `[organ.tissue]` among an organ's materials.
constexpr const char* kTissueName = "tissue";

/// More lattices than this are no scene, but a mistake.
constexpr std::size_t kMostOrgans = 8;

/// The organ's name as a part of file names: blanks become '_'. Scenes of several organs allow letters,
/// digits, blanks, '-' and '_', and no two with one file name.
std::string organFileName(const Organ& organ);

enum class Projection { perspective, orthographic };
struct Camera {
    Projection projection = Projection::perspective;
    std::optional<glm::dvec3> eye, target;  // m; default: framed on the organs
    glm::dvec3 direction{-0.25, -0.15, -1}; // view direction where eye is not given
    glm::dvec3 up{0, 1, 0};
    double fieldOfView = 0.5;     // rad, vertical ("28.6 deg"), perspective
    std::optional<double> height; // m, vertical extent, orthographic
    double zoom = 1;              // of the default framing
};

struct Light {
    glm::dvec3 direction{-0.4, -0.8, -0.6}; // that it shines in
    double intensity = 1;
    double ambient = 1;
};

/// How a surface follows its nodes (docs/methods/mappings.md), in the order of the scene's words.
enum class Mapping { oneToOne, triangle, curvature, chosen, normalOffset, trilinear, nodeFrames };
inline constexpr Mapping kSurfaceMappings[] = {Mapping::triangle,  Mapping::curvature,
                                               Mapping::chosen,    Mapping::normalOffset,
                                               Mapping::trilinear, Mapping::nodeFrames};
enum class SurfaceColour { tissue, dynamicNormal, material, plain };
/// What an organ is drawn as: its surface, or its distance field, ray-cast (docs/methods/raycast.md).
enum class Show { surface, implicit, both };
/// What it is taken from, where it is ray-cast (render/ray_field.h).
enum class Field { distance, depth, depthCube };
enum class Axis { x, y, z };
/// What is in it, where it is ray-cast.
enum class Interior { hollow, solid, shell, combined };
/// What is drawn of an organ that is ray-cast where its deformation's box is (render/stage_box.h).
enum class Stage { whole, mesh, box, composite };
/// How rays are searched there, and what in.
enum class RaySearch { linear, threshold, jacobian };
enum class RayNormals { warped, gradient };
/// A volume that colours the faces of cuts, at rest.
struct CutVolume {
    std::filesystem::path file;
    glm::dvec3 at{0};                               // m: where its zero lies in the world
    UpAxis upAxis = UpAxis::y;                      // that of its axes which points up
    double level = 40, width = 400;                 // window of the grey values
    bool windowed = false;                          // one of them was given
    std::vector<std::pair<int, glm::ivec3>> labels; // value, sRGB; empty: grey values
    int line = 0;                                   // of the scene file
};

struct Look {
    Show show = Show::surface;
    Stage stage = Stage::whole;
    Interior interior = Interior::solid;
    double shell = 0.008; // m: its thickness
    Field field = Field::distance;
    Axis depthAxis = Axis::z; // of Field::depth
    int fieldSamples = 96;    // of the field, along the organ's longest side
    RaySearch search = RaySearch::jacobian;
    double searchStep = 0.5; // voxels of the distance field
    bool skipEmpty = true;
    RayNormals normals = RayNormals::warped;
    bool antialias = false; // a ray for each sample of a pixel
    std::optional<CutVolume> cutVolume;
    int proxyCells = 16;        // of what deformations by vertices move, along an organ's longest side
    bool coarseSampling = true; // of what is small on the screen, or moves fast there
    Mapping mapping = Mapping::curvature;
    SurfaceColour colour = SurfaceColour::tissue;
    bool surface = true, lattice = false, tools = true; // what is drawn
    std::optional<glm::dvec3> sectionAt;                // m; what lies beyond it, to where
    glm::dvec3 sectionNormal{0, 0, 1};                  // this points, is cut away from the picture
    bool shadows = false;                               // of organs and tools under the key light
    bool occlusion = false; // of the surround, found in the picture (beside what each vertex has baked in)
    bool blood = true;      // a film of it beside fresh cuts
};

/// A deformation of what is ray-cast: a closed-form map (render/deformation_map.h), control points, a forward
/// displacement or a deformation texture from a file.
enum class DeformationKind {
    twist,
    bend,
    pull,
    peel,
    wave,
    knife,
    seam,
    incision,
    sphere,
    box,
    points,
    image,
    texture
};
enum class DeformationBy { pixels, vertices }; // which stage does it (render/coarse_warp.h)
enum class TexelWord { bytes, half, single };  // 4, 8, 16 bytes a texel
struct DeformationKey {
    double time = 0;  // s
    glm::dvec3 at{0}; // m: middle of the box
    double turn = 0;  // rad, about the box's own y axis
    double scale = 1; // of the box, and of all that the map does
};
struct Deformation {
    DeformationKind kind = DeformationKind::twist;
    DeformationBy by = DeformationBy::pixels;
    std::vector<std::size_t> organs;                     // that it is of; empty: all
    glm::dvec3 at{0}, size{0};                           // of its box: middle, lengths along its own axes, m
    glm::dvec3 up{0, 1, 0}, along{1, 0, 0};              // its own y and x axis, world; orthonormal
    double amount = 0;                                   // rad (twist, bend) or m
    double radius = 0, extent = 0, depth = 0, width = 0; // m
    bool narrow = false;                                 // of a pull
    double wound = 0; // m: radius of the cylinder that its box is wound around; 0: none
    glm::ivec3 texels{64};
    TexelWord format = TexelWord::half;
    std::vector<glm::dvec2> path;                          // incision: in the plane y = 0 of the box, m
    std::vector<std::pair<glm::dvec3, glm::dvec3>> points; // from, to: in its own axes, from its middle, m
    double reach = 0;                                      // of a point, m
    std::filesystem::path file;                            // image, texture
    std::vector<DeformationKey> keys;                      // where it goes; empty: it stays
    int line = 0;                                          // of the scene file

    /// Where it is at a time, between two keys evenly; before the first and after the last, as there.
    DeformationKey placeAt(double time) const;
    bool isOf(std::size_t organ) const;
};

enum class ImageFormat { nrrd, mha };
struct Output {
    int width = 960, height = 960;                    // pixels: size = [960, 960]
    std::vector<double> surfacesAt;                   // s
    std::vector<double> snapshotsAt, displacementsAt; // s
    ImageFormat displacementFormat = ImageFormat::nrrd;
    int frameEvery = 1;                  // every how many frames a picture is written
    int sheetColumns = 4, sheetRows = 3; // contact sheet
    std::vector<double> sheetAt;         // s; empty: evenly spread
    int turntable = 0;                   // views around the last frame on a sheet of its own; 0: none
};

struct Scene {
    std::filesystem::path file;      // empty: made from command line options
    double frameRate = 60;           // Hz
    double duration = 2;             // s
    glm::dvec3 gravity{0, -9.81, 0}; // m/s2
    std::vector<Organ> organs;       // one to kMostOrgans
    bool organsTouch = false;        // each other
    int organsTouchLine = 0;         // of the scene file, for messages
    double organFriction = 0;        // Coulomb's coefficient where organs touch each other or themselves
    std::vector<Tool> tools;
    std::vector<Body> bodies;
    std::vector<Thread> threads;
    std::vector<Cut> cuts;                 // of every organ
    std::vector<Deformation> deformations; // of all that is ray-cast, the first next to its rest
    Camera camera;
    Light light;
    Look look;
    Output output;

    int frames() const; // duration * frameRate, rounded; at least 1
};

/// How an organ is coupled with others or with itself (sim/organ_group.h).
struct OrganCoupling {
    bool touches = false, touchesItself = false, tied = false; // tied: by a thread
    int line = 0;                                              // of the scene file, that says so

    bool any() const { return touches || touchesItself || tied; }
};
/// Of one organ of the scene. None of an organ with a pose.
OrganCoupling couplingOf(const Scene& scene, std::size_t organ);

/// One value of a scene, for `serosa scene explain`.
struct SceneValue {
    std::string path;       // "organ[0].tissue.young"
    std::string written;    // as in the file; empty where it is the default
    std::string value;      // in SI units, with the unit
    int line = 0;           // 0: the default,
    bool inherited = false; // or what another table says
};

/// Reads and checks a scene file. Errors carry file:line:column: syntax, unknown key (with the nearest known
/// one), wrong type, missing or wrong unit, out of range, missing required key, model file not found. \param
/// explained if not null, receives every value in force, in the order of docs/scene.md.
Result<Scene> readScene(const std::filesystem::path& file, std::vector<SceneValue>* explained = nullptr);

/// A value that breaks a rule over the whole scene: a time after the end, more frames than can be counted.
struct SceneProblem {
    std::string table, key, message; // table: "", "look" or "output"
};
/// Whether the scene came from a file or from command line options. Nothing where all rules are kept.
std::optional<SceneProblem> findSceneProblem(const Scene& scene);

/// The scene that `serosa run --model FILE --length-unit U` uses: 5 kPa, Poisson 0.25, 1000 kg/m3, 20,000
/// nodes, 60 Hz, 120 frames, no gravity, the lowest 5% fixed, a probe that presses the top by 5% of the size
/// and leaves. \param metres the surface in metres (at least one vertex); its top is the vertex nearest to
/// its middle among those within 2% of the greatest y.
Scene defaultScene(const std::filesystem::path& model, double lengthUnit, const TriangleMesh& metres);

/// "mm", "cm", "m", "um", "in" in metres. Errors: unknown unit, with a suggestion.
Result<double> parseLengthUnit(const std::string& text);

} // namespace serosa::sim
