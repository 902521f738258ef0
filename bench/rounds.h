#pragma once
// The rounds of app/rounds.h, which `serosa bench` takes too, under this folder's namespace.

#include "app/rounds.h"

namespace serosa::bench {

using app::Rounds;
using app::Spread;
using app::spreadOf;

} // namespace serosa::bench
