// The pages of `serosa run` and `serosa verify`: well-formed, complete in themselves, and never at odds with
// the JSON documents that they are made of.

#include "app/html_page.h"
#include "app/output_folder.h"
#include "app/run_report.h"
#include "app/verify/html.h"
#include "tests/app/child.h"
#include "tests/app/page_reader.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

namespace serosa::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// The eight bytes of a PNG file, then its first chunk: 3 x 2 pixels.
const std::string kPng("\x89PNG\r\n\x1A\n\0\0\0\rIHDR\0\0\0\x03\0\0\0\x02\x08\x02\0\0\0", 29);

/// A summary with `samples` energies, ten frames apart, and a force for each frame.
Json summary(int samples = 14) {
    Json json = Json::parse(R"({
        "schema": 1, "serosa": "0.1.0", "parts": {"glm": "0.9.9.8"},
        "gl": {"context": "egl", "vendor": "Mesa", "renderer": "llvmpipe", "version": "4.5", "software": true},
        "solver": "fragment", "mapping": "curvature",
        "organ": {"name": "liver", "model": "liver.stl", "metres_per_unit": 0.001, "vertices": 25160,
                  "faces": 50316, "young_Pa": 2600.0, "poisson": 0.25, "density_kg_m3": 1060.0,
                  "damping_time_s": 0.00015, "air_drag_1_s": 10.0},
        "lattice": {"nodes": 3995, "fixed_nodes": 1014, "cells": 2643, "spacing_m": 0.0064,
                    "node_dims": [19, 25, 17], "volume_m3": 2.359e-4, "filled_volume_m3": 2.361e-4,
                    "layout": "grid", "texture_size": [19, 425]},
        "step": {"time_step_s": 0.0020833, "steps_per_frame": 8, "bound_s": 0.003166, "margin": 0.7,
                 "stiffest_rate2_1_s2": 364494.0, "formula_rate2_1_s2": 287521.0, "how": "by iteration"},
        "gravity_m_s2": [0.0, -9.81, 0.0], "frame_rate_Hz": 60.0, "frames_asked": 130, "frames": 130,
        "end": "complete", "picture_size": [640, 480], "pictures": 65, "surfaces": 1,
        "binding": {"vertices": 25160, "torn_edges_found": 42, "torn_edges_left": 7,
                    "constant_basis_vertices": 99, "bytes_per_vertex": 36.0},
        "largest_displacement_m": 0.025, "energies": [],
        "tools": [{"name": "probe", "mode": "push", "radius_m": 0.015, "largest_force_N": 0.05, "force": []}],
        "state_hash": "29e9aeab659804a55ce2f2553d243ca0",
        "timing": {"ms_per_step": 1.3, "ms_steps_per_frame": 10.6, "ms_draw_per_picture": 113.0,
                   "ms_per_frame": 124.0, "real_time_factor": 0.134, "setup_s": 1.9, "files_s": 11.7,
                   "total_s": 24.6, "peak_memory_B": 310000000}})");
    for (int i = 0; i < samples; ++i) {
        const double t = i / 6.0;
        json["energies"].push_back({{"t_s", t},
                                    {"kinetic_J", 1e-5 * std::sin(t) * std::sin(t)},
                                    {"elastic_J", 7e-3 * std::exp(-t) * t},
                                    {"gravitational_J", -8e-3 * std::cos(3 * t) * t},
                                    {"largest_displacement_m", 0.025 * std::abs(std::sin(2 * t))}});
    }
    for (int frame = 1; frame <= 10 * (samples - 1); ++frame)
        json["tools"][0]["force"].push_back(
            {{"t_s", frame / 60.0}, {"N", {0.01 * std::sin(frame), -0.02 * frame, 0.005}}});
    return json;
}

RunPictures pictures() {
    return {kPng, {{12, kPng}, {130, kPng}}};
}

Json checks() {
    return Json::parse(R"({
        "solver": [
            {"name": "free fall", "kind": "equal_rel", "measured": 1.7535039, "expected": 1.7535,
             "tolerance": 1e-5, "unit": "m", "pass": true},
            {"name": "beam", "kind": "equal_abs", "measured": 1.06, "expected": 1.0, "tolerance": 0.05,
             "unit": "1", "pass": false},
            {"name": "drift", "kind": "at_most", "measured": null, "expected": 1e-5, "tolerance": 0.0,
             "unit": "h", "pass": false}],
        "mapping": [
            {"name": "gap", "kind": "at_least", "measured": 0.5, "expected": 0.25, "tolerance": 0.0,
             "unit": "h", "pass": true},
            {"name": "on a GPU", "kind": "at_most", "measured": null, "expected": null, "tolerance": null,
             "unit": "", "pass": false, "skipped": "software only"}]})");
}

const VerifyPageFacts kFacts{"0.1.0", "llvmpipe", "", false, {{"solver", 30.2}, {"mapping", 1.1}}};

/// The axis of a plot as a reader sees it: value = a + b * pixel, from the outermost tick labels, in SI
/// units.
struct Transform {
    double a = 0, b = 0;
    double operator()(double pixel) const { return a + b * pixel; }
};
Transform transformOf(const PageReader& page, const Element& plot, const std::string& axis,
                      const std::string& coordinate, double scale) {
    const Element* group = page.all("g", axis, &plot).at(0);
    const std::vector<const Element*> labels = page.all("text", "", group);
    const auto number = [](std::string text) {
        if (text.starts_with("\u2212"))
            text = "-" + text.substr(3);
        return std::stod(text);
    };
    const double p0 = std::stod(labels.front()->attribute(coordinate)),
                 p1 = std::stod(labels.back()->attribute(coordinate));
    const double v0 = number(labels.front()->text) * scale, v1 = number(labels.back()->text) * scale;
    const double b = (v1 - v0) / (p1 - p0);
    return {v0 - b * p0, b};
}

double scaleOf(const std::string& unit, const std::string& base) {
    const std::string prefix = unit.substr(0, unit.size() - base.size());
    EXPECT_EQ(unit.substr(prefix.size()), base);
    const std::map<std::string, double> scales = {{"", 1}, {"m", 1e-3}, {"\u00B5", 1e-6}, {"k", 1e3}};
    return scales.at(prefix);
}

using Points = std::vector<std::pair<double, double>>;
Points pointsOf(const Element& polyline) {
    Points points;
    std::istringstream stream(polyline.attribute("points"));
    double x = 0, y = 0;
    char comma = 0;
    while (stream >> x >> comma >> y)
        points.emplace_back(x, y);
    return points;
}

/// The points of a series (1 is the first), in SI units, and half a pixel in them.
struct Curve {
    Points points;
    double halfX = 0, halfY = 0;
};
Curve curveOf(const PageReader& page, const std::string& id, const std::string& unit, int series) {
    const Element& plot = *page.byId(id);
    const std::string shown = page.all("span", "unit", &plot).at(0)->text.substr(3); // "in mJ"
    const Transform time = transformOf(page, plot, "time", "x", 1),
                    value = transformOf(page, plot, "value", "y", scaleOf(shown, unit));
    Curve curve{{}, std::abs(time.b) / 2, std::abs(value.b) / 2};
    // The first group of that class is the legend's swatch.
    const Element* group = page.all("g", "s" + std::to_string(series), &plot).at(1);
    for (const Element* line : page.all("polyline", "", group))
        for (const auto& [x, y] : pointsOf(*line))
            curve.points.emplace_back(time(x), value(y));
    return curve;
}

void expectWellFormed(const std::string& text) {
    const PageReader page(text);
    EXPECT_EQ(page.error(), "");
    for (const Element& element : page.elements()) {
        EXPECT_NE(element.name, "script");
        EXPECT_NE(element.name, "link");
        EXPECT_NE(element.name, "iframe");
        for (const auto& [key, value] : element.attributes) {
            EXPECT_FALSE(key.starts_with("on")) << key;
            EXPECT_NE(key, "style");
            if (key == "src" || key.ends_with("href") || key == "srcset" || key == "data") {
                EXPECT_TRUE(value.starts_with("data:image/png;base64,") || value.starts_with("#")) << value;
            }
        }
    }
    const std::string style = page.all("style").at(0)->text;
    for (const char* loads : {"url(", "@import", "http", "//"})
        EXPECT_EQ(style.find(loads), std::string::npos) << loads;
    EXPECT_EQ(text.find("http://"), std::string::npos);
    EXPECT_EQ(text.find("https://"), std::string::npos);
    EXPECT_TRUE(std::ranges::any_of(page.all("meta"), [](const Element* meta) {
        return meta->attribute("http-equiv") == "Content-Security-Policy" &&
               meta->attribute("content").starts_with("default-src 'none';");
    }));
}

TEST(PageReader, RefusesWhatIsNotWellFormed) {
    EXPECT_EQ(PageReader("<!DOCTYPE html>\n<p class=\"a b\">1 &lt; 2<br/></p>\n").error(), "");
    for (const char* bad : {"<p></p>", "<!DOCTYPE html><p>", "<!DOCTYPE html></p>",
                            "<!DOCTYPE html><p><b></p></b>", "<!DOCTYPE html><p>a & b</p>",
                            "<!DOCTYPE html><p a=1></p>", "<!DOCTYPE html><p a=\"1\" a=\"2\"></p>",
                            "<!DOCTYPE html><p>1 < 2</p>", "<!DOCTYPE html><p></p>after"})
        EXPECT_NE(PageReader(bad).error(), "") << bad;
}

TEST(Report, IsWellFormedAndNeedsNothingElse) {
    expectWellFormed(runReport(summary(), pictures(), ""));
    expectWellFormed(runReport(summary(1), {}, ""));
    expectWellFormed(verifyReport(checks(), kFacts));
    expectWellFormed(verifyReport(Json::object(), {}));
}

TEST(Report, PlotsShowTheSamples) {
    const Json json = summary();
    const std::string text = runReport(json, {}, "");
    const PageReader page(text);
    ASSERT_EQ(page.error(), "");
    const auto expectCurve = [&](const char* id, const char* unit, int series, const Json& samples,
                                 const std::function<double(const Json&)>& valueOf) {
        const Curve curve = curveOf(page, id, unit, series);
        ASSERT_EQ(curve.points.size(), samples.size()) << id << series;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            EXPECT_NEAR(curve.points[i].first, samples[i]["t_s"].get<double>(), curve.halfX) << id << series;
            EXPECT_NEAR(curve.points[i].second, valueOf(samples[i]), curve.halfY) << id << series << " " << i;
        }
    };
    const auto key = [](const char* name) {
        return [name](const Json& sample) { return sample[name].get<double>(); };
    };
    expectCurve("plot-energies", "J", 1, json["energies"], key("elastic_J"));
    expectCurve("plot-energies", "J", 2, json["energies"], key("kinetic_J"));
    expectCurve("plot-energies", "J", 3, json["energies"], key("gravitational_J"));
    expectCurve("plot-displacement", "m", 1, json["energies"], key("largest_displacement_m"));
    expectCurve("plot-force", "N", 1, json["tools"][0]["force"], [](const Json& sample) {
        const Json& n = sample["N"];
        return std::hypot(n[0].get<double>(), n[1].get<double>(), n[2].get<double>());
    });
}

TEST(Report, TablesSayWhatTheSummarySays) {
    const std::string text = runReport(summary(), pictures(), "");
    const PageReader page(text);
    std::map<std::string, std::string> rows;
    for (const Element* row : page.all("tr"))
        if (const auto heads = page.all("th", "", row), cells = page.all("td", "value", row);
            !heads.empty() && !cells.empty())
            rows[heads.front()->text] = cells.front()->text;
    const auto nbsp = [](std::string value, const std::string& unit) { return value + "\u00A0" + unit; };
    EXPECT_EQ(rows["Faces"], "50,316");
    EXPECT_EQ(rows["Young\u2019s modulus"], nbsp("2.6", "kPa"));
    EXPECT_EQ(rows["Damping time"], nbsp("150", "\u00B5s"));
    EXPECT_EQ(rows["Nodes"], "3,995");
    EXPECT_EQ(rows["Spacing"], nbsp("6.4", "mm"));
    EXPECT_EQ(rows["Volume of the surface"], nbsp("235.9", "cm\u00B3"));
    EXPECT_EQ(rows["Step"], nbsp("2.083", "ms"));
    EXPECT_EQ(rows["Torn edges left"], "7");
    EXPECT_EQ(rows["Gravity"], nbsp("(0, \u22129.81, 0)", "m/s\u00B2"));
    EXPECT_EQ(rows["A step"], nbsp("1.3", "ms"));
    EXPECT_EQ(rows["Total"], nbsp("24.6", "s"));
    EXPECT_EQ(rows["Peak memory"], nbsp("310", "MB"));
}

TEST(Report, SeveralOrgansStandSideBySide) {
    Json json = summary();
    Json organ = json["organ"];
    for (const char* part : {"lattice", "step", "binding", "solver"})
        organ[part] = json[part];
    for (const char* part : {"organ", "lattice", "step", "binding"})
        json.erase(part);
    organ["largest_displacement_m"] = 0.025;
    organ["state_hash"] = "aa";
    json["organs"] = {organ, organ};
    json["organs"][1]["name"] = "gallbladder";
    json["organs"][1]["lattice"]["nodes"] = 17;
    const std::string text = runReport(json, {}, "");
    expectWellFormed(text);
    const PageReader page(text);
    EXPECT_EQ(page.all("h1").at(0)->text, "liver and gallbladder");
    const auto rows = page.all("tr", "", page.byId("setup"));
    const auto nodes = std::find_if(rows.begin(), rows.end(), [&](const Element* row) {
        return page.all("th", "", row).at(0)->text == "Nodes";
    });
    ASSERT_NE(nodes, rows.end());
    EXPECT_EQ(page.all("td", "value", *nodes).at(0)->text, "3,995");
    EXPECT_EQ(page.all("td", "value", *nodes).at(1)->text, "17");
}

TEST(Report, EscapesWhateverNamesHold) {
    const std::string hostile = "<script>alert(\"&'\")</script> ]]> --> \x01\xFF\xC0\x80 \xE2\x80\xAE";
    Json json = summary();
    json["organ"]["name"] = json["organ"]["model"] = json["tools"][0]["name"] = hostile;
    json["gl"]["renderer"] = json["gl"]["vendor"] = hostile;
    json["end"] = "organ stopped";
    const std::string text = runReport(json, {}, "node 7 of " + hostile);
    expectWellFormed(text);
    EXPECT_EQ(text.find("<script"), std::string::npos);
    const std::string shown = "<script>alert(\"&'\")</script> ]]> --> \uFFFD\uFFFD\uFFFD\uFFFD \uFFFD";
    EXPECT_EQ(PageReader(text).all("h1").at(0)->text, shown);
    EXPECT_NE(PageReader(text).byId("plot-force")->text.find(shown), std::string::npos);
    Json bad = checks();
    bad["solver"][0]["name"] = bad["solver"][0]["unit"] = hostile;
    bad["<b>&\""] = bad["solver"];
    const std::string verify = verifyReport(bad, kFacts);
    expectWellFormed(verify);
    EXPECT_EQ(verify.find("<script"), std::string::npos);
}

TEST(Report, OnlyTheTimingDiffersBetweenTwoRuns) {
    Json second = summary();
    for (auto& [key, value] : second["timing"].items())
        value = value.get<double>() * 1.7;
    std::string a = runReport(summary(), pictures(), ""), b = runReport(second, pictures(), "");
    EXPECT_EQ(a, runReport(summary(), pictures(), ""));
    EXPECT_NE(a, b);
    for (std::string* text : {&a, &b}) {
        const PageReader page(*text);
        const Element* timing = page.byId("timing");
        ASSERT_TRUE(timing);
        text->erase(timing->begin, timing->end - timing->begin);
    }
    EXPECT_EQ(a, b);
}

TEST(Report, LongRunsAreThinnedWithoutLosingAPeak) {
    Json json = summary(10000);
    json["energies"][4321]["elastic_J"] = 3.0;
    json["energies"][7777]["elastic_J"] = -2.0;
    const std::string text = runReport(json, {}, "");
    EXPECT_LT(text.size(), 400000u); // 100,000 forces and 40,000 other samples
    const PageReader page(text);
    ASSERT_EQ(page.error(), "");
    const Curve curve = curveOf(page, "plot-energies", "J", 1);
    EXPECT_LT(curve.points.size(), 3500u);
    for (const auto& [index, value] : {std::pair{4321, 3.0}, std::pair{7777, -2.0}}) {
        const double t = index / 6.0;
        const auto at = std::find_if(curve.points.begin(), curve.points.end(), [&](const auto& point) {
            return std::abs(point.first - t) <= curve.halfX && std::abs(point.second - value) <= curve.halfY;
        });
        EXPECT_NE(at, curve.points.end()) << value;
    }
    EXPECT_TRUE(std::is_sorted(curve.points.begin(), curve.points.end(),
                               [](const auto& a, const auto& b) { return a.first < b.first - 1e-9; }));
}

TEST(Report, WhatIsNotFiniteMakesAGap) {
    Json json = summary();
    json["end"] = "organ stopped";
    json["energies"][5]["elastic_J"] = kNan;
    json["energies"][6]["elastic_J"] = nullptr; // as it comes back from the file
    json["energies"][8]["elastic_J"] = std::numeric_limits<double>::infinity();
    for (auto& force : json["tools"][0]["force"])
        force["N"] = {nullptr, 0.0, kNan};
    json["tools"][0]["largest_force_N"] = nullptr;
    const std::string text = runReport(json, {}, "the position of node 3 is not finite");
    expectWellFormed(text);
    const PageReader page(text);
    const Element& plot = *page.byId("plot-energies");
    const Element* elastic = page.all("g", "s1", &plot).at(1);
    std::vector<std::size_t> lengths;
    for (const Element* line : page.all("polyline", "", elastic))
        lengths.push_back(pointsOf(*line).size());
    EXPECT_EQ(lengths, (std::vector<std::size_t>{5, 5})); // 0-4, 9-13; 7 stands alone
    EXPECT_EQ(page.all("circle", "", elastic).size(), 11u);
    for (const Element* line : page.all("polyline"))
        EXPECT_EQ(line->attribute("points").find_first_not_of("0123456789., "), std::string::npos);
    for (const Element* force : page.all("g", "s1", page.byId("plot-force")))
        EXPECT_TRUE(page.all("polyline", "", force).empty());
    EXPECT_NE(page.byId("plot-force")->text.find("no finite value"), std::string::npos);
    EXPECT_EQ(page.all("div", "bad").size(), 1u);
    EXPECT_NE(page.all("div", "bad").at(0)->text.find("node 3"), std::string::npos);
}

TEST(Report, SaysHowARunEnded) {
    Json json = summary();
    const auto verdict = [&json] {
        const std::string text = runReport(json, {}, "");
        const Element element = *PageReader(text).all("div", "verdict").at(0);
        return element.attribute("class") + ":" + element.text;
    };
    EXPECT_NE(verdict().find("good:\u2713\nComplete: 130 of 130 frames"), std::string::npos) << verdict();
    json["end"] = "interrupted";
    json["frames"] = 30;
    EXPECT_NE(verdict().find("30 of 130 frames, 500\u00A0ms of 2.167\u00A0s simulated"), std::string::npos)
        << verdict();
    EXPECT_NE(verdict().find("verdict warning"), std::string::npos);
}

TEST(Report, ShowsTheLargestDisplacementAndTheEnd) {
    Json json = summary(3); // at 0, 1/6, 2/6 s: frames 0, 10, 20
    json["energies"][1]["largest_displacement_m"] = 0.5;
    EXPECT_EQ(reportFrames(json, {4, 8, 12, 16, 20}), (std::vector<int>{8, 20}));
    EXPECT_EQ(reportFrames(json, {20}), (std::vector<int>{20}));
    EXPECT_EQ(reportFrames(json, {}), (std::vector<int>{}));
    json["energies"][1]["largest_displacement_m"] = nullptr;
    json["energies"][2]["largest_displacement_m"] = 0.7;
    EXPECT_EQ(reportFrames(json, {4, 8, 12, 16, 20}), (std::vector<int>{20}));
}

TEST(Report, EmbedsThePicturesBytes) {
    const std::string text = runReport(summary(), pictures(), "");
    const PageReader page(text);
    const auto images = page.all("img");
    ASSERT_EQ(images.size(), 3u);
    EXPECT_EQ(images[0]->attribute("src"), "data:image/png;base64," + base64(kPng));
    EXPECT_EQ(images[0]->attribute("width"), "3");
    EXPECT_EQ(images[0]->attribute("height"), "2");
    // RFC 4648, section 10
    for (const auto& [bytes, code] : std::map<std::string, std::string>{{"", ""},
                                                                        {"f", "Zg=="},
                                                                        {"fo", "Zm8="},
                                                                        {"foo", "Zm9v"},
                                                                        {"foob", "Zm9vYg=="},
                                                                        {"fooba", "Zm9vYmE="},
                                                                        {"foobar", "Zm9vYmFy"}})
        EXPECT_EQ(base64(bytes), code);
    EXPECT_EQ(base64("\xFF\xFE\xFD"), "//79");
}

TEST(VerifyReport, ShowsEveryCheckFailuresFirst) {
    const std::string text = verifyReport(checks(), kFacts);
    const PageReader page(text);
    const auto rowsOf = [&page](const char* section) {
        std::vector<std::string> rows;
        for (const Element* row : page.all("tr", "check", page.byId(section)))
            rows.push_back(page.all("th", "name", row).at(0)->text);
        return rows;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(rowsOf("failures"), (Names{"solver: beam", "solver: drift", "mapping: on a GPU"}));
    EXPECT_EQ(rowsOf("group-1"), (Names{"beam", "drift", "free fall"}));
    EXPECT_EQ(rowsOf("group-2"), (Names{"on a GPU", "gap"}));
    EXPECT_NE(page.all("div", "bad").at(0)->text.find("3 of 5 checks failed."), std::string::npos);
    const auto cells = [&page](const Element* row) {
        Names texts;
        for (const Element* cell : page.all("td", "", row))
            texts.push_back(cell->text);
        return texts;
    };
    const auto solver = page.all("tr", "check", page.byId("group-1"));
    const auto clean = [](Names names) {
        for (std::string& name : names)
            std::erase(name, '\n');
        return names;
    };
    EXPECT_EQ(clean(cells(solver.at(0))),
              (Names{"\u2717 FAIL", "1.06", "1", "\u00B1\u00A00.05", "1", "120\u00A0%"}));
    EXPECT_EQ(clean(cells(solver.at(1))),
              (Names{"\u2717 FAIL", "not finite", "\u2264\u00A01\u00A0\u00D7\u00A010\u207B\u2075", "\u2013",
                     "h", "\u2013"}));
    // As many digits as the tolerance needs.
    EXPECT_EQ(clean(cells(solver.at(2))),
              (Names{"\u2713 pass", "1.753504", "1.7535", "\u00B1\u00A00.001\u00A0%", "m", "22\u00A0%"}));
    EXPECT_NE(page.byId("group-2")->text.find("software only"), std::string::npos);
}

TEST(VerifyReport, HasEachPictureBelowItsGroup) {
    VerifyPageFacts facts = kFacts;
    facts.pictures = {{"mapping", kPng, "gaps <in> h (gaps.png)"}};
    const std::string text = verifyReport(checks(), facts);
    expectWellFormed(text);
    const PageReader page(text);
    EXPECT_TRUE(page.all("img", "", page.byId("group-1")).empty());
    const auto images = page.all("img", "", page.byId("group-2"));
    ASSERT_EQ(images.size(), 1u);
    EXPECT_EQ(images[0]->attribute("src"), "data:image/png;base64," + base64(kPng));
    EXPECT_NE(page.byId("group-2")->text.find("gaps <in> h (gaps.png)"), std::string::npos);
}

TEST(VerifyReport, SaysAtOnceWhetherAllPassed) {
    Json json = checks();
    json.erase("mapping");
    json["solver"].erase(1);
    json["solver"].erase(1);
    const auto verdict = [&](const Json& document) {
        const std::string text = verifyReport(document, kFacts);
        return PageReader(text).all("div", "verdict").at(0)->text;
    };
    EXPECT_NE(verdict(json).find("The check passed."), std::string::npos);
    Json skipped = checks();
    skipped["solver"] = json["solver"];
    skipped["mapping"][1]["pass"] = true; // as with --allow-skip
    EXPECT_NE(verdict(skipped).find("No check failed, 1 skipped."), std::string::npos);
    json["empty"] = Json::array(); // a group that measured nothing has verified nothing
    EXPECT_NE(verdict(json).find("1 group without a check."), std::string::npos);
}

TEST(VerifyReport, ShareOfTheLimit) {
    const auto share = [](const char* kind, Json measured, double expected, double tolerance) {
        return shareOfLimit(
            {{"kind", kind}, {"measured", measured}, {"expected", expected}, {"tolerance", tolerance}});
    };
    EXPECT_NEAR(share("equal_abs", 1.02, 1, 0.04), 0.5, 1e-12);
    EXPECT_NEAR(share("equal_rel", -2.02, -2, 0.02), 0.5, 1e-12);
    EXPECT_DOUBLE_EQ(share("at_most", 3, 4, 0), 0.75);
    EXPECT_DOUBLE_EQ(share("at_least", 4, 3, 0), 0.75);
    EXPECT_TRUE(std::isnan(share("equal_abs", 0, 0, 0)));
    EXPECT_TRUE(std::isnan(share("at_most", nullptr, 4, 0)));
    EXPECT_TRUE(std::isnan(share("at_most", 1, 0, 0)));
}

TEST(OutputFolder, ForceClearsAnOlderReport) {
    const TestFolder folder;
    folder.write("report.html", "of an earlier run");
    folder.write("notes.html", "mine");
    EXPECT_FALSE(OutputFolder::check(folder.path(), false).ok());
    auto out = OutputFolder::check(folder.path(), true);
    ASSERT_TRUE(out.ok());
    ASSERT_TRUE(out->create().ok());
    EXPECT_EQ(folder.names(), (std::set<std::string>{"notes.html"}));
    out->keep();
}

} // namespace
} // namespace serosa::app
