#pragma once
// What all drawing passes of one picture share: matrices and light, in lattice units and float32.

#include "gpu/program.h"
#include "render/camera.h"
#include "shaders/shared_constants.h"
#include "sim/lattice.h"
#include "sim/scene.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace serosa::render {

struct Frame {
    glm::mat4 clipFromLattice{1};
    glm::vec4 eye{0, 0, 1, 0}; // lattice units, w = 1; or the direction to the eye, w = 0 (orthographic)
    glm::vec2 size{1};         // pixels
    glm::vec3 toKey{0, 1, 0}, toBack{0, 1, 0};
    float key = 1, ambient = 1;
    std::vector<glm::vec4> shades; // balls that keep light off the tissue: centre, radius, lattice units
    const gpu::Texture2D* shadow = nullptr;    // depth map of the key lamp; null: it throws no shadows
    glm::mat4 shadowFromLattice{1};            // its clip space
    float shadowTexel = 0;                     // lattice units
    const gpu::Texture2D* occlusion = nullptr; // of the picture's size; null: none is found in it
    bool cull = false;                         // skip clusters of the surface that cannot be seen
    float mostError = 0;  // pixels: what a level of detail of the surface may be off by; 0: the whole surface
    bool blood = true;    // beside cuts
    glm::vec4 section{0}; // plane, lattice units: the surface is drawn where it is positive; 0: all is

    void setLight(gpu::Program& program) const {
        program.set("u_toKey", toKey).set("u_toBack", toBack).set("u_key", key);
        program.set("u_ambient", ambient).set("u_eye", eye);
    }
    /// What shaders/tissue_light.glsl asks for, too. \param none a texel, bound where there is no map
    void setTissueLight(gpu::Program& program, const gpu::Texture2D& none) const {
        setLight(program);
        program.set("u_shadows", shadow ? 1 : 0).set("u_occlusion", occlusion ? 1 : 0);
        program.texture("t_shadow", shadow ? *shadow : none);
        program.texture("t_occlusion", occlusion ? *occlusion : none);
        program.set("u_shadowFromLattice", shadowFromLattice).set("u_shadowTexel", shadowTexel);
        std::array<glm::vec4, SRS_MAX_TOOLS> tools{};
        for (std::size_t i = 0; i < tools.size() && i < shades.size(); ++i)
            tools[i] = shades[i];
        program.set("u_tools", std::span<const glm::vec4>(tools));
        program.set("u_toolCount", int(std::min(tools.size(), shades.size())));
    }
};

/// Products are formed in double: an organ may lie metres from the origin and be drawn to micrometres.
inline Frame makeFrame(const sim::Lattice& lattice, const CameraView& camera, const sim::Light& light,
                       const sim::Look& look, int width, int height) {
    glm::dmat4 worldFromLattice(lattice.spacing);
    worldFromLattice[3] = glm::dvec4(lattice.origin, 1);
    const glm::dmat4 latticeAxes =
        glm::transpose(camera.cameraFromWorld); // rows: right, up, back, in the world
    const glm::dvec3 right(latticeAxes[0]), up(latticeAxes[1]), back(latticeAxes[2]);
    const bool orthographic = camera.clipFromCamera[2][3] == 0;

    Frame frame;
    frame.clipFromLattice = glm::mat4(camera.clipFromCamera * camera.cameraFromWorld * worldFromLattice);
    frame.eye = orthographic ? glm::vec4(back, 0) : glm::vec4(lattice.toLattice(camera.eye), 1);
    frame.size = {width, height};
    frame.toKey = glm::vec3(glm::normalize(-light.direction));
    frame.toBack =
        glm::vec3(glm::normalize(-0.75 * right + 0.45 * up - 0.55 * back)); // left, above, behind the organ
    frame.key = float(light.intensity);
    frame.ambient = float(light.ambient);
    if (look.sectionAt) {
        const glm::dvec3 kept = -glm::normalize(look.sectionNormal);
        frame.section =
            glm::vec4(glm::vec3(kept), float(-glm::dot(kept, lattice.toLattice(*look.sectionAt))));
    }
    return frame;
}

} // namespace serosa::render
