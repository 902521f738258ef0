// See sim/scene_reader_coupling.h.
#include "sim/scene_reader_coupling.h"

#include "shaders/shared_constants.h"
#include "sim/quantity.h"
#include "sim/suggest.h"

#include <algorithm>

namespace serosa::sim {

namespace {

/// Two places nearer than this are one.
constexpr double kOnePlace = 1e-9; // m

Status readEnd(const SceneTable& table, const Scene& scene, ThreadEnd& end) {
    SEROSA_TRY(table.checkKeys());
    end.line = table.lineOf("at");
    if (scene.organs.size() == 1)
        end.organ = scene.organs.front().name;
    else if (!table.has("organ"))
        return table.errorAt("organ",
                             "'organ' is missing: the scene has several organs, so say which of them");
    SEROSA_TRY(table.read("organ", end.organ));
    SEROSA_TRY(table.read("at", end.at));
    std::vector<std::string> names;
    for (const Organ& organ : scene.organs)
        names.push_back(organ.name);
    const auto found = std::find(names.begin(), names.end(), end.organ);
    if (found == names.end())
        return table.errorAt("organ",
                             "no organ is named " + inQuotes(end.organ) + suggestion(end.organ, names));
    if (scene.organs[std::size_t(found - names.begin())].pose)
        return table.errorAt("organ",
                             inQuotes(end.organ) +
                                 " has a pose, and follows no thread: tie to an organ that is simulated");
    return {};
}

Status readThread(const SceneSource& source, const toml::table& content, std::size_t index,
                  const Scene& scene, Thread& thread) {
    const std::string path = "thread[" + std::to_string(index) + "]";
    const SceneTable table(source, "thread", path, &content);
    SEROSA_TRY(table.checkKeys());
    thread.name = "thread " + std::to_string(index + 1);
    thread.line = table.lineOf("ends");
    SEROSA_TRY(table.read("name", thread.name));
    enum class Kind { pulls, clips } kind = Kind::pulls;
    SEROSA_TRY(table.readWord("kind", kind));
    thread.clip = kind == Kind::clips;
    SEROSA_TRY(table.read("t", thread.time));
    std::optional<double> length, strength;
    SEROSA_TRY(table.read("length", length));
    SEROSA_TRY(table.read("tightening", thread.tightening));
    SEROSA_TRY(table.read("strength", strength));
    thread.strength = strength.value_or(thread.strength);

    SEROSA_ASSIGN(const auto ends, table.tables("ends"));
    if (ends.size() != 2)
        return table.errorAt("ends",
                             "has " + std::to_string(ends.size()) +
                                 " entries, and a thread has two ends: ends = [{ organ = ..., at = ... }, "
                                 "{ organ = ..., at = ... }]");
    for (std::size_t i = 0; i < 2; ++i)
        SEROSA_TRY(readEnd({source, "thread.ends", path + ".ends[" + std::to_string(i) + "]", ends[i]}, scene,
                           thread.ends[i]));
    const double apart = glm::distance(thread.ends[0].at, thread.ends[1].at);
    if (apart < kOnePlace && thread.ends[0].organ == thread.ends[1].organ)
        return table.errorAt("ends", "ties a place of " + inQuotes(thread.ends[0].organ) +
                                         " to itself: move one of the two ends");
    if (apart < kOnePlace && !length)
        return table.errorAt("length",
                             "'length' is missing: the two ends lie at one place, which says no length");
    thread.length = length.value_or(apart);
    return {};
}

} // namespace

Status readOrganContact(const SceneTable& top, Scene& scene) {
    SEROSA_TRY(top.read("organs_touch", scene.organsTouch));
    scene.organsTouchLine = top.lineOf("organs_touch");
    return top.read("organ_friction", scene.organFriction);
}

Status readThreads(const SceneSource& source, const SceneTable& top, Scene& scene) {
    SEROSA_ASSIGN(const auto threads, top.tables("thread"));
    if (threads.size() > SRS_MAX_THREADS)
        return top.errorAt("thread", "the scene has " + std::to_string(threads.size()) +
                                         " threads, at most " + std::to_string(SRS_MAX_THREADS) +
                                         " are possible");
    for (std::size_t i = 0; i < threads.size(); ++i) {
        Thread thread;
        SEROSA_TRY(readThread(source, *threads[i], i, scene, thread));
        if (std::any_of(scene.threads.begin(), scene.threads.end(),
                        [&thread](const Thread& other) { return other.name == thread.name; }))
            return SceneTable(source, "thread", "thread[" + std::to_string(i) + "]", threads[i])
                .errorAt("name", inQuotes(thread.name) + " is the name of another thread already: name each");
        scene.threads.push_back(std::move(thread));
    }
    return {};
}

Status checkCoupling(const SceneSource& source, const SceneTable& top,
                     const std::vector<const toml::table*>& organs, const Scene& scene) {
    const auto simulated = std::count_if(scene.organs.begin(), scene.organs.end(),
                                         [](const Organ& organ) { return !organ.pose; });
    if (scene.organsTouch && simulated < 2)
        return top.errorAt("organs_touch", "has no effect: the scene has " + std::to_string(simulated) +
                                               " organs that are simulated, and two can touch; parts of one "
                                               "organ touch with self_contact = true");
    const bool meets = scene.organsTouch || std::any_of(scene.organs.begin(), scene.organs.end(),
                                                        [](const Organ& organ) { return organ.selfContact; });
    if (scene.organFriction > 0 && !meets)
        return top.errorAt("organ_friction", "has no effect: no organ touches another or itself; set "
                                             "organs_touch = true, or self_contact = true of an organ");
    for (std::size_t i = 0; i < organs.size(); ++i) {
        const auto refuse = [&](const char* key, const std::string& why) {
            return SceneTable(source, "organ", "organ[" + std::to_string(i) + "]", organs[i])
                .errorAt(key, why + ": remove it, or the coupling of line " +
                                  std::to_string(couplingOf(scene, i).line));
        };
        if (!couplingOf(scene, i).any())
            continue;
        if (scene.organs[i].levels > 1)
            return refuse("levels",
                          "stands beside contact between organs or a thread, which work on one lattice");
        if (scene.organs[i].method == StepMethod::implicit)
            return refuse(
                "method",
                "is \"implicit\" beside contact between organs or a thread, which take explicit steps");
    }
    return {};
}

} // namespace serosa::sim
