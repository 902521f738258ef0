// See app/coupling_json.h.
#include "app/coupling_json.h"

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

using Json = nlohmann::ordered_json;

Json vec(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

} // namespace

Json contactsJson(const RunRecord& record) {
    Json contacts = Json::array();
    for (const PairRecord& pair : record.contacts) {
        const bool itself = pair.organs[0] == pair.organs[1];
        Json json, samples = Json::array();
        for (std::size_t i = 0; i < (itself ? 1 : 2); ++i)
            json["organs"].push_back(record.scene.organs[pair.organs[i]].name);
        json["friction"] = record.scene.organFriction;
        double force = 0, pressed = 0;
        for (const PairRecord::Sample& sample : pair.samples) {
            force = std::max(force, glm::length(sample.force));
            pressed = std::max(pressed, sample.pressed);
            Json one = {{"t_s", sample.time}, {"pressed_N", sample.pressed}};
            if (!itself)
                one["N"] = vec(sample.force);
            samples.push_back(std::move(one));
        }
        if (!itself)
            json["largest_force_N"] = force;
        json["largest_pressed_N"] = pressed;
        json["force"] = std::move(samples);
        contacts.push_back(std::move(json));
    }
    return contacts;
}

Json threadsJson(const RunRecord& record) {
    Json threads = Json::array();
    for (std::size_t i = 0; i < record.threads.size(); ++i) {
        const sim::Thread& thread = record.scene.threads[i];
        const sim::ThreadState& last = record.threads[i].last;
        Json json = {{"name", thread.name}, {"kind", thread.clip ? "clip" : "thread"}};
        for (const sim::ThreadEnd& end : thread.ends)
            json["ends"].push_back({{"organ", end.organ}, {"at_m", vec(end.at)}});
        json["length_m"] = thread.length;
        if (std::isfinite(thread.strength))
            json["strength_N"] = thread.strength;
        json["tied"] = last.startLength >= 0;
        json["broken"] = last.broken;
        if (last.broken)
            json["broken_t_s"] = thread.time + last.brokenAfter;
        json["force_N"] = last.force;
        json["largest_force_N"] = last.mostForce;
        Json samples = Json::array();
        for (const ThreadRecord::Sample& sample : record.threads[i].samples)
            samples.push_back({{"t_s", sample.time}, {"N", sample.force}});
        json["force"] = std::move(samples);
        threads.push_back(std::move(json));
    }
    return threads;
}

} // namespace serosa::app
