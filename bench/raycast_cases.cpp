// The deformation shader (CS07): table 1 and figure 7 of the paper at 512 x 512, what searching and warping
// cost, what the maps take of memory.

#include "bench/cases.h"
#include "gpu/gl.h"
#include "gpu/handles.h"
#include "models/phantom.h"
#include "render/deformation_chain.h"
#include "render/depth_maps.h"
#include "render/raycast_measures.h"

#include <memory>
#include <numeric>

namespace serosa::bench {

namespace {

constexpr int kPictureSize = 512; // pixels, as in the paper
constexpr int kSamples = 128;     // of the distance field along the longest side
constexpr int kMargin = 3;        // voxels
constexpr int kProxyCells = 16;   // of the hybrid
constexpr glm::dvec3 kDirection{-0.35, -0.45, -1};

struct Model {
    const char* phantom;
    std::size_t faces;  // as it is made; then each in four, until there are
    std::size_t enough; // so many
};
// The paper's: hand, bunny, armadillo, dragon.
constexpr Model kModels[] = {
    {"hand", 18905, 18905}, {"liver", 72027, 72027}, {"dragon", 43244, 172974}, {"heart", 54464, 871414}};
/// How far the box is from filling the picture.
constexpr double kZooms[] = {2.6, 1.6, 1.1};

/// For what is small on the screen (section 6.3).
constexpr double kFar = 12;

/// What is drawn, and how. Continuous: the same displacement, of which nothing is cut away.
struct Way {
    const char* name;
    bool cuts, skipField, skipCut;
};
constexpr Way kWays[] = {{"continuous", false, true, true},
                         {"cuts, no skipping of them", true, true, false},
                         {"cuts, skipped", true, true, true}};

render::DeformationMap mapOf(const glm::dvec3& half, render::MapKind kind) {
    render::DeformationMap map;
    map.kind = kind;
    map.half = half;
    map.amount = kind == render::MapKind::twist ? 0.8 : kind == render::MapKind::peel ? 0 : 0.2 * half.x;
    map.extent = 1.6 * half.z;
    map.depth = 1.4 * half.y;
    map.radius = map.width = half.y;
    return map;
}

class Target {
public:
    Target()
        : colour_("bench", GL_RGBA8, kPictureSize, kPictureSize),
          depth_("bench: depth", GL_DEPTH_COMPONENT32F, kPictureSize, kPictureSize), target_("bench") {
        target_.attach(GL_COLOR_ATTACHMENT0, colour_);
        target_.attach(GL_DEPTH_ATTACHMENT, depth_);
        target_.setDrawBuffers(1);
    }
    void draw(render::Raycaster& caster, const render::RaycastView& view, const render::RaycastLook& look,
              int repeats, Status& status) const {
        target_.bind(kPictureSize, kPictureSize);
        glEnable(GL_DEPTH_TEST);
        for (int i = 0; i < repeats && status.ok(); ++i) {
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            status = caster.draw(view.frame, look);
        }
        glFinish();
        glDisable(GL_DEPTH_TEST);
    }

private:
    gpu::Texture2D colour_, depth_;
    gpu::Framebuffer target_;
};

/// A model with its field and its maps.
struct Subject {
    std::string name;
    std::size_t faces = 0;
    sim::TriangleMesh mesh; // m
    render::TextureMapping mapping;
    glm::dvec3 lowest{0}, highest{0};
    sim::Lattice space;
    std::unique_ptr<render::DistanceVolume> field;
    std::unique_ptr<render::DeformationTexture> twist, knife, whole; // whole: the knife's, nothing cut
    std::unique_ptr<render::Raycaster> plain, twisted, continuous, cut;

    render::RaycastView view(double zoom, int size = kPictureSize) const {
        const glm::dvec3 middle = 0.5 * (lowest + highest), half = 0.5 * zoom * (highest - lowest);
        return render::RaycastView::of(space, middle - half, middle + half, kDirection,
                                       sim::Projection::perspective, size, size);
    }
    /// Share of the picture that the deformation's box covers.
    double area(const render::RaycastView& view) const {
        int covered = 0;
        const int pixels = view.width * view.height;
        for (int i = 0; i < pixels; ++i) {
            const glm::dvec2 slab =
                render::slabOf(view.ray(std::size_t(i)), continuous->lowest(), continuous->highest());
            covered += slab.x < slab.y;
        }
        return double(covered) / pixels;
    }
};

/// Its knife's cut, the body taken from depth maps.
struct DepthSubject {
    std::unique_ptr<render::DepthMaps> maps;
    std::unique_ptr<render::Raycaster> cut;

    static Result<DepthSubject> of(const Subject& subject, const render::DepthPlan& plan) {
        DepthSubject made;
        SEROSA_ASSIGN(render::DepthMaps maps,
                      render::DepthMaps::create(subject.mesh, subject.field->grid(), plan));
        made.maps = std::make_unique<render::DepthMaps>(std::move(maps));
        SEROSA_ASSIGN(render::Raycaster caster, render::Raycaster::create(subject.space, made.maps->field()));
        caster.setWarp(render::Warp{subject.knife.get(), subject.mapping});
        made.cut = std::make_unique<render::Raycaster>(std::move(caster));
        return made;
    }
};

/// A knife's cut, twisted: by the vertex stage, or all of it in the pixel, from one texture (section 6.3).
struct HybridSubject {
    std::unique_ptr<render::ChainedWarp> chained;
    std::unique_ptr<render::Raycaster> hybrid, pixels;

    static Result<HybridSubject> of(const Subject& subject) {
        HybridSubject made;
        const render::Warp knife{subject.knife.get(), subject.mapping};
        SEROSA_ASSIGN(
            render::ChainedWarp chained,
            render::chain({knife, {subject.twist.get(), subject.mapping}}, render::TexelFormat::half));
        made.chained = std::make_unique<render::ChainedWarp>(std::move(chained));
        for (std::unique_ptr<render::Raycaster>* const one : {&made.hybrid, &made.pixels}) {
            SEROSA_ASSIGN(render::Raycaster caster, render::Raycaster::create(subject.space, *subject.field));
            *one = std::make_unique<render::Raycaster>(std::move(caster));
        }
        made.pixels->setWarp(render::Warp{&made.chained->texture, made.chained->mapping});
        made.hybrid->setWarp(knife);
        SEROSA_ASSIGN(const render::CoarseWarp twist,
                      render::CoarseWarp::create(
                          {{mapOf(0.55 * (subject.highest - subject.lowest), render::MapKind::twist),
                            subject.mapping}}));
        made.hybrid->setCoarse(twist, kProxyCells);
        return made;
    }
};

Result<render::DeformationTexture> uncut(const render::DeformationTexture& texture) {
    std::vector<glm::dvec4> texels;
    const glm::ivec3& size = texture.size();
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                texels.emplace_back(glm::dvec3(texture.sample(
                                        (glm::dvec3(x, y, z) + 0.5) * texture.texelSize() - texture.half())),
                                    1);
    return render::DeformationTexture::create(size, texture.half(), texture.format(), texels);
}

Result<std::unique_ptr<Subject>> subjectOf(const Model& model) {
    auto made = std::make_unique<Subject>();
    SEROSA_ASSIGN(sim::TriangleMesh mesh, models::phantomInMetres(model.phantom, model.faces));
    mesh = refined(std::move(mesh), model.enough);
    made->name = model.phantom;
    made->faces = mesh.faces.size();
    made->lowest = mesh.lowest();
    made->highest = mesh.highest();
    made->space = render::objectSpace(glm::distance(made->lowest, made->highest) / 30);
    SEROSA_ASSIGN(render::DistanceVolume field,
                  render::DistanceVolume::create(
                      mesh, render::VolumeGrid::around(made->lowest, made->highest, kSamples, kMargin), 0));
    made->field = std::make_unique<render::DistanceVolume>(std::move(field));
    render::TextureMapping& mapping = made->mapping;
    mapping.objectFromLocal[3] = glm::dvec4(0.5 * (made->lowest + made->highest), 1);
    const auto casterOf =
        [&](const render::DeformationTexture* texture) -> Result<std::unique_ptr<render::Raycaster>> {
        SEROSA_ASSIGN(render::Raycaster caster, render::Raycaster::create(made->space, *made->field));
        if (texture)
            caster.setWarp(render::Warp{texture, mapping});
        return std::make_unique<render::Raycaster>(std::move(caster));
    };
    const auto textureOf = [&](render::MapKind kind) -> Result<std::unique_ptr<render::DeformationTexture>> {
        SEROSA_ASSIGN(render::DeformationTexture texture,
                      render::DeformationTexture::bake(mapOf(0.55 * (mesh.highest() - mesh.lowest()), kind),
                                                       glm::ivec3(64), render::TexelFormat::half));
        return std::make_unique<render::DeformationTexture>(std::move(texture));
    };
    SEROSA_ASSIGN(made->twist, textureOf(render::MapKind::twist));
    SEROSA_ASSIGN(made->knife, textureOf(render::MapKind::knife));
    SEROSA_ASSIGN(render::DeformationTexture whole, uncut(*made->knife));
    made->whole = std::make_unique<render::DeformationTexture>(std::move(whole));
    SEROSA_ASSIGN(made->plain, casterOf(nullptr));
    SEROSA_ASSIGN(made->twisted, casterOf(made->twist.get()));
    SEROSA_ASSIGN(made->continuous, casterOf(made->whole.get()));
    SEROSA_ASSIGN(made->cut, casterOf(made->knife.get()));
    made->mesh = std::move(mesh);
    return made;
}

std::string caseName(const Subject& subject, const Way& way, double zoom) {
    return subject.name + std::to_string(subject.faces) + way.name + std::to_string(zoom);
}

/// Of two ways of a model, weighted by area over the views: formed within each round.
Spread weighted(const Rounds& rounds, const Subject& subject, const Way& way, const Way& other,
                const std::vector<double>& areas) {
    const auto sums = [&](const Way& one) {
        std::vector<double> sum;
        for (std::size_t v = 0; v < areas.size(); ++v) {
            const std::vector<double>& times = rounds.all(caseName(subject, one, kZooms[v]));
            sum.resize(times.size());
            for (std::size_t r = 0; r < times.size(); ++r)
                sum[r] += areas[v] * times[r];
        }
        return sum;
    };
    std::vector<double> ratios = sums(way);
    const std::vector<double> below = sums(other);
    for (std::size_t r = 0; r < ratios.size(); ++r)
        ratios[r] /= below[r];
    return spreadOf(ratios);
}

/// The paper's weighted average, sum a t / sum a, ms.
double weightedMilliseconds(const Rounds& rounds, const Subject& subject, const Way& way,
                            const std::vector<double>& areas) {
    double sum = 0;
    for (std::size_t v = 0; v < areas.size(); ++v)
        sum += areas[v] * rounds.milliseconds(caseName(subject, way, kZooms[v])).median;
    return sum / std::accumulate(areas.begin(), areas.end(), 0.0);
}

/// Pixels that a search misses: against one with steps so short that it is taken for the truth.
Result<int> missesOf(render::Raycaster& caster, const render::RaycastView& view,
                     const render::RaycastLook& look, const std::vector<render::RaycastProbe>& truth,
                     double voxel) {
    SEROSA_ASSIGN(const std::vector<render::RaycastProbe> probes,
                  caster.probe(view.frame, look, view.width, view.height));
    render::RaycastAgreement sum;
    addAgreement(sum, probes, truth, 0.5 * voxel);
    return sum.silhouettes + sum.deep;
}

/// The longest step with which a linear search shows the picture of the adaptive one.
Result<double> linearStep(render::Raycaster& caster, const render::RaycastView& view, double voxel,
                          Report& report) {
    render::RaycastLook dense;
    dense.search = render::Search::linear;
    dense.skipField = dense.skipCut = false;
    dense.step = 0.1;
    SEROSA_ASSIGN(const std::vector<render::RaycastProbe> truth,
                  caster.probe(view.frame, dense, view.width, view.height));
    SEROSA_ASSIGN(const int adaptive, missesOf(caster, view, {}, truth, voxel));
    std::string line = "Pixels missed, adaptive search: " + std::to_string(adaptive) + "; linear: ";
    double step = 2;
    for (;; step /= 2) {
        dense.step = step;
        SEROSA_ASSIGN(const int misses, missesOf(caster, view, dense, truth, voxel));
        line += std::to_string(misses) + " with steps of " + figure(step) + " voxels, ";
        if (misses <= 1.25 * adaptive || step < 0.2)
            break;
    }
    report.line(line + "of " + std::to_string(view.width * view.height) + ".");
    return step;
}

} // namespace

Status benchRaycast(const Options& options, Report& report) {
    std::vector<std::unique_ptr<Subject>> subjects;
    for (const Model& model : kModels) {
        SEROSA_ASSIGN(std::unique_ptr<Subject> subject, subjectOf(model));
        subjects.push_back(std::move(subject));
    }
    const Target target;
    Rounds rounds;
    Status status;
    std::vector<std::vector<double>> areas;
    const auto add = [&](const std::string& name, render::Raycaster& caster, const render::RaycastView& view,
                         const render::RaycastLook& look) {
        rounds.add(name, [&, view, look](int repeats) { target.draw(caster, view, look, repeats, status); });
    };
    for (const auto& subject : subjects) {
        areas.emplace_back();
        for (const double zoom : kZooms) {
            const render::RaycastView view = subject->view(zoom);
            areas.back().push_back(subject->area(subject->view(zoom, 128)));
            for (const Way& way : kWays) {
                render::RaycastLook look;
                look.skipField = way.skipField;
                look.skipCut = way.skipCut;
                add(caseName(*subject, way, zoom), way.cuts ? *subject->cut : *subject->continuous, view,
                    look);
            }
        }
    }
    // The same shape of the most faces with the fewest: are triangles seen at all?
    SEROSA_ASSIGN(const std::unique_ptr<Subject> coarse,
                  subjectOf({kModels[3].phantom, kModels[3].faces, 0}));
    const Subject& fine = *subjects.back();
    const render::RaycastView view = fine.view(1);
    add("few faces", *coarse->twisted, view, {});
    add("many faces", *fine.twisted, view, {});

    report.heading("Deformation shader, " + std::to_string(kPictureSize) + " x " +
                   std::to_string(kPictureSize));
    SEROSA_ASSIGN(const double step, linearStep(*fine.twisted, view, fine.field->grid().step, report));
    render::RaycastLook linear;
    linear.search = render::Search::linear;
    linear.skipField = linear.skipCut = false;
    linear.step = step;
    add("linear", *fine.twisted, view, linear);
    add("adaptive", *fine.twisted, view, {});
    add("plain", *fine.plain, view, {});
    render::RaycastLook gradient;
    gradient.normals = render::Normals::gradient;
    add("normals of the gradient", *fine.twisted, view, gradient);
    linear.step = render::RaycastLook().step;
    add("linear, default step", *fine.twisted, view, linear);
    add("plain, linear", *fine.plain, view, linear);
    // The same knife's cut of other fields (section 6.1), and few samples of what is far away (6.3).
    const Subject& shape = *subjects[1];
    SEROSA_ASSIGN(const DepthSubject cube, DepthSubject::of(shape, {render::FieldKind::depthCube, 0}));
    SEROSA_ASSIGN(const DepthSubject pair, DepthSubject::of(shape, {render::FieldKind::depth, 1}));
    const render::RaycastView near = shape.view(kZooms[1]);
    render::RaycastLook every;
    every.skipField = false;
    add("distance field", *shape.cut, near, {});
    add("distance field, no skipping by it", *shape.cut, near, every);
    add("depth-map cube", *cube.cut, near, {});
    add("depth map", *pair.cut, near, {});
    SEROSA_ASSIGN(const HybridSubject hybrid, HybridSubject::of(shape));
    add("hybrid", *hybrid.hybrid, near, {});
    add("all in the pixel", *hybrid.pixels, near, {});
    const render::RaycastView far = shape.view(kFar);
    render::RaycastLook few;
    few.coarse = 0.5;
    add("small", *shape.cut, far, {});
    add("small, coarse", *shape.cut, far, few);
    rounds.measure(options.rounds, options.seconds);
    SEROSA_TRY(status);

    std::vector<std::vector<std::string>> table, curve;
    std::vector<double> shares, without;
    for (std::size_t i = 0; i < subjects.size(); ++i) {
        const Subject& subject = *subjects[i];
        const Spread skipped = weighted(rounds, subject, kWays[2], kWays[0], areas[i]),
                     unskipped = weighted(rounds, subject, kWays[1], kWays[0], areas[i]);
        std::vector<std::string> row = {subject.name, std::to_string(subject.faces)};
        for (const Way& way : kWays)
            row.push_back(figure(weightedMilliseconds(rounds, subject, way, areas[i])));
        row.push_back(figure(unskipped));
        row.push_back(figure(skipped));
        table.push_back(row);
        shares.push_back(skipped.median);
        report.ratio("raycast_cuts_over_continuous_" + subject.name, skipped);
        without.push_back(unskipped.median);
        for (std::size_t v = 0; v < areas[i].size(); ++v)
            curve.push_back({subject.name, figure(100 * areas[i][v]),
                             figure(rounds.milliseconds(caseName(subject, kWays[0], kZooms[v]))),
                             figure(rounds.milliseconds(caseName(subject, kWays[2], kZooms[v])))});
    }
    report.line("\nTable 1: ms, weighted by the box's share of the picture.\n");
    std::vector<std::string> columns = {"model", "faces"};
    for (const Way& way : kWays)
        columns.push_back(way.name);
    columns.push_back("no skipping of cuts / continuous");
    columns.push_back("cuts skipped / continuous");
    report.table(columns, table);
    report.line("\nFigure 7: ms by the box's share of the picture.\n");
    report.table({"model", "% of the picture", "continuous", "cuts"}, curve);
    std::vector<std::vector<std::string>> memory;
    for (const auto& [kind, size] : {std::pair{render::MapKind::peel, glm::ivec3(128, 128, 1)},
                                     {render::MapKind::twist, glm::ivec3(64)}}) {
        SEROSA_ASSIGN(
            const render::DeformationTexture texture,
            render::DeformationTexture::bake(mapOf(glm::dvec3(0.05), kind), size, render::TexelFormat::half));
        memory.push_back(
            {render::nameOf(kind),
             std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z),
             std::to_string(texture.bytes() / 1024)});
    }
    report.line("\nMemory of maps, 8 w h d bytes.\n");
    report.table({"map", "texels", "KiB"}, memory);
    std::vector<std::vector<std::string>> fields;
    const auto bytesOf = [](std::size_t bytes) { return std::to_string(bytes / 1024); };
    const std::size_t volume = shape.field->texture().bytes();
    fields.push_back({"distance field", bytesOf(volume), figure(rounds.milliseconds("distance field"))});
    fields.push_back({"distance field, no skipping by it", bytesOf(volume),
                      figure(rounds.milliseconds("distance field, no skipping by it"))});
    fields.push_back(
        {"depth-map cube", bytesOf(cube.maps->bytes()), figure(rounds.milliseconds("depth-map cube"))});
    fields.push_back({"depth map", bytesOf(pair.maps->bytes()), figure(rounds.milliseconds("depth map"))});
    report.line("\nA knife's cut in " + shape.name + ", by what the body is taken from.\n");
    report.table({"field", "KiB", "ms"}, fields);
    report.line(
        "\nThe same cut, twisted, by vertices and in the pixel: " + figure(rounds.milliseconds("hybrid")) +
        " ms; all in the pixel: " + figure(rounds.milliseconds("all in the pixel")) + " ms.\n");
    report.ratio("raycast_depth_cube_over_distance",
                 rounds.ratio("depth-map cube", "distance field, no skipping by it"));
    report.ratio("raycast_depth_over_distance",
                 rounds.ratio("depth map", "distance field, no skipping by it"));
    report.ratio("raycast_small_coarse_over_full", rounds.ratio("small, coarse", "small"));
    report.ratio("raycast_hybrid_over_pixels", rounds.ratio("hybrid", "all in the pixel"));
    const double mean = std::accumulate(shares.begin(), shares.end(), 0.0) / double(shares.size());
    report.ratio("raycast_cuts_over_continuous",
                 {mean, *std::min_element(shares.begin(), shares.end()),
                  *std::max_element(shares.begin(), shares.end()), options.rounds});
    report.ratio("raycast_linear_over_adaptive", rounds.ratio("linear", "adaptive"));
    report.ratio("raycast_displaced_over_plain_adaptive", rounds.ratio("adaptive", "plain"));
    report.ratio("raycast_displaced_over_plain", rounds.ratio("linear, default step", "plain, linear"));
    report.ratio("raycast_gradient_over_warped_normals", rounds.ratio("normals of the gradient", "adaptive"));
    report.ratio("raycast_many_over_few_faces", rounds.ratio("many faces", "few faces"));
    return {};
}

} // namespace serosa::bench
