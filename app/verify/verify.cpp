// The framework of `serosa verify`: checks, groups, and running them.

#include "app/verify/verify.h"

#include "app/organ_setup.h"
#include "app/verify/html.h"
#include "app/verify/report.h"
#include "app/version.h"
#include "base/atomic_file.h"
#include "sim/suggest.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

namespace serosa::app {

namespace {

namespace fs = std::filesystem;

void printError(const Error& error) {
    std::cerr << "serosa: error: " << error.message << "\n";
}

Result<std::vector<const VerifyGroup*>> chooseGroups(const std::vector<std::string>& names) {
    std::vector<std::string> known;
    for (const VerifyGroup& group : verifyGroups())
        known.push_back(group.name);
    for (const std::string& name : names)
        if (std::find(known.begin(), known.end(), name) == known.end())
            return Error{"unknown group '" + name + "'" + sim::suggestion(name, known)};
    std::vector<const VerifyGroup*> chosen;
    for (const VerifyGroup& group : verifyGroups())
        if (names.empty() || std::find(names.begin(), names.end(), group.name) != names.end())
            chosen.push_back(&group);
    return chosen;
}

/// Makes the report's folder before the long work, so that a wrong --out is said at once.
Status makeFolder(const std::string& folder) {
    std::error_code code;
    if (!folder.empty() && !fs::is_directory(folder, code)) {
        fs::create_directories(folder, code);
        if (code)
            return Error{folder + ": cannot be made: " + code.message() +
                         ": choose another folder with --out"};
    }
    return {};
}

/// As `--inject` has it; empty for none.
std::string injectionText(const Injection& injection) {
    switch (injection.fault) {
    case Fault::none:
        return "";
    case Fault::stiffness:
        return "stiffness=" + shortNumber(injection.factor);
    case Fault::dropSpring:
        return "drop-spring";
    case Fault::staleNormal:
        return "stale-normal";
    }
    return "";
}

Status writeFiles(const fs::path& folder, const std::vector<GroupChecks>& results, bool allowSkip,
                  VerifyPageFacts facts) {
    for (const GroupChecks& group : results)
        for (const VerifyPicture& picture : group.pictures) {
            const fs::path file = folder / (picture.name + ".png");
            SEROSA_TRY(render::writePng(picture.image, file));
            std::ifstream stream(file, std::ios::binary);
            facts.pictures.push_back({group.group,
                                      {std::istreambuf_iterator<char>(stream), {}},
                                      picture.caption + " (" + picture.name + ".png)"});
        }
    const nlohmann::ordered_json json = verifyJson(results, allowSkip);
    SEROSA_TRY(writeFileAtomically(folder / "verify.json", std::string_view(json.dump(1) + "\n")));
    return writeFileAtomically(folder / "report.html", std::string_view(verifyReport(json, facts)));
}

} // namespace

const char* checkKindName(CheckKind kind) {
    switch (kind) {
    case CheckKind::equalAbs:
        return "equal_abs";
    case CheckKind::equalRel:
        return "equal_rel";
    case CheckKind::atMost:
        return "at_most";
    case CheckKind::atLeast:
        return "at_least";
    }
    return "";
}

bool Check::pass() const {
    if (skipped || !std::isfinite(measured) || !std::isfinite(expected))
        return false;
    switch (kind) {
    case CheckKind::equalAbs:
        return std::abs(measured - expected) <= tolerance;
    case CheckKind::equalRel:
        return std::abs(measured - expected) <= tolerance * std::abs(expected);
    case CheckKind::atMost:
        return measured <= expected;
    case CheckKind::atLeast:
        return measured >= expected;
    }
    return false;
}

void CheckList::equalAbs(std::string name, double measured, double expected, double tolerance,
                         std::string unit) {
    checks_.push_back(
        {std::move(name), CheckKind::equalAbs, measured, expected, tolerance, std::move(unit), false, ""});
}
void CheckList::equalRel(std::string name, double measured, double expected, double tolerance,
                         std::string unit) {
    checks_.push_back(
        {std::move(name), CheckKind::equalRel, measured, expected, tolerance, std::move(unit), false, ""});
}
void CheckList::atMost(std::string name, double measured, double limit, std::string unit) {
    checks_.push_back({std::move(name), CheckKind::atMost, measured, limit, 0, std::move(unit), false, ""});
}
void CheckList::atLeast(std::string name, double measured, double limit, std::string unit) {
    checks_.push_back({std::move(name), CheckKind::atLeast, measured, limit, 0, std::move(unit), false, ""});
}
void CheckList::skip(std::string name, std::string why) {
    checks_.push_back({std::move(name), CheckKind::atMost, 0, 0, 0, "", true, std::move(why)});
}

const std::vector<VerifyGroup>& verifyGroups() {
    static const std::vector<VerifyGroup> groups = {
        {"solver", "the spring lattice against theory and against its reference", true, verifySolver},
        {"materials", "tissue against the theory of elasticity, nearly incompressible too", true,
         verifyMaterials},
        {"fem", "an organ against a finite-element solution with quadratic tetrahedra", true, verifyFem},
        {"cuts", "strokes through the lattice: what they cut, on CPU and GPU, and what falls apart", true,
         verifyCuts},
        {"stability", "random organs, tools and cuts: no state runs away, and the step's bound is one", true,
         verifyStability},
        {"implicit",
         "one step a frame: stiff organs stable, at rest and swinging as they should, solvers alike", true,
         verifyImplicit},
        {"contact",
         "what touches an organ: bounce, friction, impulses, probes that must not pass, organs and folds",
         true, verifyContact},
        {"grasp", "what holds tissue: grip that slips at its force, torque, several at once, threads", true,
         verifyGrasp},
        {"lod", "switches of detail in motion, and the tree that answers picking and candidates", true,
         verifyLod},
        {"mapping", "the surface mappings against motions whose result is known", true, verifyMapping},
        {"surface", "MS05's figures as numbers, exactness on random surfaces, normals: every mapping", true,
         verifySurface},
        {"raycast", "the deformation shader against rays cast in double, closed forms, and CS07's figure 3",
         true, verifyRaycast},
    };
    return groups;
}

int runVerify(const std::vector<std::string>& names, const VerifyOptions& options, const std::string& folder,
              bool allowSkip, std::ostream& out) {
    auto chosen = chooseGroups(names);
    if (!chosen) {
        printError(chosen.error());
        return chosen.error().exitCode;
    }
    std::unique_ptr<gpu::Context> context;
    if (std::any_of(chosen->begin(), chosen->end(),
                    [](const VerifyGroup* group) { return group->needsGl; })) {
        auto created = gpu::createContext(options.gl);
        if (!created) {
            printError(created.error());
            return created.error().exitCode;
        }
        context = std::move(*created);
        out << "context: " << gpu::contextKindName(context->kind()) << ", " << context->info().renderer
            << "\n";
    }
    if (const Status made = makeFolder(folder); !made.ok()) {
        printError(made.error());
        return made.error().exitCode;
    }

    std::vector<GroupChecks> results;
    VerifyPageFacts facts{programVersion(),
                          context ? context->info().renderer : "",
                          injectionText(options.inject),
                          options.full,
                          {}};
    std::size_t failed = 0, total = 0;
    for (const VerifyGroup* group : *chosen) {
        CheckList list;
        const auto start = std::chrono::steady_clock::now();
        if (const Status ran = group->run(options, list); !ran.ok()) {
            printError(Error{"group " + group->name + ": " + ran.error().message});
            return ran.error().exitCode;
        }
        results.push_back({group->name, list.checks(), list.pictures()});
        printChecks(results.back(), allowSkip, out);
        const auto rejected = std::count_if(list.checks().begin(), list.checks().end(),
                                            [&](const Check& check) { return !accepted(check, allowSkip); });
        failed += std::size_t(rejected);
        total += list.checks().size();
        // A group that measured nothing has verified nothing.
        if (list.checks().empty()) {
            out << "  FAIL  the group holds no check\n";
            ++failed;
        }
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        facts.seconds.emplace_back(group->name, took.count());
        out << "  " << list.checks().size() - std::size_t(rejected) << " of " << list.checks().size()
            << " passed in " << shortNumber(took.count()) << " s\n";
    }
    if (!folder.empty())
        if (const Status written = writeFiles(folder, results, allowSkip, facts); !written.ok()) {
            printError(written.error());
            return written.error().exitCode;
        }
    out << (failed == 0 ? "all " + std::to_string(total) + " checks passed"
                        : std::to_string(failed) + " failed")
        << "\n";
    return failed == 0 ? exitOk : exitCheckFailed;
}

} // namespace serosa::app
