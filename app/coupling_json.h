#pragma once
// What summary.json says of organs that touch and of threads.

#include "app/summary.h"

#include <nlohmann/json.hpp>

namespace serosa::app {

/// One entry a pair of organs that may touch, and an organ that may touch itself: forces at the samples.
nlohmann::ordered_json contactsJson(const RunRecord& record);
/// One entry a thread: its force at the samples, the largest, and whether and when it broke.
nlohmann::ordered_json threadsJson(const RunRecord& record);

} // namespace serosa::app
