// See app/coupling_record.h.
#include "app/coupling_record.h"

namespace serosa::app {

void beginCoupling(const RunParts& parts, RunRecord& record) {
    record.threads.resize(parts.scene.threads.size());
    const std::vector<std::size_t>& organs = parts.coupled.organs;
    for (std::size_t a = 0; a < organs.size(); ++a)
        for (std::size_t b = a; b < organs.size(); ++b) {
            const sim::OrganCoupling first = sim::couplingOf(parts.scene, organs[a]),
                                     second = sim::couplingOf(parts.scene, organs[b]);
            if (a == b ? first.touchesItself : first.touches && second.touches)
                record.contacts.push_back({{organs[a], organs[b]}, {}});
        }
}

void sampleCoupling(const RunParts& parts, ScenePlayer& player, double time, RunRecord& record) {
    const std::vector<sim::ThreadState> threads = player.threads();
    for (std::size_t i = 0; i < threads.size(); ++i) {
        record.threads[i].last = threads[i];
        record.threads[i].samples.push_back({time, threads[i].force});
    }
    const sim::PairLoads loads = player.takePairLoads();
    for (PairRecord& pair : record.contacts) {
        PairRecord::Sample sample{time, {}, 0};
        const double passed = pair.samples.empty() ? 0 : time - pair.samples.back().time;
        if (!loads.empty() && passed > 0) {
            const sim::PairLoad& load = loads[std::size_t(parts.coupled.placeOf(pair.organs[0]))]
                                             [std::size_t(parts.coupled.placeOf(pair.organs[1]))];
            sample.force = load.impulse / passed;
            sample.pressed = load.pressed / passed;
        }
        pair.samples.push_back(sample);
    }
}

} // namespace serosa::app
