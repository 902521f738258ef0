// See app/verify/html.h.

#include "app/verify/html.h"

#include "app/html_page.h"
#include "app/organ_setup.h"
#include "app/run_tables.h"
#include "app/si_text.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace serosa::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kBarWidth = 100;
constexpr const char* kShare = "Used of the limit";
constexpr int kFewestDigits = 4, kMostDigits = 9;

bool passed(const Json& check) {
    return check.at("pass").get<bool>();
}

std::string plural(std::size_t count, const std::string& one) {
    return grouped(count) + " " + one + (count == 1 ? "" : "s");
}

struct Totals {
    std::size_t checks = 0, failed = 0, skipped = 0, emptyGroups = 0;
};

void add(Totals& totals, const Json& group) {
    totals.checks += group.size();
    totals.emptyGroups += group.empty();
    for (const Json& check : group) {
        totals.failed += !passed(check);
        totals.skipped += check.contains("skipped");
    }
}

PageHead headOf(const Json& checks, const VerifyPageFacts& facts) {
    Totals all;
    for (const Json& group : checks)
        add(all, group);
    PageHead head;
    head.title = "Verification";
    head.kind = "serosa verify";
    head.subtitle = "serosa " + facts.version + (facts.renderer.empty() ? "" : ", " + facts.renderer) +
                    (facts.full ? ", every figure at its full length" : "");
    const std::size_t failed = all.failed + all.emptyGroups;
    if (failed > 0) {
        head.verdict = Verdict::bad;
        head.summary = all.failed > 0
                           ? grouped(all.failed) + " of " + plural(all.checks, "check") + " failed."
                           : plural(all.emptyGroups, "group") + " without a check.";
    } else {
        head.verdict = all.skipped > 0 ? Verdict::warning : Verdict::good;
        head.summary = all.skipped > 0   ? "No check failed, " + grouped(all.skipped) + " skipped."
                       : all.checks == 1 ? "The check passed."
                                         : "All " + plural(all.checks, "check") + " passed.";
    }
    if (!facts.injected.empty())
        head.detail = "A fault was put in on purpose: --inject " + facts.injected + ".";
    return head;
}

/// Enough digits to see the tolerance in the figures: a fall of 1.753987 m is asked for to 0.001 %.
int digitsOf(const Json& check) {
    const std::string kind = check.at("kind").get<std::string>();
    const double expected = std::abs(figureOf(check, "expected")), tolerance = figureOf(check, "tolerance");
    const double share = kind == "equal_rel" ? tolerance : tolerance / expected;
    if (!kind.starts_with("equal") || !std::isfinite(share) || share <= 0)
        return kFewestDigits;
    return std::clamp(2 + int(std::ceil(-std::log10(share))), kFewestDigits, kMostDigits);
}

std::string expectedText(const Json& check) {
    const std::string value = numberText(figureOf(check, "expected"), digitsOf(check));
    const std::string kind = check.at("kind").get<std::string>();
    return kind == "at_most" ? "\u2264\u00A0" + value : kind == "at_least" ? "\u2265\u00A0" + value : value;
}

std::string toleranceText(const Json& check) {
    const std::string kind = check.at("kind").get<std::string>();
    const double tolerance = figureOf(check, "tolerance");
    return kind == "equal_abs"   ? "\u00B1\u00A0" + numberText(tolerance)
           : kind == "equal_rel" ? "\u00B1\u00A0" + numberText(100 * tolerance) + "\u00A0%"
                                 : "\u2013";
}

void writeShare(Markup& page, const Json& check) {
    const double share = shareOfLimit(check);
    page.open("td", {{"class", "share"}, {"data-label", kShare}});
    if (std::isfinite(share)) {
        page.open("svg",
                  {{"viewBox", "0 0 100 8"}, {"preserveAspectRatio", "none"}, {"aria-hidden", "true"}});
        page.empty("rect", {{"width", numberText(kBarWidth * std::clamp(share, 0.0, 1.0))}, {"height", "8"}});
        page.close();
        page.open("span").text(share > 9.99 ? ">\u00A0999\u00A0%"
                                            : numberText(std::round(100 * share)) + "\u00A0%");
        page.close();
    } else {
        page.text("\u2013");
    }
    page.close();
}

void writeCheck(Markup& page, const Json& check, const std::string& group) {
    const bool pass = passed(check), skipped = check.contains("skipped");
    page.open("tr", {{"class", pass ? "check" : "check failed"}});
    page.element("td",
                 {{"class", std::string("result ") + (skipped ? "skip"
                                                      : pass  ? "pass"
                                                              : "fail")}},
                 skipped ? "\u2013 skipped"
                 : pass  ? "\u2713 pass"
                         : "\u2717 FAIL");
    page.open("th", {{"scope", "row"}, {"class", "name"}});
    page.text((group.empty() ? "" : group + ": ") + check.at("name").get<std::string>());
    page.close();
    if (skipped) {
        page.element("td", {{"class", "why"}, {"colspan", "5"}}, check["skipped"].get<std::string>()).close();
        return;
    }
    const auto figure = [&page](const char* label, const std::string& value) {
        page.element("td", {{"class", "number"}, {"data-label", label}}, value);
    };
    figure("Measured", numberText(figureOf(check, "measured"), digitsOf(check)));
    figure("Expected", expectedText(check));
    figure("Tolerance", toleranceText(check));
    page.element("td", {{"class", "unit-cell"}, {"data-label", "Unit"}}, check.at("unit").get<std::string>());
    writeShare(page, check);
    page.close();
}

using Row = std::pair<const Json*, std::string>; // a check, and its group where it must be said

void writeChecks(Markup& page, const std::vector<Row>& rows) {
    page.open("div", {{"class", "scroll checks-scroll"}}).open("table", {{"class", "checks"}});
    page.open("thead").open("tr");
    page.element("th", {{"scope", "col"}}, "Result").element("th", {{"scope", "col"}}, "Check");
    for (const char* heading : {"Measured", "Expected", "Tolerance"})
        page.element("th", {{"scope", "col"}, {"class", "number"}}, heading);
    page.element("th", {{"scope", "col"}}, "Unit").element("th", {{"scope", "col"}}, kShare);
    page.close().close().open("tbody");
    for (const auto& [check, group] : rows)
        writeCheck(page, *check, group);
    page.close().close().close();
}

/// Failures first, else as they were measured.
std::vector<Row> sorted(const Json& group) {
    std::vector<Row> rows;
    for (const Json& check : group)
        rows.emplace_back(&check, "");
    std::stable_partition(rows.begin(), rows.end(), [](const Row& row) { return !passed(*row.first); });
    return rows;
}

void writeOverview(Markup& page, const Json& checks) {
    std::vector<KeyFigure> figures;
    for (const auto& [name, group] : checks.items()) {
        Totals totals;
        add(totals, group);
        figures.push_back(
            {name, grouped(totals.checks - totals.failed - totals.skipped) + " of " + grouped(totals.checks),
             totals.checks == 0   ? "no check: nothing was verified"
             : totals.failed > 0  ? grouped(totals.failed) + " failed"
             : totals.skipped > 0 ? grouped(totals.skipped) + " skipped"
                                  : "passed"});
    }
    writeKeyFigures(page, figures);
}

} // namespace

double shareOfLimit(const Json& check) {
    const double measured = figureOf(check, "measured"), expected = figureOf(check, "expected"),
                 tolerance = figureOf(check, "tolerance");
    const std::string kind = check.at("kind").get<std::string>();
    double share = std::numeric_limits<double>::quiet_NaN();
    if (kind == "equal_abs")
        share = std::abs(measured - expected) / tolerance;
    else if (kind == "equal_rel")
        share = std::abs(measured - expected) / (tolerance * std::abs(expected));
    else if (kind == "at_most" && expected > 0)
        share = measured / expected;
    else if (kind == "at_least" && expected > 0 && measured > 0)
        share = expected / measured;
    if (!std::isfinite(share))
        return std::numeric_limits<double>::quiet_NaN();
    return share < 0 ? 0 : share; // nothing of an upper limit is used below 0
}

std::string verifyReport(const Json& checks, const VerifyPageFacts& facts) {
    Markup page;
    beginPage(page, headOf(checks, facts));
    writeOverview(page, checks);
    std::vector<Row> failures;
    for (const auto& [name, group] : checks.items())
        for (const Json& check : group)
            if (!passed(check))
                failures.emplace_back(&check, name);
    if (!failures.empty()) {
        beginSection(page, "failures", "Failures");
        writeChecks(page, failures);
        page.close();
    }
    std::size_t number = 0;
    for (const auto& [name, group] : checks.items()) {
        beginSection(page, "group-" + std::to_string(++number), name);
        if (group.empty())
            page.element("p", {}, "The group holds no check.");
        else
            writeChecks(page, sorted(group));
        for (const VerifyPagePicture& picture : facts.pictures)
            if (picture.group == name)
                writePicture(page, picture.png, picture.caption, picture.caption);
        page.close();
    }
    if (!facts.seconds.empty()) {
        beginSection(page, "timing", "Timing");
        PropertyTable table{"Wall time", {}, {}};
        for (const auto& [name, seconds] : facts.seconds)
            table.rows.push_back({name, {siText(seconds, "s")}, ""});
        writeProperties(page, table);
        page.close();
    }
    page.open("footer");
    page.text("Used of the limit: how far the measured value lies from the expected one in shares of the "
              "tolerance, or how much of an upper or lower limit it takes up; 100 % is the limit itself. "
              "The figures in full: verify.json beside this page.");
    page.close();
    return endPage(std::move(page));
}

} // namespace serosa::app
