// See app/level_state.h. Bytes: wanted, calmer (u32), frame of the last change (i64), looks, patience (u32),
// frame of the last change to a coarser level or -1 (i64); for each pair of levels a list (u64) of three f64;
// a list (u64) of f32.
#include "app/level_state.h"

#include "app/level_rule.h"
#include "app/run_setup.h"
#include "sim/byte_stream.h"

#include <cmath>

namespace serosa::app {

std::string LevelState::bytes() const {
    sim::ByteWriter out;
    if (details.empty() && blend.empty())
        return out.take();
    out.u32(std::uint32_t(choice.wanted));
    out.u32(std::uint32_t(choice.calmer));
    out.i64(choice.changedAt);
    out.u32(std::uint32_t(choice.looks));
    out.u32(std::uint32_t(choice.patience));
    out.i64(choice.coarserAt);
    for (const sim::LodDetail& detail : details) {
        out.u64(detail.size());
        for (const glm::dvec3& item : detail)
            for (int axis = 0; axis < 3; ++axis)
                out.f64(item[axis]);
    }
    out.u64(blend.size());
    for (const float value : blend)
        out.f32(value);
    return out.take();
}

std::optional<LevelState> LevelState::parse(std::string_view bytes, const RunParts& parts, std::size_t organ,
                                            int frame) {
    const OrganLevels& levels = parts.levels[organ];
    LevelState state;
    if (levels.count() == 1 && bytes.empty())
        return state;
    sim::ByteReader in(bytes, 0);
    const std::uint32_t wanted = in.u32(), calmer = in.u32();
    const std::int64_t changedAt = in.i64();
    const std::uint32_t looks = in.u32(), patience = in.u32();
    const std::int64_t coarserAt = in.i64();
    const auto isLevel = [&levels](std::uint32_t level) {
        return level >= 1 && level <= std::uint32_t(levels.count());
    };
    if (!isLevel(wanted) || !isLevel(calmer) || changedAt < 0 || changedAt > frame || looks > kMostPatience ||
        patience < kLeastPatience || patience > kMostPatience || coarserAt < -1 || coarserAt > frame)
        return std::nullopt;
    state.choice = {int(wanted), int(calmer), int(changedAt), int(looks), int(patience), int(coarserAt)};
    bool finite = true;
    for (int level = 1; level < levels.count(); ++level) {
        sim::LodDetail detail(in.count(in.u64(), 24));
        if (!detail.empty() && detail.size() != levels.nodes(parts, organ, level))
            return std::nullopt;
        for (glm::dvec3& item : detail)
            for (int axis = 0; axis < 3; ++axis) {
                item[axis] = in.f64();
                finite = finite && std::isfinite(item[axis]);
            }
        state.details.push_back(std::move(detail));
    }
    state.blend.resize(in.count(in.u64(), 4));
    // Seams of textures and copies along cuts are vertices, too: how many, the drawing knows once it shows
    // them.
    if (state.blend.size() % 6 != 0 ||
        (!state.blend.empty() &&
         state.blend.size() < 6 * parts.organs[organ]->surface.metres.positions.size()))
        return std::nullopt;
    for (float& value : state.blend) {
        value = in.f32();
        finite = finite && std::isfinite(value);
    }
    return in.failed() || in.left() != 0 || !finite ? std::nullopt : std::optional(std::move(state));
}

} // namespace serosa::app
