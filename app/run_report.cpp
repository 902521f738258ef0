// See app/run_report.h.

#include "app/run_report.h"

#include "app/coupling_tables.h"
#include "app/html_page.h"
#include "app/organ_setup.h"
#include "app/run_tables.h"
#include "app/si_text.h"
#include "app/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace serosa::app {

namespace {

using Json = nlohmann::ordered_json;

std::string names(const std::vector<Json>& organs) {
    std::string text;
    for (std::size_t i = 0; i < organs.size(); ++i)
        text += (i == 0                  ? ""
                 : i + 1 < organs.size() ? ", "
                                         : " and ") +
                organs[i].at("name").get<std::string>();
    return text;
}

PageHead headOf(const Json& summary, const std::string& failure) {
    PageHead head;
    head.title = names(organsOf(summary));
    head.kind = "serosa run";
    head.subtitle = "A run of serosa " + summary.at("serosa").get<std::string>() + ", " +
                    summary.at("solver").get<std::string>() + " solver, " +
                    summary.at("gl").at("renderer").get<std::string>();
    const double rate = figureOf(summary, "frame_rate_Hz");
    const int done = summary.at("frames").get<int>(), asked = summary.at("frames_asked").get<int>();
    const std::string frames = grouped(std::size_t(done)) + " of " + grouped(std::size_t(asked)) + " frames";
    const std::string end = summary.at("end").get<std::string>();
    if (end == "complete") {
        head.summary = "Complete:";
        head.detail = frames + ", " + siText(done / rate, "s") + " simulated.";
    } else if (end == "interrupted" && failure.empty()) {
        head.verdict = Verdict::warning;
        head.summary = "Interrupted:";
        head.detail = frames + ", " + siText(done / rate, "s") + " of " + siText(asked / rate, "s") +
                      " simulated. What stands here is what was done until then.";
    } else {
        head.verdict = Verdict::bad;
        head.summary = "An organ was stopped:";
        head.detail = (failure.empty() ? "its state was wrong" : failure) + ". " + frames +
                      " done; the organ stayed as it was last good.";
    }
    return head;
}

/// The sample of the energies with the largest displacement; null without samples.
const Json* largestSample(const Json& summary) {
    const Json* largest = nullptr;
    for (const Json& sample : summary.at("energies")) {
        const double value = figureOf(sample, "largest_displacement_m");
        if (std::isfinite(value) && (!largest || value > figureOf(*largest, "largest_displacement_m")))
            largest = &sample;
    }
    return largest;
}

void writeFigures(Markup& page, const Json& summary) {
    std::vector<KeyFigure> figures;
    const Json* sample = largestSample(summary);
    const double moved = figureOf(summary, "largest_displacement_m");
    figures.push_back({"Largest displacement", siText(moved, "m"),
                       sample && moved > 0 ? "at " + siText(figureOf(*sample, "t_s"), "s") : ""});
    const Json* strongest = nullptr;
    const std::vector<Json> colliders = collidersOf(summary);
    for (const Json& tool : colliders)
        if (!strongest || figureOf(tool, "largest_force_N") > figureOf(*strongest, "largest_force_N"))
            strongest = &tool;
    if (strongest) { // bodies among them
        const double force = figureOf(*strongest, "largest_force_N");
        figures.push_back({summary.at("tools").empty() ? "Largest force" : "Largest tool force",
                           siText(force, "N"),
                           force > 0 ? strongest->at("name").get<std::string>() + ", at " +
                                           siText(timeOfLargestForce(*strongest), "s")
                                     : "no tool touched"});
    }
    std::size_t nodes = 0, faces = 0;
    double finest = INFINITY;
    int mostSteps = 0;
    const std::vector<Json> organs = organsOf(summary);
    const Json* stepped = nullptr;
    for (const Json& organ : organs) {
        nodes += organ.at("lattice").at("nodes").get<std::size_t>();
        faces += organ.at("faces").get<std::size_t>();
        finest = std::min(finest, figureOf(organ.at("lattice"), "spacing_m"));
        if (const int steps = organ.at("step").at("steps_per_frame").get<int>(); steps > mostSteps) {
            mostSteps = steps;
            stepped = &organ.at("step");
        }
    }
    figures.push_back({"Lattice", grouped(nodes) + " nodes",
                       (organs.size() > 1 ? "finest spacing " : "spacing ") + siText(finest, "m")});
    figures.push_back(
        {"Surface", grouped(faces) + " faces", summary.at("mapping").get<std::string>() + " mapping"});
    if (stepped)
        figures.push_back({"Time step", siText(figureOf(*stepped, "time_step_s"), "s"),
                           std::to_string(mostSteps) + (mostSteps == 1 ? " step" : " steps") + " a frame, " +
                               (stepped->value("method", "explicit") == "implicit"
                                    ? "implicit"
                                    : "stable below " + siText(figureOf(*stepped, "bound_s"), "s"))});
    writeKeyFigures(page, figures);
}

/// All plots have the same time axis, whichever samples they show.
double lastTime(const Json& summary) {
    double last = 0;
    const auto add = [&last](const Json& samples) {
        if (const double time = samples.empty() ? 0 : figureOf(samples.back(), "t_s"); time > last)
            last = time;
    };
    add(summary.at("energies"));
    for (const Json& tool : collidersOf(summary))
        add(tool.at("force"));
    return last;
}

void writePlots(Markup& page, const Json& summary) {
    const Json& samples = summary.at("energies");
    const std::string sums = summary.contains("organs") ? ", sums over the organs" : "";
    const auto series = [&](const std::string& name, const char* key) {
        PlotSeries result{name, {}, {}};
        for (const Json& sample : samples) {
            result.times.push_back(figureOf(sample, "t_s"));
            result.values.push_back(figureOf(sample, key));
        }
        return result;
    };
    const bool dots = samples.size() <= kMarkedPoints;
    const std::string sampled = std::string(dots ? "a dot a sample: " : "sampled ") + "every 10 frames";
    const double end = lastTime(summary);
    writePlot(page, {"plot-displacement",
                     "Largest displacement",
                     "m",
                     "of a node from rest; " + sampled,
                     {series("displacement", "largest_displacement_m")},
                     end});
    Plot force{"plot-force", "Force on the organ",
               "N",          "size of each tool\u2019s mean force over a frame" + sums,
               {},           end};
    for (const Json& tool : collidersOf(summary)) {
        PlotSeries one{tool.at("name").get<std::string>(), {}, {}};
        for (const Json& sample : tool.at("force")) {
            one.times.push_back(figureOf(sample, "t_s"));
            one.values.push_back(forceSize(sample));
        }
        if (!one.values.empty())
            force.series.push_back(std::move(one));
    }
    if (!force.series.empty())
        writePlot(page, force);
    if (const Plot coupling = couplingPlot(summary, end); !coupling.series.empty())
        writePlot(page, coupling);
    writePlot(page, {"plot-energies",
                     "Energies",
                     "J",
                     sampled + sums,
                     {series("elastic", "elastic_J"), series("kinetic", "kinetic_J"),
                      series("gravitational", "gravitational_J")},
                     end});
}

std::string frameName(int frame) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%06d.png", frame);
    return name;
}

void writeFrames(Markup& page, const Json& summary, const RunPictures& pictures) {
    if (pictures.frames.empty())
        return;
    page.open("div", {{"class", "pair"}});
    const double rate = figureOf(summary, "frame_rate_Hz");
    for (std::size_t i = 0; i < pictures.frames.size(); ++i) {
        const auto& [frame, png] = pictures.frames[i];
        const bool last = i + 1 == pictures.frames.size();
        const std::string what =
            last ? "the last picture" : "the picture nearest to the largest displacement that was sampled";
        writePicture(page, png, siText(frame / rate, "s") + ", " + what + " (" + frameName(frame) + ")",
                     what);
    }
    page.close();
}

} // namespace

std::vector<int> reportFrames(const Json& summary, const std::vector<int>& written) {
    if (written.empty())
        return {};
    std::vector<int> frames{written.back()};
    if (const Json* sample = largestSample(summary)) {
        const double frame = figureOf(*sample, "t_s") * figureOf(summary, "frame_rate_Hz");
        const int nearest = *std::min_element(written.begin(), written.end(), [&](int a, int b) {
            return std::abs(a - frame) < std::abs(b - frame);
        });
        if (nearest != written.back())
            frames.insert(frames.begin(), nearest);
    }
    return frames;
}

std::string runReport(const Json& summary, const RunPictures& pictures, const std::string& failure) {
    Markup page;
    beginPage(page, headOf(summary, failure));
    writeFigures(page, summary);
    if (!pictures.contactSheet.empty() || !pictures.frames.empty()) {
        beginSection(page, "pictures", "Pictures");
        if (!pictures.contactSheet.empty())
            writePicture(page, pictures.contactSheet, "The run at a glance (contact_sheet.png)",
                         "contact sheet: pictures of the whole run");
        writeFrames(page, summary, pictures);
        page.close();
    }
    beginSection(page, "plots", "Over time");
    writePlots(page, summary);
    page.close();
    if (const std::vector<Json> colliders = collidersOf(summary); !colliders.empty()) {
        beginSection(page, "tools", summary.contains("bodies") ? "Tools and bodies" : "Tools");
        writeToolTable(page, summary);
        page.close();
    }
    if (hasCoupling(summary)) {
        beginSection(page, "coupling", "Organs that touch, and threads");
        writeCouplingTables(page, summary);
        page.close();
    }
    beginSection(page, "setup", "What was simulated");
    writeOrganTables(page, summary);
    page.close();
    if (std::ranges::any_of(organsOf(summary),
                            [](const Json& organ) { return organ.contains("materials"); })) {
        beginSection(page, "materials", "Materials");
        writeMaterialTable(page, summary);
        page.close();
    }
    beginSection(page, "program", "Scene, program and machine");
    writeProgramTable(page, summary);
    page.close();
    beginSection(page, "timing", "Timing");
    writeTimingTable(page, summary);
    page.close();
    page.open("footer")
        .text("Every figure of this page in full, with all samples: summary.json beside it.")
        .close();
    return endPage(std::move(page));
}

} // namespace serosa::app
