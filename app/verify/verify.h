#pragma once
// `serosa verify`: the program's own verification. Each group measures what is known without the program and
// says what was measured, expected, the tolerance and its unit. The tests call the same groups.

#include "base/result.h"
#include "gpu/context.h"
#include "render/image.h"

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace serosa::app {

enum class CheckKind { equalAbs, equalRel, atMost, atLeast };
/// "equal_abs", "equal_rel", "at_most", "at_least"
const char* checkKindName(CheckKind kind);

/// equal_abs: |measured - expected| <= tolerance; equal_rel: <= tolerance |expected|; at_most: measured <=
/// expected (1 + tolerance is not used: 0); at_least: measured >= expected. NaN never passes.
struct Check {
    std::string name;
    CheckKind kind = CheckKind::atMost;
    double measured = 0, expected = 0, tolerance = 0;
    std::string unit;
    bool skipped = false; // a skipped check is a failure unless --allow-skip
    std::string note;     // why skipped, or what the figure is
    bool pass() const;
};

/// Faults that `--inject` puts into the program, to show that the group that owns it fails.
enum class Fault { none, stiffness, dropSpring, staleNormal };
struct Injection {
    Fault fault = Fault::none;
    double factor = 1; // stiffness
};

struct VerifyOptions {
    gpu::GlChoice gl = gpu::GlChoice::automatic;
    Injection inject;
    std::string solver; // group solver: compared with the reference on the heart; empty: all
    bool full = false;  // --full: every figure at its full length (nightly); else the same checks on shorter
                        // runs where said
};

/// A picture of what was measured: NAME.png in the output folder, and in the report.
struct VerifyPicture {
    std::string name; // without .png
    render::Image image;
    std::string caption;
};

/// Collects the checks of one group, and its pictures.
class CheckList {
public:
    void equalAbs(std::string name, double measured, double expected, double tolerance, std::string unit);
    void equalRel(std::string name, double measured, double expected, double tolerance, std::string unit);
    void atMost(std::string name, double measured, double limit, std::string unit);
    void atLeast(std::string name, double measured, double limit, std::string unit);
    void skip(std::string name, std::string why);
    void picture(VerifyPicture picture) { pictures_.push_back(std::move(picture)); }
    const std::vector<Check>& checks() const { return checks_; }
    const std::vector<VerifyPicture>& pictures() const { return pictures_; }

private:
    std::vector<Check> checks_;
    std::vector<VerifyPicture> pictures_;
};

/// A group needs a GL context current when it runs if `needsGl`. An error (not a failed check) is a Status.
struct VerifyGroup {
    std::string name, description;
    bool needsGl = false;
    std::function<Status(const VerifyOptions&, CheckList&)> run;
};
const std::vector<VerifyGroup>& verifyGroups();

Status verifySolver(const VerifyOptions& options, CheckList& checks);    // app/verify/solver.cpp
Status verifyMapping(const VerifyOptions& options, CheckList& checks);   // app/verify/mapping.cpp
Status verifySurface(const VerifyOptions& options, CheckList& checks);   // app/verify/surface_cases.cpp
Status verifyMaterials(const VerifyOptions& options, CheckList& checks); // app/verify/materials.cpp
Status verifyFem(const VerifyOptions& options, CheckList& checks);       // app/verify/fem.cpp
Status verifyCuts(const VerifyOptions& options, CheckList& checks);      // app/verify/cuts.cpp
Status verifyLod(const VerifyOptions& options, CheckList& checks);       // app/verify/lod.cpp
/// The part of group `lod` about sim/node_tree.h.
Status verifyNodeTree(const VerifyOptions& options, CheckList& checks);  // app/verify/node_tree.cpp
Status verifyStability(const VerifyOptions& options, CheckList& checks); // app/verify/stability.cpp
Status verifyContact(const VerifyOptions& options, CheckList& checks);   // app/verify/contact.cpp
Status verifyGrasp(const VerifyOptions& options, CheckList& checks);     // app/verify/grasp.cpp
Status verifyRaycast(const VerifyOptions& options, CheckList& checks);   // app/verify/raycast.cpp
Status verifyImplicit(const VerifyOptions& options, CheckList& checks);  // app/verify/implicit.cpp
/// The part of group `implicit` with random organs.
Status verifyImplicitScenarios(const VerifyOptions& options,
                               CheckList& checks); // app/verify/implicit_scenarios.cpp

/// Runs groups (all if `names` is empty), prints the table, writes `folder`/verify.json, report.html and the
/// groups' pictures if folder is not empty. Returns an exit code: 0, 1 (a check failed), 2 (unknown group), 5
/// (no context).
int runVerify(const std::vector<std::string>& names, const VerifyOptions& options, const std::string& folder,
              bool allowSkip, std::ostream& out);

} // namespace serosa::app
