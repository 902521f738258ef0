// See app/verify/report.h.

#include "app/verify/report.h"

#include "app/organ_setup.h"

#include <algorithm>
#include <cstdio>

namespace serosa::app {

namespace {

std::string requirement(const Check& check) {
    const std::string expected = shortNumber(check.expected), tolerance = shortNumber(check.tolerance);
    switch (check.kind) {
    case CheckKind::equalAbs:
        return expected + " +- " + tolerance;
    case CheckKind::equalRel:
        return expected + " +- " + shortNumber(100 * check.tolerance) + "%";
    case CheckKind::atMost:
        return "<= " + expected;
    case CheckKind::atLeast:
        return ">= " + expected;
    }
    return "";
}

} // namespace

bool accepted(const Check& check, bool allowSkip) {
    return check.skipped ? allowSkip : check.pass();
}

nlohmann::ordered_json verifyJson(const std::vector<GroupChecks>& groups, bool allowSkip) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const GroupChecks& group : groups) {
        json[group.group] = nlohmann::ordered_json::array();
        for (const Check& check : group.checks) {
            nlohmann::ordered_json entry = {{"name", check.name},
                                            {"kind", checkKindName(check.kind)},
                                            {"measured", check.measured},
                                            {"expected", check.expected},
                                            {"tolerance", check.tolerance},
                                            {"unit", check.unit},
                                            {"pass", accepted(check, allowSkip)}};
            if (check.skipped) {
                entry["measured"] = entry["expected"] = entry["tolerance"] = nullptr;
                entry["skipped"] = check.note;
            }
            json[group.group].push_back(std::move(entry));
        }
    }
    return json;
}

void printChecks(const GroupChecks& group, bool allowSkip, std::ostream& out) {
    std::size_t width = 20;
    for (const Check& check : group.checks)
        width = std::max(width, check.name.size());
    out << group.group << "\n";
    for (const Check& check : group.checks) {
        const std::string name = check.name + std::string(width - check.name.size(), ' ');
        if (check.skipped) {
            out << "  " << (allowSkip ? "skip" : "SKIP") << "  " << name << "  " << check.note << "\n";
            continue;
        }
        char figures[128];
        std::snprintf(figures, sizeof figures, "%12s  %-24s %s", shortNumber(check.measured).c_str(),
                      requirement(check).c_str(), check.unit.c_str());
        out << "  " << (check.pass() ? "ok  " : "FAIL") << "  " << name << "  " << figures
            << (check.note.empty() ? "" : "  (" + check.note + ")") << "\n";
    }
    out << std::flush;
}

} // namespace serosa::app
