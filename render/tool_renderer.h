#pragma once
// Draws tools and bodies: steel, matte, and floors as patches with a grid that fade out.

#include "base/result.h"
#include "gpu/program.h"
#include "render/frame.h"
#include "render/tool_shapes.h"

#include <vector>

namespace serosa::render {

class ToolRenderer {
public:
    static Result<ToolRenderer> create();

    struct Programs {
        gpu::Program tool, floor;
    };
    /// Its programs from another source. Errors: as gpu::Program::create.
    static Result<Programs> compile(const gpu::ShaderLibrary& library);
    Programs& programs() { return programs_; }

    /// Draws into the bound target with its depth test; what is solid before floors.
    /// \param placement the frame's lattice: spacing and origin
    void draw(const Frame& frame, const sim::Lattice& placement, const std::vector<DrawnShape>& shapes);

private:
    /// Triangles of a shape, or of a floor's patch, on the GPU.
    struct Model {
        sim::RigidShape shape;
        gpu::VertexArray array;
        gpu::Buffer vertices, indices;
        int indexCount = 0;
    };
    ToolRenderer() = default;
    const Model& modelOf(const sim::RigidShape& shape);
    void drawOne(gpu::Program& program, const sim::Lattice& placement, const DrawnShape& drawn);

    Programs programs_;
    std::vector<Model> models_; // made when first drawn
};

} // namespace serosa::render
