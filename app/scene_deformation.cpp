// See app/scene_deformation.h.
#include "app/scene_deformation.h"

#include "app/deformation_file.h"
#include "render/deformation_chain.h"
#include "sim/node_depths.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace serosa::app {

namespace {

render::TexelFormat formatOf(const sim::Deformation& one) {
    return one.format == sim::TexelWord::bytes  ? render::TexelFormat::unorm8
           : one.format == sim::TexelWord::half ? render::TexelFormat::half
                                                : render::TexelFormat::single;
}

render::DeformationMap mapOf(const sim::Deformation& one) {
    render::DeformationMap map;
    map.kind = one.kind;
    map.half = 0.5 * one.size;
    map.amount = one.amount;
    map.radius = one.radius;
    map.extent = one.extent;
    map.depth = one.depth;
    map.width = one.width;
    map.path = one.path;
    map.profile = one.narrow ? render::PullProfile::narrow : render::PullProfile::gaussian;
    return map;
}

render::TextureMapping mappingOf(const sim::Deformation& one, double time) {
    const sim::DeformationKey place = one.placeAt(time);
    const glm::dvec3 across = glm::cross(one.along, one.up);
    const double c = std::cos(place.turn), s = std::sin(place.turn);
    const glm::dvec3 x = c * one.along - s * across, z = s * one.along + c * across;
    render::TextureMapping mapping;
    mapping.objectFromLocal = {glm::dvec4(place.scale * x, 0), glm::dvec4(place.scale * one.up, 0),
                               glm::dvec4(place.scale * z, 0), glm::dvec4(place.at, 1)};
    mapping.cylinderRadius = one.wound;
    return mapping;
}

/// When it is looked at: at its keys, and on the way between them.
std::vector<double> timesOf(const sim::Deformation& one) {
    constexpr int kBetween = 8;
    std::vector<double> times;
    for (const sim::DeformationKey& key : one.keys) {
        const double before = times.empty() ? key.time : times.back();
        for (int i = 1; i < kBetween && !times.empty(); ++i)
            times.push_back(before + (key.time - before) * i / kBetween);
        times.push_back(key.time);
    }
    return times.empty() ? std::vector<double>{0} : times;
}

std::string residualNote(const render::InversionResidual& residual, const std::filesystem::path& file) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "deformation: %s was inverted with a residual of %.3g mm at most, %.3g mm in the median; "
                  "%zu texels are off by more than a hundredth of one",
                  file.filename().string().c_str(), 1e3 * residual.largest, 1e3 * residual.median,
                  residual.unresolved);
    return text;
}

} // namespace

Error SceneDeformation::errorOf(std::size_t i, const std::string& message) const {
    return Error{scene_.file.string() + ":" + std::to_string(scene_.deformations[i].line) +
                 ": deformation: " + message};
}

Result<render::DeformationTexture> SceneDeformation::textureOf(const sim::Deformation& one,
                                                               std::string& note) {
    const render::TexelFormat format = formatOf(one);
    if (one.kind == sim::DeformationKind::texture)
        return readDeformationTexture(one.file, format);
    if (one.kind == sim::DeformationKind::image) {
        SEROSA_ASSIGN(render::InvertedDisplacement inverted, readForwardDisplacement(one.file, format));
        note = residualNote(inverted.residual, one.file);
        return std::move(inverted.texture);
    }
    if (one.kind == sim::DeformationKind::points) {
        std::vector<render::ControlPoint> points;
        for (const auto& [from, to] : one.points)
            points.push_back({from, to});
        return render::interpolateControlPoints(points, one.texels, 0.5 * one.size, one.reach, format);
    }
    return render::DeformationTexture::bake(mapOf(one), one.texels, format);
}

Result<SceneDeformation> SceneDeformation::create(const sim::Scene& scene) {
    SceneDeformation made;
    made.scene_ = scene;
    made.asWritten_ = scene.deformations;
    made.met_.assign(scene.deformations.size(), false);
    made.notes_.resize(scene.deformations.size());
    for (std::size_t i = 0; i < scene.deformations.size(); ++i) {
        SEROSA_ASSIGN(std::optional<render::DeformationTexture> texture,
                      made.makeTexture(scene.deformations[i], i));
        made.textures_.push_back(std::move(texture));
    }
    return made;
}

Result<std::optional<render::DeformationTexture>> SceneDeformation::makeTexture(const sim::Deformation& one,
                                                                                std::size_t i) {
    if (one.by == sim::DeformationBy::vertices) {
        const Result<render::CoarseWarp> alone =
            render::CoarseWarp::create({{mapOf(one), mappingOf(one, 0)}});
        if (!alone.ok())
            return errorOf(i, alone.error().message);
        return std::optional<render::DeformationTexture>();
    }
    std::string note;
    Result<render::DeformationTexture> texture = textureOf(one, note);
    if (!texture.ok())
        return errorOf(i, texture.error().message);
    const bool closed = one.kind < sim::DeformationKind::points; // refused where they fold
    if (const double folded = closed ? 0 : render::foldedShare(*texture); folded > 0) {
        char text[120];
        std::snprintf(text, sizeof text,
                      "deformation: %s folds in %.2g%% of its box: of two places at rest one is shown",
                      render::nameOf(one.kind), 100 * folded);
        note += (note.empty() ? "" : "; ") + std::string(text);
    }
    notes_[i].made = note;
    return std::optional(std::move(*texture));
}

render::TextureMapping SceneDeformation::mapping(std::size_t i, double time) const {
    return mappingOf(scene_.deformations[i], time);
}

std::string SceneDeformation::name(std::size_t i) const {
    return render::nameOf(scene_.deformations[i].kind);
}

std::vector<std::string> SceneDeformation::notes() const {
    std::vector<std::string> all;
    for (const Notes& of : notes_)
        for (const std::string& note : {of.made, of.placed})
            if (!note.empty())
                all.push_back(note);
    return all;
}

Status SceneDeformation::edit(std::size_t i, const sim::Deformation& now) {
    sim::Deformation& one = scene_.deformations[i];
    if (now.amount != one.amount || now.points != one.points || now.by == sim::DeformationBy::vertices) {
        SEROSA_ASSIGN(std::optional<render::DeformationTexture> texture, makeTexture(now, i));
        textures_[i] = std::move(texture);
    }
    one = now;
    notes_[i].placed.clear();
    ++version_;
    return {};
}

Status SceneDeformation::restore() {
    for (std::size_t i = 0; i < asWritten_.size(); ++i)
        SEROSA_TRY(edit(i, asWritten_[i]));
    return {};
}

render::Warp SceneDeformation::warpOf(std::size_t i, double time) const {
    return {&*textures_[i], mappingOf(scene_.deformations[i], time)};
}

std::optional<std::size_t> SceneDeformation::firstByVertices(std::size_t organ) const {
    for (std::size_t i = 0; i < textures_.size(); ++i)
        if (!textures_[i] && scene_.deformations[i].isOf(organ))
            return i;
    return std::nullopt;
}

Result<std::optional<render::CoarseWarp>> SceneDeformation::coarseAt(std::size_t organ, double time) const {
    std::vector<render::CoarseMap> maps;
    for (std::size_t i = 0; i < textures_.size(); ++i)
        if (!textures_[i] && scene_.deformations[i].isOf(organ))
            maps.push_back({mapOf(scene_.deformations[i]), mappingOf(scene_.deformations[i], time)});
    if (maps.empty())
        return std::optional<render::CoarseWarp>();
    Result<render::CoarseWarp> made = render::CoarseWarp::create(std::move(maps));
    if (!made.ok())
        return errorOf(*firstByVertices(organ), made.error().message);
    return std::optional(std::move(*made));
}

/// Where its box lies does not tear the organ (render/coarse_warp.h), but it may turn it inside out.
Status SceneDeformation::checkCoarse(std::size_t organ, const sim::TriangleMesh& metres) {
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        if (textures_[i] || !scene_.deformations[i].isOf(organ))
            continue;
        for (const double time : timesOf(scene_.deformations[i])) {
            SEROSA_ASSIGN(const std::optional<render::CoarseWarp> warp, coarseAt(organ, time));
            if (const auto at = warp->foldsAt(metres.positions)) {
                char text[160];
                std::snprintf(
                    text, sizeof text,
                    "turns the organ inside out around (%.3g, %.3g, %.3g) mm: take less of it, over a "
                    "larger extent or radius",
                    1e3 * at->x, 1e3 * at->y, 1e3 * at->z);
                return errorOf(i, text);
            }
            const auto box =
                mappingOf(scene_.deformations[i], time).boundsOf(0.5 * scene_.deformations[i].size);
            met_[i] = met_[i] || (glm::all(glm::lessThan(box.lowest, metres.highest())) &&
                                  glm::all(glm::lessThan(metres.lowest(), box.highest)));
        }
    }
    return {};
}

Status SceneDeformation::check(std::size_t organ, const sim::TriangleMesh& metres) {
    const sim::TriangleTree tree(metres.positions, metres.faces);
    const glm::dvec3 lowest = metres.lowest(), highest = metres.highest();
    const auto inside = [&](const glm::dvec3& p) {
        return glm::all(glm::greaterThan(p, lowest)) && glm::all(glm::lessThan(p, highest)) &&
               sim::isInside(tree, p, 2 * glm::distance(lowest, highest));
    };
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        if (!textures_[i] || !scene_.deformations[i].isOf(organ))
            continue;
        for (const double time : timesOf(scene_.deformations[i])) {
            const render::Warp warp = warpOf(i, time);
            const auto faces = render::examineFaces(warp, inside);
            if (const std::string torn = render::tornFaces(faces); !torn.empty())
                return errorOf(i,
                               "the organ crosses a face of its box on which the map does not vanish, and is "
                               "torn there: " +
                                   torn + ": enlarge the box, or move it until these faces lie outside");
            const std::string ending = render::endingFaces(faces);
            if (!ending.empty())
                notes_[i].placed = "deformation: what the " + name(i) +
                                   " moves ends at a face of its box: " + ending +
                                   ": enlarge the box for all of it to be seen";
            const auto box = warp.mapping.boundsOf(warp.texture->half());
            met_[i] = met_[i] || (glm::all(glm::lessThan(box.lowest, highest)) &&
                                  glm::all(glm::lessThan(lowest, box.highest)));
        }
    }
    return checkCoarse(organ, metres);
}

Status SceneDeformation::checkMet() const {
    for (std::size_t i = 0; i < met_.size(); ++i)
        if (!met_[i])
            return errorOf(
                i,
                "has no effect: its box lies outside of every organ that it is of: look at `at` and `size`");
    return {};
}

Status SceneDeformation::checkSizes(int most) const {
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        const glm::ivec3 size = textures_[i] ? textures_[i]->size() : glm::ivec3(0);
        if (const int longest = std::max({size.x, size.y, size.z}); longest > most)
            return errorOf(i, "is of " + std::to_string(longest) +
                                  " texels along a side: this machine's OpenGL has at most " +
                                  std::to_string(most) + ": resample the file");
    }
    return {};
}

Status SceneDeformation::link(const std::vector<std::size_t>& some, double time, Chain& made) const {
    bool together = true;
    std::vector<render::Warp> warps;
    for (const std::size_t i : some) {
        warps.push_back(warpOf(i, time));
        const render::Warp &first = warps.front(), &one = warps.back();
        together = together && one.texture->size() == first.texture->size() &&
                   one.texture->half() == first.texture->half() &&
                   one.mapping.objectFromLocal == first.mapping.objectFromLocal &&
                   one.mapping.cylinderRadius == first.mapping.cylinderRadius;
    }
    if (together) {
        render::DeformationTexture sum = *warps.front().texture;
        for (std::size_t i = 1; i < some.size(); ++i) {
            Result<render::DeformationTexture> more = render::DeformationTexture::sum(sum, *warps[i].texture);
            if (!more.ok())
                return errorOf(some[i], more.error().message);
            sum = std::move(*more);
        }
        made.texture = std::move(sum);
        made.mapping = warps.front().mapping;
        return {};
    }
    Result<render::ChainedWarp> chained = render::chain(warps, formatOf(scene_.deformations[some.front()]));
    if (!chained.ok())
        return errorOf(some.front(), chained.error().message);
    made.texture = std::move(chained->texture);
    made.mapping = chained->mapping;
    return {};
}

Result<std::optional<render::Warp>> SceneDeformation::at(std::size_t organ, double time) {
    std::vector<std::size_t> some;
    for (std::size_t i = 0; i < scene_.deformations.size(); ++i)
        if (textures_[i] && scene_.deformations[i].isOf(organ))
            some.push_back(i);
    if (some.empty())
        return std::optional<render::Warp>();
    if (some.size() == 1)
        return std::optional(warpOf(some.front(), time));
    Chain& chain = chains_[some];
    if (!chain.texture || (moves() && time != chain.time) || chain.version != version_) {
        SEROSA_TRY(link(some, time, chain));
        chain.time = time;
        chain.version = version_;
    }
    return std::optional(render::Warp{&*chain.texture, chain.mapping});
}

glm::dmat4 SceneDeformation::motionAt(std::size_t organ, double time, double while_) const {
    glm::dmat4 furthest(1);
    double most = 0;
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        if (!textures_[i] || !scene_.deformations[i].isOf(organ))
            continue;
        const glm::dmat4 now = warpOf(i, time).mapping.objectFromLocal,
                         before = warpOf(i, time - while_).mapping.objectFromLocal;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec4 at((glm::dvec3(sim::cornerOffset(corner)) * 2.0 - 1.0) * textures_[i]->half(),
                                1);
            const double way = glm::length(now * at - before * at);
            if (way > most) {
                most = way;
                furthest = before * glm::inverse(now);
            }
        }
    }
    return furthest;
}

bool SceneDeformation::moves() const {
    return std::any_of(scene_.deformations.begin(), scene_.deformations.end(),
                       [](const sim::Deformation& one) { return one.keys.size() > 1; });
}

render::StageBox SceneDeformation::stageBox(double time, double seam) const {
    const render::Warp warp = warpOf(0, time); // the only one (sim/scene_reader_deformation.h)
    const auto nowhere = [](const glm::dvec3&) { return false; };
    return render::StageBox::of(warp, render::examineFaces(warp, nowhere), seam);
}

} // namespace serosa::app
