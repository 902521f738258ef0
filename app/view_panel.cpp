// See app/view_panel.h.

#include "app/view_panel.h"

#include "gpu/gl.h"
#include "sim/scene_keys.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>

namespace serosa::app {

namespace {

constexpr float kWidth = 270, kMargin = 10; // at a content scale of 1
const ImVec4 kErrorColour(1.0F, 0.45F, 0.35F, 1.0F);

constexpr const char* kHelp = "drag         turn\n"
                              "right drag   move (or shift+drag)\n"
                              "wheel, + -   zoom\n"
                              "ctrl+drag    hold tissue\n"
                              "ctrl+right   push it\n"
                              "  and wheel  deeper, nearer\n"
                              "ctrl+shift+drag  move a deformation\n"
                              "  right button   turn it\n"
                              "  and wheel      larger, smaller\n"
                              "d            the next deformation\n"
                              "arrows       turn; shift: move\n"
                              "c            camera of the scene\n"
                              "space . r    pause, step, restart\n"
                              "1 2 3 4      mapping; 4: scene's\n"
                              "l w n        lattice, wires, normals\n"
                              "s F12        picture, window\n"
                              "F5           shaders again\n"
                              "p q          panel, quit";

void reading(const char* name, const char* format, double value) {
    ImGui::TextUnformatted(name);
    ImGui::SameLine(ImGui::GetFontSize() * 8.5F);
    ImGui::Text(format, value);
}

void drawReadings(const ViewReadings& readings) {
    ImGui::TextUnformatted(readings.scene.c_str());
    ImGui::TextDisabled("%zu nodes, %zu vertices", readings.nodes, readings.vertices);
    ImGui::TextDisabled("%s%s", readings.software ? "software: " : "", readings.renderer.c_str());
    ImGui::Separator();
    reading("time", "%.3f s", readings.time);
    reading("frame", "%.0f", readings.frame);
    if (readings.stepsPerFrame > 0) {
        reading("step", "%.3f ms", readings.stepMs);
        reading("steps a frame", "%.0f", readings.stepsPerFrame);
        ImGui::SameLine();
        ImGui::TextDisabled("%s", readings.method.c_str());
    }
    reading("drawing", "%.2f ms", readings.drawMs);
    reading("frame, whole", "%.2f ms", readings.stepsMs + readings.drawMs);
    if (readings.handForce >= 0)
        reading("hand", "%.3f N", readings.handForce);
    if (readings.realTime > 0)
        reading("real time", "x %.2f", readings.realTime);
    else
        ImGui::TextDisabled("stopped");
    for (const std::string& line : readings.stopped) {
        ImGui::PushStyleColor(ImGuiCol_Text, kErrorColour);
        ImGui::TextWrapped("%s. Stays so until a restart (r).", line.c_str());
        ImGui::PopStyleColor();
    }
}

void drawSwitches(ViewControls& controls) {
    const float button = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
    if (ImGui::Button(controls.paused ? "Go on" : "Pause", ImVec2(button, 0)))
        controls.paused = !controls.paused;
    ImGui::SameLine();
    if (ImGui::Button("Step", ImVec2(button, 0)))
        ++controls.steps;
    ImGui::SameLine();
    if (ImGui::Button("Restart", ImVec2(button, 0)))
        controls.restart = true;
    int mapping = int(controls.look.mapping);
    ImGui::RadioButton("one-to-one", &mapping, 0);
    ImGui::RadioButton("triangle basis", &mapping, 1);
    ImGui::RadioButton("curvature-corrected", &mapping, 2);
    if (controls.sceneMapping > sim::Mapping::curvature) {
        const auto& words = sim::findSceneKey("look", "mapping")->words;
        ImGui::RadioButton(words[std::size_t(controls.sceneMapping)].c_str(), &mapping,
                           int(controls.sceneMapping));
    }
    controls.look.mapping = sim::Mapping(mapping);
    ImGui::Checkbox("surface", &controls.look.surface);
    ImGui::SameLine();
    ImGui::Checkbox("lattice", &controls.look.lattice);
    ImGui::SameLine();
    ImGui::Checkbox("tools", &controls.look.tools);
    ImGui::Checkbox("wires", &controls.wireframe);
    ImGui::SameLine();
    bool normals = controls.look.colour == sim::SurfaceColour::dynamicNormal;
    ImGui::Checkbox("normals", &normals);
    controls.look.colour = normals ? sim::SurfaceColour::dynamicNormal : sim::SurfaceColour::tissue;
}

void drawDeformation(DeformationPanel& panel) {
    if (panel.names.empty() || !ImGui::CollapsingHeader("deformation", ImGuiTreeNodeFlags_DefaultOpen))
        return;
    if (panel.names.size() == 1) {
        ImGui::TextUnformatted(panel.names.front().c_str());
    } else if (ImGui::BeginCombo("##which", panel.names[std::size_t(panel.chosen)].c_str())) {
        for (std::size_t i = 0; i < panel.names.size(); ++i)
            if (ImGui::Selectable(panel.names[i].c_str(), int(i) == panel.chosen))
                panel.chosen = int(i);
        ImGui::EndCombo();
    }
    const auto settle = [&panel] { panel.settled = panel.settled || ImGui::IsItemDeactivatedAfterEdit(); };
    panel.edited = ImGui::DragFloat3("mm", &panel.at.x, 0.5F, 0, 0, "%.1f") || panel.edited;
    settle();
    panel.edited = ImGui::DragFloat("scale", &panel.scale, 0.01F, 0.02F, 50, "%.2f") || panel.edited;
    settle();
    if (panel.unit) {
        panel.edited = ImGui::DragFloat(panel.unit, &panel.amount, 0.5F, 0, 0, "%.1f") || panel.edited;
        settle();
    }
    ImGui::Checkbox("box", &panel.outline);
    ImGui::SameLine();
    panel.restore = ImGui::Button("As in the scene") || panel.restore;
    ImGui::Separator();
}

/// Over the picture, under the panel.
void drawOutline(const DeformationPanel& panel) {
    ImDrawList& over = *ImGui::GetBackgroundDrawList();
    for (const auto& [from, to] : panel.lines)
        over.AddLine(ImVec2(from.x, from.y), ImVec2(to.x, to.y), IM_COL32(255, 200, 90, 160), 1.5F);
}

} // namespace

ViewPanel::ViewPanel(gpu::Window& window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // leaves no file behind
    ImGui::StyleColorsDark();
    const float scale = float(window.contentScale());
    ImGui::GetStyle().ScaleAllSizes(scale);
    ImGui::GetStyle().WindowRounding = 4 * scale;
    ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.82F;
    ImGui::GetIO().FontGlobalScale = scale;
    ImGui_ImplGlfw_InitForOpenGL(window.handle(), true); // passes events on to the window's own callbacks
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

ViewPanel::~ViewPanel() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

bool ViewPanel::wantsMouse() const {
    return ImGui::GetIO().WantCaptureMouse;
}

bool ViewPanel::wantsKeyboard() const {
    return ImGui::GetIO().WantTextInput;
}

void ViewPanel::draw(ViewControls& controls, const ViewReadings& readings) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    // Of a window that another program just destroyed, GLFW gives what was in memory as the size.
    ImVec2& shown = ImGui::GetIO().DisplaySize;
    shown = ImVec2(std::max(shown.x, 0.0f), std::max(shown.y, 0.0f));
    ImGui::NewFrame();
    const float scale = ImGui::GetIO().FontGlobalScale;
    if (controls.panel && controls.deformation.outline)
        drawOutline(controls.deformation);
    if (controls.panel) {
        ImGui::SetNextWindowPos(ImVec2(kMargin * scale, kMargin * scale), ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSize(ImVec2(kWidth * scale, 0));
        ImGui::Begin("Serosa", nullptr,
                     ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize);
        drawReadings(readings);
        ImGui::Separator();
        drawSwitches(controls);
        ImGui::Separator();
        drawDeformation(controls.deformation);
        if (ImGui::CollapsingHeader("keys and mouse"))
            ImGui::TextUnformatted(kHelp);
        ImGui::End();
    }
    // Errors show without the panel, too.
    if (!readings.message.empty() && (controls.panel || readings.isError)) {
        const ImVec2 size = ImGui::GetIO().DisplaySize;
        ImGui::SetNextWindowPos(ImVec2(size.x - kMargin * scale, size.y - kMargin * scale), ImGuiCond_Always,
                                ImVec2(1, 1)); // its lower right corner
        ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0),
                                            ImVec2(size.x - 2 * kMargin * scale, 0.6F * size.y));
        ImGui::Begin("message", nullptr,
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav |
                         ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
        if (readings.isError)
            ImGui::PushStyleColor(ImGuiCol_Text, kErrorColour);
        ImGui::PushTextWrapPos(size.x - 4 * kMargin * scale);
        ImGui::TextUnformatted(readings.message.c_str());
        ImGui::PopTextWrapPos();
        if (readings.isError)
            ImGui::PopStyleColor();
        ImGui::End();
    }
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

} // namespace serosa::app
