#pragma once
// What a run notes of organs that touch and of threads, for the summary.

#include "app/run_setup.h"
#include "app/scene_player.h"
#include "app/summary.h"

namespace serosa::app {

/// An entry for each thread, and for each two organs that may touch.
void beginCoupling(const RunParts& parts, RunRecord& record);
/// A sample of all of them at a time (s), after a check: forces in threads now, and what organs gave each
/// other since the sample before, as a mean. Waits for the GPU.
void sampleCoupling(const RunParts& parts, ScenePlayer& player, double time, RunRecord& record);

} // namespace serosa::app
