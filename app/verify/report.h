#pragma once
// How the program's verification is printed and written: the table on the terminal and verify.json.

#include "app/verify/verify.h"

#include <nlohmann/json.hpp>

#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace serosa::app {

struct GroupChecks {
    std::string group;
    std::vector<Check> checks;
    std::vector<VerifyPicture> pictures = {};
};

/// {group: [{name, kind, measured, expected, tolerance, unit, pass}]}; a skipped check has pass false (true
/// where skipping is allowed), null figures and the reason under "skipped". A figure that is not finite is
/// null.
nlohmann::ordered_json verifyJson(const std::vector<GroupChecks>& groups, bool allowSkip);

/// One line a check, with what was measured, what was expected and whether it passes.
void printChecks(const GroupChecks& group, bool allowSkip, std::ostream& out);

/// Passed, or skipped where that is allowed.
bool accepted(const Check& check, bool allowSkip);

} // namespace serosa::app
